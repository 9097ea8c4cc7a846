#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <takt/core/clock_source.hpp>
#include <takt/core/object_access.hpp>
#include <takt/core/process_image.hpp>
#include <takt/core/time.hpp>
#include <takt/fieldbus/bus_timing.hpp>
#include <takt/fieldbus/ethercat/bring_up_problem.hpp>
#include <takt/fieldbus/ethercat/cycle_counters.hpp>
#include <takt/fieldbus/ethercat/dc_sample.hpp>
#include <takt/fieldbus/ethercat/device_state.hpp>
#include <takt/fieldbus/ethercat/emergency.hpp>
#include <takt/fieldbus/ethercat/network_state.hpp>
#include <takt/fieldbus/ethercat/object_user.hpp>
#include <takt/fieldbus/fieldbus_params.hpp>
#include <takt/wire/link.hpp>
#include <vector>

namespace takt::fieldbus::ethercat {

/// The master of one EtherCAT segment. It never tries the closest match: what is on the wire is
/// what is configured, or bring-up says line by line what differs.
///
///     Master master{network, link, clock};
///     auto problems = master.bringUp({});            // outside the cycle
///     master.requestOp();
///     wake = master.firstSend(clock.now());
///     each cycle: master.exchange(k); …inputs, set-points, outputs…; master.prepare();
///     master.requestInit();                          // and go on cycling until state() is Init
///
/// Not thread-safe: one thread owns the wire at a time. `state` and `counters` may be copied out by
/// it.
class Master {
public:
    /// Allocates everything it will ever need in the cycle. `link` and `clock` must outlive the
    /// master.
    Master(const NetworkParams& network, wire::Link& link, core::ClockSource& clock);
    ~Master();
    Master(const Master&) = delete;
    Master& operator=(const Master&) = delete;

    /// Outside the cycle. From any state to PREOP with identities checked, objects written, process
    /// data mapped, clocks settled and SYNC0 armed; may be called again after a failure. `progress`
    /// gets lines for people and may be empty. \return all problems; empty = ready for the cyclic
    /// phase
    /// \param goOn asked again and again; false: all devices are led to INIT, and that is the
    /// problem. May be empty
    std::vector<BringUpProblem> bringUp(const std::function<void(std::string_view)>& progress,
                                        const std::function<bool()>& goOn = {});

    /// The first host time at or after `notBefore` at which a frame that is sent then passes the
    /// reference clock just sync0AfterSend before a SYNC0. \pre bringUp() succeeded
    [[nodiscard]] core::HostTime firstSend(core::HostTime notBefore) const noexcept;

    /// rt. Sends the prepared frames, waits for the replies, takes inputs and health. A frame that
    /// does not come back, contradicts what was sent or has a wrong working counter leaves inputs
    /// as they were.
    void exchange(core::CycleNumber cycle) noexcept;
    /// rt. Puts the next frames together: reference time, outputs, AL status, one acyclic slice.
    void prepare() noexcept;

    /// rt. PREOP → SAFEOP → OP, in the cycles to come. In OP: acknowledges and leads up again what
    /// fell back.
    void requestOp() noexcept;
    /// rt. Down to INIT, in the cycles to come.
    void requestInit() noexcept;
    /// rt. Told by the cycle's DC lock; OP waits for it.
    void setClockLocked(bool locked) noexcept;

    [[nodiscard]] NetworkState state() const noexcept;
    [[nodiscard]] const DcSample& dcSample() const noexcept;
    [[nodiscard]] const BusTiming& timing() const noexcept;
    /// rt. \pre slave < number of configured slaves; the spans stay valid as long as the master
    [[nodiscard]] core::DeviceImage image(std::size_t slave) noexcept;
    /// rt. SDO by mailbox, served by the acyclic slice; from PREOP on.
    [[nodiscard]] core::ObjectAccess& objects(std::size_t slave,
                                              ObjectUser user = ObjectUser::Axis) noexcept;
    /// rt. AL state of a device as it was last seen; in OP it is read again whenever the bus as a
    /// whole shows that some device has another one.
    [[nodiscard]] DeviceState deviceState(std::size_t slave) const noexcept;
    /// rt. The last emergency of a slave and how many there were since bring-up.
    [[nodiscard]] const EmergencyRecord& lastEmergency(std::size_t slave) const noexcept;
    [[nodiscard]] std::uint32_t emergencies(std::size_t slave) const noexcept;

    /// rt. Counts since bring-up.
    [[nodiscard]] CycleCounters counters() const noexcept;
    /// rt. One entry for each process-data datagram.
    [[nodiscard]] std::span<const GroupCounters> groups() const noexcept;
    /// rt. The one that carries a device's process data.
    [[nodiscard]] std::size_t groupOf(std::size_t slave) const noexcept;
    /// Sum of the expected working counters of all process-data datagrams.
    [[nodiscard]] std::uint16_t expectedWorkingCounter() const noexcept;

    /// rt. The numbers behind problem().
    [[nodiscard]] const NetworkProblem& problemRecord() const noexcept;
    /// Outside the cycle. Why the network failed or which device fell back, in words; empty:
    /// nothing.
    [[nodiscard]] std::string problem() const;
    /// A problem of a network with these devices, in words; empty: none.
    [[nodiscard]] static std::string explain(const NetworkParams& network,
                                             const NetworkProblem& problem);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace takt::fieldbus::ethercat
