#pragma once

#include <memory>
#include <string>
#include <takt/core/cia402.hpp>

#include "devices.hpp"
#include "drive.hpp"

namespace takt::twin::test {

/// A drive without a bus, at 1 ms: its objects are written and read directly.
class BareDrive {
public:
    explicit BareDrive(const std::string& profile, const MechanicsParams& mechanics = {})
        : description_{servoDescription(profile)}, dictionary_{*description_} {
        params_.profile = profile;
        params_.mechanics = mechanics;
        drive_ = std::make_unique<Drive>(params_, driveTraits(profile), dictionary_,
                                         std::chrono::milliseconds{1});
    }

    void set(std::uint16_t index, std::int64_t value, std::uint8_t subindex = 0) {
        dictionary_.set(at(index, subindex), value);
    }
    [[nodiscard]] std::int64_t get(std::uint16_t index, std::uint8_t subindex = 0) {
        return dictionary_.getSigned(at(index, subindex));
    }
    void run(int cycles) {
        for (int i = 0; i < cycles; ++i) {
            drive_->advance(drive_->subSteps());
            drive_->cycle(true, true);
        }
    }
    void give(std::uint16_t controlWord, int cycles) {
        set(core::cia402::ControlWord, controlWord);
        run(cycles);
    }
    /// Boots, chooses the mode and walks to Operation enabled.
    void enable(std::int8_t mode) {
        set(core::cia402::ModesOfOperation, mode);
        run(60);
        give(0x0006, 2);
        give(0x0007, 2);
        set(core::cia402::TargetPosition, get(core::cia402::PositionActual));
        give(0x000F, 10);
    }
    [[nodiscard]] std::uint16_t status() {
        return static_cast<std::uint16_t>(get(core::cia402::StatusWord));
    }
    [[nodiscard]] bool bit(int number) { return (status() >> number & 1) != 0; }
    [[nodiscard]] core::cia402::DriveState state() const { return drive_->state(); }
    [[nodiscard]] double turns() const { return drive_->motor().position(); }
    [[nodiscard]] double speed() const { return drive_->motor().velocity(); }
    Drive& drive() { return *drive_; }

private:
    [[nodiscard]] ObjectRef at(std::uint16_t index, std::uint8_t subindex) {
        // What the description lacks exists inside the drive with a type of its own.
        return dictionary_.internal(index, subindex, wire::DataType::Unsigned32, 0);
    }

    std::shared_ptr<wire::DeviceDescription> description_;
    ObjectDictionary dictionary_;
    TwinDeviceParams params_;
    std::unique_ptr<Drive> drive_;
};

}  // namespace takt::twin::test
