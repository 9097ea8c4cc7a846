#pragma once

#include <array>
#include <cstdint>

namespace takt::core {

struct ObjectAddress {
    std::uint16_t index{0};
    std::uint8_t subindex{0};
};

/// Up to eight bytes of an object's value, little-endian.
struct ObjectValue {
    std::array<std::uint8_t, 8> bytes{};
    std::uint8_t size{0};
};

enum class ObjectState : std::uint8_t { Idle, Pending, Done, Failed };

struct ObjectReply {
    ObjectState state{ObjectState::Idle};
    ObjectValue value{};
    std::uint32_t abortCode{0};  ///< CiA 301 abort code, 0x05040000 on time-out; 0 unless Failed
};

/// A device's object dictionary as seen from the cycle: one request at a time per device, answered
/// some cycles later. So an axis does not know which bus its drive hangs on.
class ObjectAccess {
public:
    virtual ~ObjectAccess() = default;

    /// rt. \return false, and nothing changes, while another request is pending
    virtual bool startRead(ObjectAddress address) noexcept = 0;
    /// rt. \return false, and nothing changes, while another request is pending
    virtual bool startWrite(ObjectAddress address, const ObjectValue& value) noexcept = 0;
    /// rt. The state of the last request; Done and Failed stay until the next start.
    [[nodiscard]] virtual ObjectReply reply() const noexcept = 0;
};

}  // namespace takt::core
