#pragma once

#include <cstdint>

namespace takt::twin::test {

/// Where a homing run starts on the line NL … switch … PL.
enum class Start : std::uint8_t { NegativeLimit, Below, OnSwitch, Above, PositiveLimit };

struct HomingCase {
    std::int8_t method;
    Start start;
    const char* steps;  ///< speed and direction of each: F fast, S slow
};

/// Every start case of the CD300E manual's chapter on homing, in its order.
inline constexpr HomingCase HomingCases[] = {
    {1, Start::Below, "F- S+ S+"},     {1, Start::NegativeLimit, "S+ S+"},
    {2, Start::Below, "F+ S- S-"},     {2, Start::PositiveLimit, "S- S-"},
    {3, Start::Below, "F+ S- S-"},     {3, Start::OnSwitch, "S- S-"},
    {4, Start::Below, "F+ S+"},        {4, Start::OnSwitch, "S- S+ S+"},
    {5, Start::Above, "F- S+ S+"},     {5, Start::OnSwitch, "S+ S+"},
    {6, Start::Above, "F- S-"},        {6, Start::OnSwitch, "S+ S- S-"},
    {7, Start::Above, "F+ F- S- S-"},  {7, Start::Below, "F+ S- S-"},
    {7, Start::OnSwitch, "S- S-"},     {8, Start::Above, "F+ F- S- S+ S+"},
    {8, Start::Below, "F+ S- S+ S+"},  {8, Start::OnSwitch, "S- S+ S+"},
    {9, Start::Above, "F+ F- S-"},     {9, Start::Below, "F+ S+ S- S-"},
    {9, Start::OnSwitch, "S+ S- S-"},  {10, Start::Above, "F+ F- S+ S+"},
    {10, Start::Below, "F+ S+ S+"},    {10, Start::OnSwitch, "S+ S+"},
    {11, Start::Below, "F- F+ S+ S+"}, {11, Start::Above, "F- S+ S+"},
    {11, Start::OnSwitch, "S+ S+"},    {12, Start::Below, "F- F+ S+ S- S-"},
    {12, Start::Above, "F- S-"},       {12, Start::OnSwitch, "S+ S- S-"},
    {13, Start::Below, "F- F+ S+"},    {13, Start::Above, "F- S- S+ S+"},
    {13, Start::OnSwitch, "S- S+ S+"}, {14, Start::Below, "F- F+ S- S-"},
    {14, Start::Above, "F- S- S-"},    {14, Start::OnSwitch, "S- S-"},
    {17, Start::Below, "F- S+"},       {17, Start::NegativeLimit, "S+"},
    {18, Start::Below, "F+ S-"},       {18, Start::PositiveLimit, "S-"},
    {19, Start::Below, "F+ S-"},       {19, Start::OnSwitch, "S-"},
    {20, Start::Below, "F+ S- S+"},    {20, Start::OnSwitch, "S- S+"},
    {21, Start::Above, "F- S+"},       {21, Start::OnSwitch, "S+"},
    {22, Start::Above, "F- S+ S-"},    {22, Start::OnSwitch, "S+ S-"},
    {23, Start::Above, "F+ F- S-"},    {23, Start::Below, "F+ S-"},
    {23, Start::OnSwitch, "S-"},       {24, Start::Above, "F+ F- S- S+"},
    {24, Start::Below, "F+ S- S+"},    {24, Start::OnSwitch, "S- S+"},
    {25, Start::Above, "F+ F- S+ S-"}, {25, Start::Below, "F+ S+ S-"},
    {25, Start::OnSwitch, "S+ S-"},    {26, Start::Above, "F+ F- S+"},
    {26, Start::Below, "F+ S+"},       {26, Start::OnSwitch, "S+"},
    {27, Start::Below, "F- F+ S+"},    {27, Start::Above, "F- S+"},
    {27, Start::OnSwitch, "S+"},       {28, Start::Below, "F- F+ S+ S-"},
    {28, Start::Above, "F- S+ S-"},    {28, Start::OnSwitch, "S+ S-"},
    {29, Start::Below, "F- F+ S- S+"}, {29, Start::Above, "F- S- S+"},
    {29, Start::OnSwitch, "S- S+"},    {30, Start::Below, "F- F+ S-"},
    {30, Start::Above, "F- S-"},       {30, Start::OnSwitch, "S-"},
    {33, Start::Below, "S-"},          {34, Start::Below, "S+"},
};

}  // namespace takt::twin::test
