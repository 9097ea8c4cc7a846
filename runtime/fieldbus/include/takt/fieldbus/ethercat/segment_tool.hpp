#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <takt/core/clock_source.hpp>
#include <takt/core/object_access.hpp>
#include <takt/wire/al_state.hpp>
#include <takt/wire/device_description.hpp>
#include <takt/wire/link.hpp>
#include <vector>

namespace takt::fieldbus::ethercat {

/// What one device on the wire says about itself, without any configuration.
struct SegmentDevice {
    std::uint16_t position{0};  ///< 0-based, in frame order
    std::uint16_t station{0};
    std::uint16_t alias{0};
    wire::Identity identity{};
    std::string order;  ///< order text of its EEPROM, usually the type; empty where it has none
    std::string name;
    bool clock{false};            ///< distributed clock
    bool coe{false};              ///< objects by mailbox
    std::uint8_t openPorts{0};    ///< one bit for each port with a partner
    std::uint16_t mailboxOut{0};  ///< bytes; 0 = no mailbox
    std::uint16_t mailboxIn{0};
    wire::AlState state{wire::AlState::None};  ///< None: does not answer
    bool stateError{false};
    std::uint16_t alStatusCode{0};
};

/// Looks at a segment and at single devices, for tools and commissioning; never while a machine
/// runs on it.
///
///     SegmentTool tool{link, clock};
///     for (const SegmentDevice& device : tool.scan()) …
///     tool.toState(0, wire::AlState::PreOp);
///     tool.upload(0, {0x1018, 1});
///
/// Outside the cycle. Not thread-safe. Throws std::runtime_error with one line for people when the
/// segment as a whole does not answer.
class SegmentTool {
public:
    /// Both must outlive the tool.
    SegmentTool(wire::Link& link, core::ClockSource& clock);
    ~SegmentTool();
    SegmentTool(const SegmentTool&) = delete;
    SegmentTool& operator=(const SegmentTool&) = delete;

    /// Counts the devices, gives them station addresses and reads who they are. Changes no state.
    const std::vector<SegmentDevice>& scan();
    /// Reads the states of the devices that were scanned.
    const std::vector<SegmentDevice>& readStates();
    /// Leads one device step by step to INIT, PREOP, SAFEOP or OP; an old error is acknowledged.
    /// Nothing but the mailbox is configured, so that a device with process data refuses SAFEOP.
    /// \pre position < number of scanned devices
    /// \return true when it is there; what is seen of it stands in devices()
    bool toState(std::size_t position, wire::AlState target);
    /// Reads or writes an object of at most eight bytes. A device in INIT or PREOP is started
    /// afresh and stays in PREOP; one in SAFEOP or OP is asked as it is. \pre position < number of
    /// scanned devices
    core::ObjectReply upload(std::size_t position, core::ObjectAddress address);
    core::ObjectReply download(std::size_t position, core::ObjectAddress address,
                               const core::ObjectValue& value);

    /// The same for values of any length, in segments where the mailbox is too small for the whole.
    /// \param value is what was read, up to MostBytes; untouched when that failed
    core::ObjectReply uploadLong(std::size_t position, core::ObjectAddress address,
                                 std::vector<std::uint8_t>& value);
    /// \param value 1 byte or more
    core::ObjectReply downloadLong(std::size_t position, core::ObjectAddress address,
                                   std::span<const std::uint8_t> value);
    static constexpr std::size_t MostBytes = 65536;

    [[nodiscard]] const std::vector<SegmentDevice>& devices() const noexcept;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace takt::fieldbus::ethercat
