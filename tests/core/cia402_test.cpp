#include <gmock/gmock.h>

#include <takt/core/cia402.hpp>

namespace {

using takt::core::cia402::DriveState;
using takt::core::cia402::stateOf;

struct Row {
    std::uint16_t bits;  ///< of the statusword, as in IEC 61800-7-201 table "state coding"
    std::uint16_t mask;
    DriveState state;
};

constexpr Row Rows[]{
    {0x0000, 0x004F, DriveState::NotReadyToSwitchOn},
    {0x0040, 0x004F, DriveState::SwitchOnDisabled},
    {0x0021, 0x006F, DriveState::ReadyToSwitchOn},
    {0x0023, 0x006F, DriveState::SwitchedOn},
    {0x0027, 0x006F, DriveState::OperationEnabled},
    {0x0007, 0x006F, DriveState::QuickStopActive},
    {0x000F, 0x004F, DriveState::FaultReactionActive},
    {0x0008, 0x004F, DriveState::Fault},
};

TEST(StatusWord, ShowsTheStateWhateverTheOtherBitsAre) {
    for (const Row& row : Rows) {
        for (std::uint32_t word = 0; word <= 0xFFFF; ++word) {
            if ((word & row.mask) != row.bits) continue;
            ASSERT_EQ(stateOf(static_cast<std::uint16_t>(word)), row.state) << std::hex << word;
        }
    }
}

}  // namespace
