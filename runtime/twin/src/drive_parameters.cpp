#include "drive_parameters.hpp"

#include <algorithm>
#include <takt/core/cia402.hpp>
#include <takt/wire/mailbox.hpp>

namespace takt::twin {

namespace cia = core::cia402;
namespace abortcode = wire::abortcode;

namespace {

constexpr std::uint16_t StoreObject = 0x1010;
constexpr std::uint8_t StoreCommand = 1;
constexpr std::uint8_t RestartCommand = 4;
constexpr core::Duration StoringTime = std::chrono::milliseconds{100};  // no manual gives one

// What may be written to 1010h:01.
enum Command : std::uint32_t {
    None = 0,
    Store = 1,
    RestoreAll = 2,  // reads 2 while a store is running
    RestoreCommunication = 3,
    RestoreAxis = 4,
    RestoreMotor = 8,
    ClearFaults = 12,
    StoreVerification = 0x786D68,
    InitialiseVerification = 0x786D6872,
};
constexpr std::uint32_t Storing = 2;

constexpr std::uint16_t StoredParameters = 0x2000;
constexpr std::uint16_t VolatileParameters = 0x3000;

bool known(std::uint32_t code) noexcept {
    switch (code) {
        case None:
        case Store:
        case RestoreAll:
        case RestoreCommunication:
        case RestoreAxis:
        case RestoreMotor:
        case ClearFaults:
        case StoreVerification:
        case InitialiseVerification:
            return true;
        default:
            return false;
    }
}

constexpr bool isGear(std::uint16_t index) {
    return index == 0x6091 || index == 0x6092;
}

/// Set-points and commands are not parameters, and what the bus is configured with is not kept.
bool isParameter(const DictionaryEntry& entry) noexcept {
    if (!entry.writable || entry.hidden || entry.index < 0x2000) return false;
    switch (entry.index) {
        case cia::ControlWord:
        case cia::ModesOfOperation:
        case cia::TargetTorque:
        case cia::TargetPosition:
        case cia::TargetVelocity:
        case cia::TouchProbeFunction:
        case cia::DigitalOutputs:
            return false;
        default:
            return entry.index < 0x60B0 || entry.index > 0x60B2;
    }
}

}  // namespace

DriveParameters::DriveParameters(ObjectDictionary& dictionary, const DriveTraits& traits,
                                 Drive& drive)
    : dictionary_{dictionary},
      traits_{traits},
      drive_{drive},
      delivered_{dictionary.values().begin(), dictionary.values().end()},
      stored_{delivered_} {}

bool DriveParameters::isCommand(std::uint16_t index, std::uint8_t subindex) const noexcept {
    return traits_.storesByCommand && index == StoreObject &&
           (subindex == StoreCommand || subindex == RestartCommand);
}

std::uint32_t DriveParameters::refusal(std::uint16_t index, std::uint8_t subindex,
                                       std::int64_t value) const noexcept {
    if (traits_.gearObjects && isGear(index) && drive_.powered()) {
        return abortcode::WrongDeviceState;
    }
    if (isCommand(index, subindex)) {
        if (storing_ > core::Duration{0}) return abortcode::WrongDeviceState;
        const bool fits = subindex == RestartCommand ? value == 0 || value == 1
                                                     : known(static_cast<std::uint32_t>(value));
        if (!fits) return abortcode::OutOfRange;
    }
    return 0;
}

void DriveParameters::written(const DictionaryEntry& entry) noexcept {
    if (traits_.gearObjects && isGear(entry.index)) drive_.takeGear();
    if (traits_.volatilePairs && entry.index >= StoredParameters &&
        entry.index < VolatileParameters) {
        const auto pair = static_cast<std::uint16_t>(entry.index + 0x1000);
        const DictionaryEntry* other = dictionary_.find(pair, entry.subindex);
        if (other != nullptr && other->size == entry.size) {
            const auto value = dictionary_.bytes(entry);
            std::copy(value.begin(), value.end(), dictionary_.bytes(*other).begin());
        }
    }
    if (!isCommand(entry.index, entry.subindex)) return;
    const auto value =
        static_cast<std::uint32_t>(dictionary_.getUnsigned(ObjectDictionary::refOf(entry)));
    if (entry.subindex == StoreCommand) command(value);
    if (entry.subindex == RestartCommand && value == 1) restart();
}

void DriveParameters::command(std::uint32_t code) noexcept {
    switch (code) {
        case Store:
            for (const DictionaryEntry& entry : dictionary_.entries()) {
                if (!isParameter(entry)) continue;
                const auto value = dictionary_.bytes(entry);
                std::copy(value.begin(), value.end(),
                          stored_.begin() + static_cast<std::ptrdiff_t>(entry.offset));
            }
            break;
        case RestoreAll:
            restore(0x2000, 0x6FFF);
            break;
        case RestoreCommunication:
            restore(0x2400, 0x25FF);
            break;
        case RestoreAxis:
            restore(0x3000, 0x6FFF);
            break;
        case RestoreMotor:
            restore(0x47FE, 0x47FE);
            break;
        default:
            break;  // nothing that is simulated
    }
    if (code == None) return;
    storing_ = StoringTime;
    if (const DictionaryEntry* entry = dictionary_.find(StoreObject, StoreCommand))
        dictionary_.set(ObjectDictionary::refOf(*entry), Storing);
}

void DriveParameters::restore(std::uint16_t first, std::uint16_t last) noexcept {
    for (const DictionaryEntry& entry : dictionary_.entries()) {
        if (!isParameter(entry) || entry.index < first || entry.index > last) continue;
        copy(entry, delivered_);
        const auto value = dictionary_.bytes(entry);
        std::copy(value.begin(), value.end(),
                  stored_.begin() + static_cast<std::ptrdiff_t>(entry.offset));
    }
    if (traits_.gearObjects && !drive_.powered()) drive_.takeGear();
}

void DriveParameters::restart() noexcept {
    for (const DictionaryEntry& entry : dictionary_.entries()) {
        if (isParameter(entry)) copy(entry, stored_);
    }
    if (const DictionaryEntry* entry = dictionary_.find(StoreObject, RestartCommand))
        dictionary_.set(ObjectDictionary::refOf(*entry), 0);
    drive_.restart();
    if (traits_.gearObjects) drive_.takeGear();
}

void DriveParameters::copy(const DictionaryEntry& entry,
                           const std::vector<std::uint8_t>& from) noexcept {
    std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(entry.offset), entry.size,
                dictionary_.bytes(entry).begin());
}

void DriveParameters::pass(core::Duration elapsed) noexcept {
    if (storing_ <= core::Duration{0}) return;
    storing_ -= elapsed;
    if (storing_ > core::Duration{0}) return;
    if (const DictionaryEntry* entry = dictionary_.find(StoreObject, StoreCommand))
        dictionary_.set(ObjectDictionary::refOf(*entry), 0);
}

}  // namespace takt::twin
