#pragma once

#include <cstdint>
#include <span>
#include <takt/core/object_access.hpp>
#include <takt/core/time.hpp>
#include <takt/fieldbus/ethercat/emergency.hpp>

#include "mailbox.hpp"

namespace takt::fieldbus::ethercat {

/// SDO upload and download, expedited, normal and in segments, one at a time (ETG.1000.6 5.6.2),
/// and the emergencies that arrive in between. A request that is not answered is repeated twice
/// with a new counter (F17); of a transfer in segments the whole is begun anew, since a device
/// refuses a segment that it has seen.
class CoeClient {
public:
    /// Whole: all entries from the sub-index (0 or 1) on, packed as ETG.1000.6 5.6.2.5 has it.
    enum class Access : std::uint8_t { OneEntry, Whole };

    CoeClient(Mailbox& mailbox, core::Duration requestTimeout, core::Duration responseTimeout);

    /// rt. Forgets a pending request (it fails) and the box counters.
    void reset() noexcept;
    /// rt. \return false while another request is pending
    bool startRead(core::ObjectAddress address) noexcept;
    /// rt. \return false while another request is pending
    bool startWrite(core::ObjectAddress address, const core::ObjectValue& value) noexcept;
    /// rt. Values of any length: `into` takes what is read and `from` is what is written; both must
    /// stay where they are until the request has ended. The reply carries no value.
    /// \return false while another request is pending
    bool startRead(core::ObjectAddress address, std::span<std::uint8_t> into) noexcept;
    bool startWrite(core::ObjectAddress address, std::span<const std::uint8_t> from,
                    Access access = Access::OneEntry) noexcept;
    /// rt. Bytes that the last read has brought.
    [[nodiscard]] std::size_t length() const noexcept { return done_; }
    /// rt. Ends the request at once with this abort code; for what needs no mailbox to be refused.
    void refuse(std::uint32_t abortCode) noexcept;
    [[nodiscard]] const core::ObjectReply& reply() const noexcept { return reply_; }
    [[nodiscard]] bool pending() const noexcept {
        return reply_.state == core::ObjectState::Pending;
    }

    /// rt. Repeats or gives up what was not answered in time.
    void watch(core::HostTime now) noexcept;
    /// rt. A message that the mailbox fetched.
    void take(const MailboxMessage& message) noexcept;

    [[nodiscard]] const EmergencyRecord& lastEmergency() const noexcept { return emergency_; }
    [[nodiscard]] std::uint32_t emergencies() const noexcept { return emergencies_; }
    [[nodiscard]] std::uint32_t unexpected() const noexcept { return unexpected_; }

private:
    bool begin(core::ObjectAddress address, bool writing) noexcept;
    void transmit() noexcept;
    std::size_t fillDownload(std::span<std::uint8_t> body) noexcept;
    void transmitSegment() noexcept;
    void send(std::size_t length) noexcept;
    void finish(core::ObjectState state, std::uint32_t abortCode) noexcept;
    void takeEmergency(std::span<const std::uint8_t> body) noexcept;
    void takeSdo(std::span<const std::uint8_t> sdo) noexcept;
    void takeUpload(std::span<const std::uint8_t> sdo) noexcept;
    void takeSegment(std::span<const std::uint8_t> sdo) noexcept;
    void takeData(std::span<const std::uint8_t> data) noexcept;
    void nextSegment() noexcept;

    Mailbox& mailbox_;
    core::Duration requestTimeout_;
    core::Duration responseTimeout_;
    core::ObjectAddress address_{};
    core::ObjectValue value_{};
    bool writing_{false};
    Access access_{Access::OneEntry};
    bool segmented_{false};               ///< the first message of the transfer is over
    std::uint8_t toggle_{0};              ///< of the segment under way
    std::span<std::uint8_t> into_{};      ///< where a read goes …
    std::span<const std::uint8_t> from_;  ///< … and what is written
    std::size_t size_{0};                 ///< of the whole object
    std::size_t done_{0};                 ///< bytes that are over
    bool timed_{false};
    std::uint8_t tries_{0};
    core::HostTime deadline_{};
    core::ObjectReply reply_{};
    EmergencyRecord emergency_{};
    std::uint32_t emergencies_{0};
    std::uint32_t unexpected_{0};
};

}  // namespace takt::fieldbus::ethercat
