#pragma once

#include <cstdint>
#include <span>
#include <takt/core/object_access.hpp>
#include <takt/core/time.hpp>
#include <takt/fieldbus/ethercat/emergency.hpp>

#include "mailbox.hpp"

namespace takt::fieldbus::ethercat {

/// SDO upload and download, expedited and normal, one at a time (ETG.1000.6 5.6.2), and the
/// emergencies that arrive in between. A request that is not answered is repeated twice with a new
/// counter (F17).
class CoeClient {
public:
    CoeClient(Mailbox& mailbox, core::Duration requestTimeout, core::Duration responseTimeout);

    /// rt. Forgets a pending request (it fails) and the box counters.
    void reset() noexcept;
    /// rt. \return false while another request is pending
    bool startRead(core::ObjectAddress address) noexcept;
    /// rt. \return false while another request is pending
    bool startWrite(core::ObjectAddress address, const core::ObjectValue& value) noexcept;
    /// rt. The same with as many bytes as the mailbox holds; they must outlive the request. With
    /// `completeAccess` the object as a whole, from the sub-index on.
    bool startWrite(core::ObjectAddress address, std::span<const std::uint8_t> data,
                    bool completeAccess) noexcept;
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
    bool begin(core::ObjectAddress address) noexcept;
    void transmit() noexcept;
    void finish(core::ObjectState state, std::uint32_t abortCode) noexcept;
    void takeEmergency(std::span<const std::uint8_t> body) noexcept;
    void takeSdo(std::span<const std::uint8_t> sdo) noexcept;
    void takeUpload(std::span<const std::uint8_t> sdo) noexcept;

    Mailbox& mailbox_;
    core::Duration requestTimeout_;
    core::Duration responseTimeout_;
    core::ObjectAddress address_{};
    core::ObjectValue value_{};
    std::span<const std::uint8_t> data_{};  ///< to be written
    bool completeAccess_{false};
    bool writing_{false};
    bool timed_{false};
    std::uint8_t tries_{0};
    core::HostTime deadline_{};
    core::ObjectReply reply_{};
    EmergencyRecord emergency_{};
    std::uint32_t emergencies_{0};
    std::uint32_t unexpected_{0};
};

}  // namespace takt::fieldbus::ethercat
