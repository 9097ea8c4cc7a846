#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <takt/config/load_machine.hpp>
#include <vector>

#include "test_files.hpp"

namespace takt::config::test {

/// A good machine; each test changes one place of it.
inline const std::string BaseMachine = R"(<?xml version="1.0" encoding="UTF-8"?>
<Machine name="bench">
  <Network cycle="1 ms" lostFrames="3">
    <Esi file="devices/cd300e.xml"/>
    <Esi file="devices/ra.xml"/>
    <Slave name="x" device="CD300E">
      <Watchdog time="100 ms"/>
      <Startup index="0x6065" value="20000"/>
    </Slave>
    <Slave name="z" device="RA">
      <Dc mode="DC-Synchron" shift="0 us"/>
      <Pdo index="0x1600">
        <Entry index="0x6040" bits="16"/>
        <Entry index="0x607A" bits="32"/>
        <Entry index="0x6060" bits="8"/>
      </Pdo>
      <Pdo index="0x1A00">
        <Entry index="0x6041" bits="16"/>
        <Entry index="0x6064" bits="32"/>
        <Entry index="0x6061" bits="8"/>
        <Entry index="0x60FD" bits="32"/>
      </Pdo>
    </Slave>
  </Network>
  <Axis name="X" unit="mm">
    <Drive slave="x" maxSpeed="3000 rpm" lostCommunication="confirmed"/>
    <Scaling countsPerTurn="10000" gear="1/1" perTurn="20 mm"/>
    <Limits velocity="500 mm/s" acceleration="2000 mm/s^2" jerk="50000 mm/s^3"
            softNegative="-2 mm"
            softPositive="800 mm"/>
    <Homing method="19" switchSpeed="50 mm/s" zeroSpeed="5 mm/s" acceleration="1000 mm/s^2"/>
  </Axis>
  <Axis name="Z" unit="deg" vertical="true">
    <Drive slave="z" lostCommunication="confirmed"/>
    <Scaling countsPerTurn="32768" gear="10/1" perTurn="360 deg" modulo="360 deg"/>
    <Limits velocity="360 deg/s" acceleration="3600 deg/s^2"/>
    <Homing method="35"/>
  </Axis>
  <Program name="pick" library="libpick.so" budget="40 %"/>
  <Twin clock="12 ppm" wakeJitter="30 us">
    <Device slave="x" clock="35 ppm">
      <Mechanics start="120 mm" inertia="3 kg cm^2">
        <HomeSwitch from="-10 mm" to="5 mm"/>
      </Mechanics>
    </Device>
  </Twin>
</Machine>
)";

class MachineFile : public testing::Test {
protected:
    MachineFile() {
        std::filesystem::create_directory_symlink(TAKT_SOURCE_DIR "/samples/devices",
                                                  folder_.path() / "devices");
        folder_.write("libpick.so", "not looked into");
    }

    [[nodiscard]] LoadResult loadText(std::string_view text) const {
        return loadMachine(folder_.write("machine.xml", text));
    }

    /// Loads the base with one place exchanged.
    [[nodiscard]] LoadResult loadWith(std::string_view old, std::string_view fresh) {
        std::string text = BaseMachine;
        const std::size_t at = text.find(old);
        if (at == std::string::npos || text.find(old, at + 1) != std::string::npos) {
            ADD_FAILURE() << "not exactly once in the base: " << old;
            return {};
        }
        changedLine_ = lineOf(text, at);
        text.replace(at, old.size(), fresh);
        return loadText(text);
    }

    /// One place exchanged gives exactly one error, `lines` below that place.
    void expectError(std::string_view old, std::string_view fresh, std::string_view what,
                     std::string_view allowed, int lines = 0) {
        const LoadResult result = loadWith(old, fresh);
        EXPECT_FALSE(result.machine.has_value());
        const std::string all = format(result.diagnostics);
        ASSERT_EQ(result.diagnostics.errorCount(), 1U) << all;
        const Diagnostic error = firstOf(result.diagnostics, Severity::Error);
        EXPECT_EQ(error.place.line, changedLine_ + lines) << all;
        EXPECT_EQ(std::filesystem::path{error.place.file}.filename(), "machine.xml") << all;
        EXPECT_NE(error.what.find(what), std::string::npos) << all;
        EXPECT_NE(error.allowed.find(allowed), std::string::npos) << all;
    }

    ScratchFolder folder_;
    int changedLine_{0};
};

}  // namespace takt::config::test
