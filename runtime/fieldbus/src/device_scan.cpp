#include "device_scan.hpp"

#include <takt/wire/al_state.hpp>
#include <takt/wire/byte_io.hpp>
#include <takt/wire/registers.hpp>

namespace takt::fieldbus::ethercat {

namespace {

namespace reg = wire::reg;

constexpr core::Duration PhaseTimeout = std::chrono::seconds{5};
constexpr core::Duration LookGap = std::chrono::microseconds{250};
constexpr std::uint8_t SilentLimit = 20;
constexpr std::uint16_t InformationBytes = 10;
constexpr std::uint16_t EepromBytes = 14;  ///< control, address and data registers together
constexpr std::uint16_t EepromRead = 0x0100;
constexpr std::uint16_t EepromBusy = 0x8000;
constexpr std::uint16_t EepromErrors = 0x6000;  ///< acknowledge and write-enable errors
/// Double words of the SII: vendor, product, revision, serial, both mailboxes, protocols.
constexpr std::array<std::uint8_t, 7> Words{8, 10, 12, 14, 24, 26, 28};

}  // namespace

std::uint8_t ScannedDevice::openPorts() const noexcept {
    std::uint8_t open = 0;
    for (unsigned port = 0; port < 4; ++port) {
        if (((dlStatus >> (8 + 2 * port)) & 3U) == 2U)
            open = static_cast<std::uint8_t>(open | (1U << port));
    }
    return open;
}

void DeviceScan::enter(Phase phase, core::HostTime now) noexcept {
    phase_ = phase;
    deadline_ = now + PhaseTimeout;
    lookAt_ = now;
}

bool DeviceScan::next(core::HostTime now, Request& request) noexcept {
    if (!busy()) return false;
    if (!deadline_) enter(phase_, now);
    if (now > *deadline_) {
        result_ = phase_ == Phase::AwaitInit ? Result::NotInInit : Result::EepromFailed;
        return false;
    }
    if (now < lookAt_) return false;
    switch (phase_) {
        case Phase::AwaitInit:
            request = readRequest(station_, reg::AlStatus, 2);
            break;
        case Phase::Information:
            request = readRequest(station_, reg::Type, InformationBytes);
            break;
        case Phase::Ports:
            request = readRequest(station_, reg::DlStatus, 2);
            break;
        case Phase::EepromIdle:
        case Phase::Fetch:
            request = readRequest(station_, reg::EepromControl, EepromBytes);
            break;
        case Phase::ClearErrors:
            command_ = {};
            request = writeRequest(station_, reg::EepromControl, std::span{command_}.first(2));
            break;
        case Phase::Ask:
            wire::store16(command_, 0, EepromRead);
            wire::store32(command_, 2, Words[wordIndex_]);
            request = writeRequest(station_, reg::EepromControl, command_);
            break;
    }
    return true;
}

void DeviceScan::take(core::HostTime now, const Reply& reply) noexcept {
    if (!reply.served()) {
        if (++silent_ >= SilentLimit) result_ = Result::Silent;
        return;
    }
    silent_ = 0;
    switch (phase_) {
        case Phase::AwaitInit: {
            const unsigned state = wire::load16(reply.data, 0) & wire::AlStateMask;
            lookAt_ = now + LookGap;
            if (state == static_cast<unsigned>(wire::AlState::Init)) enter(Phase::Information, now);
            break;
        }
        case Phase::Information:
            device_.fmmus = reply.data[reg::FmmuCount];
            device_.syncManagers = reply.data[reg::SyncManagerCount];
            device_.features = wire::load16(reply.data, reg::Features);
            enter(Phase::Ports, now);
            break;
        case Phase::Ports:
            device_.dlStatus = wire::load16(reply.data, 0);
            enter(Phase::EepromIdle, now);
            break;
        case Phase::ClearErrors:
            enter(Phase::EepromIdle, now);
            break;
        case Phase::Ask:
            enter(Phase::Fetch, now);
            break;
        case Phase::EepromIdle:
        case Phase::Fetch:
            takeEeprom(now, reply.data);
            break;
    }
}

void DeviceScan::takeEeprom(core::HostTime now, std::span<const std::uint8_t> data) noexcept {
    constexpr std::size_t dataAt = 6;
    const std::uint16_t status = wire::load16(data, 0);
    lookAt_ = now + LookGap;
    if ((status & EepromBusy) != 0) return;
    if ((status & EepromErrors) != 0) {
        phase_ = Phase::ClearErrors;  // the deadline stays: a chip that never answers is given up
    } else if (phase_ == Phase::EepromIdle) {
        phase_ = Phase::Ask;
        lookAt_ = now;
    } else {
        keepWords(wire::load32(data, dataAt));
        if (++wordIndex_ == Words.size()) {
            result_ = Result::Done;
        } else {
            enter(Phase::EepromIdle, now);
        }
    }
}

void DeviceScan::keepWords(std::uint32_t words) noexcept {
    const MailboxWords box{static_cast<std::uint16_t>(words),
                           static_cast<std::uint16_t>(words >> 16)};
    switch (Words[wordIndex_]) {
        case 8:
            device_.identity.vendor = words;
            break;
        case 10:
            device_.identity.product = words;
            break;
        case 12:
            device_.identity.revision = words;
            break;
        case 14:
            device_.identity.serial = words;
            break;
        case 24:
            device_.mailboxOut = box;
            break;
        case 26:
            device_.mailboxIn = box;
            break;
        default:
            device_.protocols = box.start;
            break;
    }
}

}  // namespace takt::fieldbus::ethercat
