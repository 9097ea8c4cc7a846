#pragma once

#include <cstddef>
#include <cstdint>

namespace takt::fieldbus::ethercat {

/// Who asks for objects of a device. Each has a request of his own, so that nobody takes a reply
/// for the answer to something else; on the wire one request follows the other.
enum class ObjectUser : std::uint8_t {
    Axis,      ///< what the machine itself needs
    Operator,  ///< tools, while the machine runs
};
inline constexpr std::size_t ObjectUsers = 2;

}  // namespace takt::fieldbus::ethercat
