#include "diagnosis_board.hpp"

namespace takt::daemon {

DeviceEntry entryOf(fieldbus::ethercat::Master& master, std::size_t device) noexcept {
    DeviceEntry entry;
    entry.state = master.deviceState(device);
    entry.group = static_cast<std::uint16_t>(master.groupOf(device));
    entry.counters = master.groups()[entry.group];
    entry.lostInRow = master.image(device).health->lostInRow;
    entry.emergencies = master.emergencies(device);
    entry.lastEmergency = master.lastEmergency(device).errorCode;
    return entry;
}

void DiagnosisBoard::show(const DiagnosisEntry& entry,
                          fieldbus::ethercat::Master& master) noexcept {
    if (next_ == 0) showing_ = asked_.load(std::memory_order_relaxed);
    for (std::size_t i = 0; i < MostPerCycle && next_ < devices.size(); ++i, ++next_) {
        devices[next_].write(entryOf(master, next_));
    }
    if (next_ < devices.size()) return;
    next_ = 0;
    run.write(entry);
    shown_.store(showing_, std::memory_order_release);
}

}  // namespace takt::daemon
