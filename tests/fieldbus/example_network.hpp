#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <takt/fieldbus/fieldbus_params.hpp>
#include <takt/wire/device_description.hpp>

namespace takt::test {

/// A servo drive with a controlword and a target out, a statusword and a position in.
inline wire::DeviceDescription exampleDrive() {
    using namespace takt::wire;
    DeviceDescription device;
    device.type = "EXAMPLE";
    device.identity = {0x00000A0B, 0x00C0FFEE, 0x00010002, 0};
    device.physics = "YY";
    device.fmmuCount = 3;
    device.syncManagerCount = 4;
    device.fmmus = {FmmuUse::Outputs, FmmuUse::Inputs, FmmuUse::MailboxState};
    device.syncManagers = {{SyncManagerUse::MailboxOut, 0x1000, 128, 32, 256, 0x26, true},
                           {SyncManagerUse::MailboxIn, 0x1080, 128, 32, 256, 0x22, true},
                           {SyncManagerUse::Outputs, 0x1100, 6, 0, 128, 0x24, true},
                           {SyncManagerUse::Inputs, 0x1400, 6, 0, 128, 0x20, true}};
    MailboxDescription mailbox;
    mailbox.coe = mailbox.pdoAssign = mailbox.pdoConfig = true;
    device.mailbox = mailbox;
    device.rxPdos = {{0x1600,
                      "out",
                      2,
                      false,
                      false,
                      {{0x6040, 0, 16, "cw", "UINT"}, {0x607A, 0, 32, "tp", "DINT"}}},
                     {0x1601, "other", {}, false, false, {{0x6040, 0, 16, "cw", "UINT"}}}};
    device.txPdos = {{0x1A00,
                      "in",
                      3,
                      false,
                      false,
                      {{0x6041, 0, 16, "sw", "UINT"}, {0x6064, 0, 32, "pa", "DINT"}}}};
    return device;
}

inline fieldbus::SlaveParams exampleSlave(std::size_t position, const std::string& name) {
    fieldbus::SlaveParams slave;
    slave.name = name;
    slave.position = static_cast<std::uint16_t>(position);
    slave.device = std::make_shared<const wire::DeviceDescription>(exampleDrive());
    slave.outputs = {{0x1600, {{0x6040, 0, 16}, {0x607A, 0, 32}}, false}};
    slave.inputs = {{0x1A00, {{0x6041, 0, 16}, {0x6064, 0, 32}}, false}};
    slave.dc.enabled = true;
    slave.origin = "machine.xml:" + std::to_string(10 + position);
    return slave;
}

inline fieldbus::NetworkParams exampleNetwork(std::size_t slaves) {
    fieldbus::NetworkParams network;
    network.dcDriftFrames = 300;
    for (std::size_t i = 0; i < slaves; ++i) {
        network.slaves.push_back(
            exampleSlave(i, std::string(1, static_cast<char>('x' + static_cast<int>(i % 3)))));
    }
    return network;
}

}  // namespace takt::test
