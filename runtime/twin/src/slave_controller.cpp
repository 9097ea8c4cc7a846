#include "slave_controller.hpp"

#include <algorithm>

#include "sii_image.hpp"

namespace takt::twin {

namespace reg = wire::reg;
using wire::Command;
using wire::load16;
using wire::store16;

namespace {

constexpr std::uint16_t EventDlStatus = 0x0004;
constexpr std::uint16_t EventAlStatus = 0x0008;
constexpr std::uint16_t EventSyncManagers = 0x0FF0;
constexpr std::uint8_t AliasEnabled = 0x01;  // of 0x0103
constexpr std::uint8_t SyncManagerInterrupt = 0x10;

bool covers(std::uint16_t address, std::size_t length, std::uint16_t start,
            std::uint16_t size) noexcept {
    return address < start + size && start < address + length;
}

}  // namespace

SlaveController::SlaveController(const wire::DeviceDescription& device,
                                 const ControllerSetup& setup, EventPort events)
    : registers_(RegisterSpace, 0),
      ram_(std::clamp<std::size_t>(device.ramKib, 1, 60) * 1024, 0),
      syncManagers_{registers_, ram_, device.syncManagerCount},
      watchdog_{registers_, events},
      eeprom_{registers_, buildSiiImage(device), true},
      fmmuCount_{std::min<std::size_t>(device.fmmuCount, MaxFmmus)} {
    if (!device.dcModes.empty()) {
        dc_.emplace(registers_, setup.clockPpm, setup.clockStart, events);
    }
    describeChip(device, setup);
}

void SlaveController::describeChip(const wire::DeviceDescription& device,
                                   const ControllerSetup& setup) {
    registers_[reg::Type] = 0xC0;
    registers_[reg::Revision] = 0x02;
    registers_[reg::FmmuCount] = static_cast<std::uint8_t>(fmmuCount_);
    registers_[reg::SyncManagerCount] =
        static_cast<std::uint8_t>(std::min<std::size_t>(device.syncManagerCount, MaxSyncManagers));
    registers_[reg::RamSize] = static_cast<std::uint8_t>(ram_.size() / 1024);
    std::uint32_t ports = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const char letter = i < device.physics.size() ? device.physics[i] : ' ';
        ports |= (letter == 'Y' || letter == 'H'   ? 3U
                  : letter == 'K' || letter == 'B' ? 2U
                                                   : 0U)
                 << (2 * i);
    }
    registers_[reg::PortDescriptor] = static_cast<std::uint8_t>(ports);
    const unsigned features = (dc_ ? reg::FeatureDc | reg::FeatureDc64 : 0U) |
                              (device.lrwSupported ? 0U : reg::FeatureNoLrw);
    store16(registers_, reg::Features, static_cast<std::uint16_t>(features));
    store16(registers_, reg::StationAlias, load16(eeprom_.image(), 8));
    registers_[reg::DlControl] = 0x01;
    registers_[reg::DlControl + 2U] = 0x07;
    store16(registers_, reg::AlControl, static_cast<std::uint16_t>(wire::AlState::Init));
    store16(registers_, reg::AlStatus, static_cast<std::uint16_t>(wire::AlState::Init));
    registers_[reg::PdiControl] = eeprom_.image()[0];
    registers_[reg::EscConfiguration] = eeprom_.image()[1];
    store16(registers_, reg::DcPulseLength, load16(eeprom_.image(), 4));
    // DL status: EEPROM loaded, PDI alive; port 0 towards the master is up, port 1 when a neighbour
    // is there; an open port shows "communication", a closed one "loop".
    const std::uint16_t port1 = setup.hasSuccessor ? 0x0820 : 0x0400;
    store16(registers_, reg::DlStatus,
            static_cast<std::uint16_t>(0x0003 | 0x0010 | 0x0200 | port1 | 0x5000));
}

std::uint16_t SlaveController::eventRequest() const noexcept {
    std::uint16_t request = load16(registers_, reg::EcatEventRequest);
    if ((load16(registers_, reg::EcatEventMask) & EventSyncManagers) == 0) return request;
    for (std::size_t sm = 0; sm < 8; ++sm) {
        const std::size_t base = reg::SyncManager + sm * reg::SyncManagerSize;
        const bool interrupt = (registers_[base + 4] & SyncManagerInterrupt) != 0;
        if (interrupt && (registers_[base + 5] & 0x03) != 0) {
            request = static_cast<std::uint16_t>(request | (0x10U << sm));
        }
    }
    return request;
}

bool SlaveController::answersTo(std::uint16_t station) const noexcept {
    if (load16(registers_, reg::StationAddress) == station) return true;
    return (registers_[reg::DlControl + 3U] & AliasEnabled) != 0 &&
           load16(registers_, reg::StationAlias) == station;
}

void SlaveController::process(Datagram& datagram, core::TrueTime now) noexcept {
    const std::uint16_t mask = load16(registers_, reg::EcatEventMask);
    if (mask != 0)
        datagram.irq = static_cast<std::uint16_t>(datagram.irq | (eventRequest() & mask));

    // Position and broadcast commands count every controller they pass; ETG.1000.4 clause 5.4.
    const std::uint16_t position = datagram.adp;
    const auto next = static_cast<std::uint16_t>(position + 1);
    switch (static_cast<Command>(datagram.command)) {
        case Command::Nop:
            break;
        case Command::Aprd:
            datagram.adp = next;
            if (position == 0) readPhysical(datagram, false, now);
            break;
        case Command::Apwr:
            datagram.adp = next;
            if (position == 0) writePhysical(datagram, now);
            break;
        case Command::Aprw:
            datagram.adp = next;
            if (position == 0) exchangePhysical(datagram, false, now);
            break;
        case Command::Fprd:
            if (answersTo(position)) readPhysical(datagram, false, now);
            break;
        case Command::Fpwr:
            if (answersTo(position)) writePhysical(datagram, now);
            break;
        case Command::Fprw:
            if (answersTo(position)) exchangePhysical(datagram, false, now);
            break;
        case Command::Brd:
            datagram.adp = next;
            readPhysical(datagram, true, now);
            break;
        case Command::Bwr:
            datagram.adp = next;
            writePhysical(datagram, now);
            break;
        case Command::Brw:
            datagram.adp = next;
            exchangePhysical(datagram, true, now);
            break;
        case Command::Lrd:
            processLogical(datagram, true, false, now);
            break;
        case Command::Lwr:
            processLogical(datagram, false, true, now);
            break;
        case Command::Lrw:
            processLogical(datagram, true, true, now);
            break;
        case Command::Armw:
            datagram.adp = next;
            if (position == 0) {
                readPhysical(datagram, false, now);
            } else {
                writePhysical(datagram, now);
            }
            break;
        case Command::Frmw:
            if (answersTo(position)) {
                readPhysical(datagram, false, now);
            } else {
                writePhysical(datagram, now);
            }
            break;
    }
}

void SlaveController::readPhysical(Datagram& datagram, bool combine, core::TrueTime now) noexcept {
    if (readMemory(datagram.ado, datagram.data, combine, now)) ++datagram.workingCounter;
}

void SlaveController::writePhysical(Datagram& datagram, core::TrueTime now) noexcept {
    if (writeMemory(datagram.ado, datagram.data, now)) ++datagram.workingCounter;
    if (!dc_ || !covers(datagram.ado, datagram.data.size(), reg::DcReceiveTimePort0, 1)) return;
    // Only BWR and FPWR latch the port times; every write latches 0x0918.
    const auto command = static_cast<Command>(datagram.command);
    dc_->latchArrival(now, command == Command::Bwr || command == Command::Fpwr);
}

void SlaveController::exchangePhysical(Datagram& datagram, bool combine,
                                       core::TrueTime now) noexcept {
    // The data as it arrived is written, the memory as it was before is returned.
    const std::span<std::uint8_t> arrived{scratch_.data(), datagram.data.size()};
    std::copy(datagram.data.begin(), datagram.data.end(), arrived.begin());
    if (readMemory(datagram.ado, datagram.data, combine, now)) ++datagram.workingCounter;
    const auto to =
        static_cast<std::uint16_t>(datagram.ado + load16(registers_, reg::PhysicalOffset));
    if (writeMemory(to, arrived, now)) {
        datagram.workingCounter = static_cast<std::uint16_t>(datagram.workingCounter + 2);
    }
    if (dc_ && covers(to, arrived.size(), reg::DcReceiveTimePort0, 1)) {
        dc_->latchArrival(now, false);
    }
}

void SlaveController::processLogical(Datagram& datagram, bool read, bool write,
                                     core::TrueTime now) noexcept {
    bool didRead = false;
    bool didWrite = false;
    core::FixedVector<Overlap, MaxFmmus> parts;
    for (const Fmmu& fmmu : fmmus_) {
        const Overlap part = overlapOf(fmmu, datagram.logical, datagram.data.size());
        static_cast<void>(parts.push(part));
        if (part.length == 0 || !write || !fmmu.write) continue;
        if (!read) {
            didWrite |= writeMapped(fmmu, part, datagram.data, now);
            continue;
        }
        // A unit that reads may replace bytes that are still to be written: keep them as they
        // arrived.
        const auto from = datagram.data.begin() + static_cast<std::ptrdiff_t>(part.datagramOffset);
        std::copy_n(from, part.length,
                    scratch_.begin() + static_cast<std::ptrdiff_t>(part.datagramOffset));
    }
    for (std::size_t i = 0; read && i < fmmus_.size(); ++i) {
        if (!fmmus_[i].read || parts[i].length == 0) continue;
        didRead |= readMapped(fmmus_[i], parts[i], datagram.data, now);
    }
    for (std::size_t i = 0; read && write && i < fmmus_.size(); ++i) {
        if (!fmmus_[i].write || parts[i].length == 0) continue;
        didWrite |= writeMapped(fmmus_[i], parts[i], {scratch_.data(), datagram.data.size()}, now);
    }
    // Once per direction however many units matched; LRW counts a write twice.
    const int counted = (didRead ? 1 : 0) + (didWrite ? (read ? 2 : 1) : 0);
    datagram.workingCounter = static_cast<std::uint16_t>(datagram.workingCounter + counted);
}

bool SlaveController::readMapped(const Fmmu& fmmu, const Overlap& part,
                                 std::span<std::uint8_t> data, core::TrueTime now) noexcept {
    const auto window = data.subspan(part.datagramOffset, part.length);
    if (fmmu.byteAligned()) {
        const auto address = static_cast<std::uint16_t>(fmmu.physical + part.unitOffset);
        return exists(address, part.length) && readMemory(address, window, false, now);
    }
    // Bit by bit: logical bits run from startBit of the first byte to stopBit of the last one.
    const std::size_t lastBit = (fmmu.length - std::size_t{1}) * 8 + fmmu.stopBit;
    bool any = false;
    for (std::size_t i = 0; i < part.length * 8; ++i) {
        const std::size_t logicalBit = part.unitOffset * 8 + i;
        if (logicalBit < fmmu.startBit || logicalBit > lastBit) continue;
        const std::size_t physicalBit = fmmu.physicalBit + logicalBit - fmmu.startBit;
        const auto address = static_cast<std::uint16_t>(fmmu.physical + physicalBit / 8);
        std::uint8_t byte = 0;
        if (!exists(address, 1) || !readMemory(address, {&byte, 1}, false, now)) continue;
        const auto mask = static_cast<std::uint8_t>(1U << (i % 8));
        const bool set = ((byte >> (physicalBit % 8)) & 1) != 0;
        window[i / 8] = static_cast<std::uint8_t>((window[i / 8] & ~mask) | (set ? mask : 0));
        any = true;
    }
    return any;
}

bool SlaveController::writeMapped(const Fmmu& fmmu, const Overlap& part,
                                  std::span<const std::uint8_t> data, core::TrueTime now) noexcept {
    const auto window = data.subspan(part.datagramOffset, part.length);
    if (fmmu.byteAligned()) {
        const auto address = static_cast<std::uint16_t>(fmmu.physical + part.unitOffset);
        return exists(address, part.length) && writeMemory(address, window, now);
    }
    // Neighbouring bits of a physical byte are undefined in real controllers; here they become 0.
    const std::size_t lastBit = (fmmu.length - std::size_t{1}) * 8 + fmmu.stopBit;
    std::size_t current = fmmu.physical;
    std::uint8_t byte = 0;
    bool gathered = false;
    bool any = false;
    for (std::size_t i = 0; i < part.length * 8; ++i) {
        const std::size_t logicalBit = part.unitOffset * 8 + i;
        if (logicalBit < fmmu.startBit || logicalBit > lastBit) continue;
        const std::size_t physicalBit = fmmu.physicalBit + logicalBit - fmmu.startBit;
        const std::size_t address = fmmu.physical + physicalBit / 8;
        if (gathered && address != current) {
            any |= exists(current, 1) &&
                   writeMemory(static_cast<std::uint16_t>(current), {&byte, 1}, now);
            byte = 0;
        }
        current = address;
        gathered = true;
        const bool set = ((window[i / 8] >> (i % 8)) & 1) != 0;
        if (set) byte = static_cast<std::uint8_t>(byte | (1U << (physicalBit % 8)));
    }
    if (gathered) {
        any |=
            exists(current, 1) && writeMemory(static_cast<std::uint16_t>(current), {&byte, 1}, now);
    }
    return any;
}

void SlaveController::countProcessingError() noexcept {
    std::uint8_t& counter = registers_[reg::ProcessingUnitError];
    if (counter < 0xFF) ++counter;
}

std::uint16_t SlaveController::takeAlControl() noexcept {
    registers_[reg::AlEventRequest] &= 0xFE;
    return load16(registers_, reg::AlControl);
}

void SlaveController::setAlStatus(std::uint16_t status, std::uint16_t code) noexcept {
    if (status != alStatus()) {
        store16(
            registers_, reg::EcatEventRequest,
            static_cast<std::uint16_t>(load16(registers_, reg::EcatEventRequest) | EventAlStatus));
    }
    store16(registers_, reg::AlStatus, status);
    store16(registers_, reg::AlStatusCode, code);
}

std::uint16_t SlaveController::alStatus() const noexcept {
    return load16(registers_, reg::AlStatus);
}
std::uint16_t SlaveController::alStatusCode() const noexcept {
    return load16(registers_, reg::AlStatusCode);
}

}  // namespace takt::twin
