#pragma once

#include <string>
#include <takt/fieldbus/fieldbus_params.hpp>
#include <takt/wire/byte_io.hpp>
#include <vector>

/// Drives of 7 bytes out and 13 in, as a list of commands sets them up: station addresses from 2001
/// on, outputs of all before inputs of all at 0x01000000, an image that begins with eight bytes of
/// something else.
namespace takt::test {

constexpr std::uint32_t ListedLogical = 0x0100'0000;
constexpr std::uint32_t ImageStart = 8;
constexpr std::uint16_t OutputBytes = 7;
constexpr std::uint16_t InputBytes = 13;

using fieldbus::ListedCommand;
using fieldbus::Transition;
using Bytes = std::vector<std::uint8_t>;

inline ListedCommand write(Transition transition, std::uint16_t station, std::uint16_t address,
                           Bytes data, const std::string& comment) {
    ListedCommand command;
    command.transitions.add(transition);
    command.command = 5;  // FPWR
    command.adp = station;
    command.ado = address;
    command.data = std::move(data);
    command.workingCounter = 1;
    command.comment = comment;
    command.origin = "list.xml:" + comment;
    return command;
}

/// Asks for a state and checks that it is reached.
inline void toState(std::vector<ListedCommand>& commands, Transition transition,
                    std::uint16_t station, std::uint8_t request, std::uint8_t state) {
    commands.push_back(write(transition, station, 0x0120, {request, 0}, "ask for a state"));
    ListedCommand check = write(transition, station, 0x0130, {0, 0}, "check a state");
    check.command = 4;  // FPRD
    check.validation = {{state, 0}, {0x1F, 0}, std::chrono::seconds{3}};
    commands.push_back(check);
}

inline Bytes syncManager(std::uint16_t start, std::uint16_t length, std::uint8_t control) {
    Bytes data(8);
    wire::store16(data, 0, start);
    wire::store16(data, 2, length);
    data[4] = control;
    data[6] = 1;
    return data;
}

inline Bytes fmmu(std::uint32_t logical, std::uint16_t length, std::uint16_t physical,
                  std::uint8_t type) {
    Bytes data(16);
    wire::store32(data, 0, logical);
    wire::store16(data, 4, length);
    data[7] = 7;
    wire::store16(data, 8, physical);
    data[11] = type;
    data[12] = 1;
    return data;
}

inline fieldbus::ListedSlave listedSlave(std::size_t number, std::size_t count) {
    fieldbus::ListedSlave slave;
    slave.station = static_cast<std::uint16_t>(2001 + number);
    const std::uint16_t own = slave.station;
    const auto outputAt = static_cast<std::uint32_t>(OutputBytes * number);
    const auto inputAt = static_cast<std::uint32_t>(OutputBytes * count + InputBytes * number);
    slave.outputs = {8 * (ImageStart + outputAt), 8U * OutputBytes};
    slave.inputs = {8 * (ImageStart + inputAt), 8U * InputBytes};
    auto& list = slave.commands;
    ListedCommand address = write(Transition::InitToPreOp, static_cast<std::uint16_t>(0U - number),
                                  0x0010, {0, 0}, "station address");
    address.command = 2;  // APWR
    wire::store16(address.data, 0, own);
    list.push_back(address);
    using enum Transition;
    list.push_back(write(InitToPreOp, own, 0x0800, syncManager(0x1000, 128, 0x26), "SM0"));
    list.push_back(write(InitToPreOp, own, 0x0808, syncManager(0x1080, 128, 0x22), "SM1"));
    toState(list, InitToPreOp, own, 2, 2);
    Bytes cycles(8);
    wire::store32(cycles, 0, 1'000'000);
    list.push_back(write(PreOpToSafeOp, own, 0x09A0, cycles, "SYNC0 cycle"));
    list.push_back(write(PreOpToSafeOp, own, 0x0990, Bytes(8), "start time"));
    list.push_back(write(PreOpToSafeOp, own, 0x0980, {0x00, 0x03}, "SYNC0 on"));
    list.push_back(
        write(PreOpToSafeOp, own, 0x0810, syncManager(0x1100, OutputBytes, 0x64), "SM2"));
    list.push_back(write(PreOpToSafeOp, own, 0x0818, syncManager(0x1400, InputBytes, 0x20), "SM3"));
    list.push_back(write(PreOpToSafeOp, own, 0x0600,
                         fmmu(ListedLogical + outputAt, OutputBytes, 0x1100, 2), "FMMU0"));
    list.push_back(write(PreOpToSafeOp, own, 0x0610,
                         fmmu(ListedLogical + inputAt, InputBytes, 0x1400, 1), "FMMU1"));
    toState(list, PreOpToSafeOp, own, 4, 4);
    toState(list, SafeOpToOp, own, 8, 8);
    toState(list, OpToSafeOp, own, 4, 4);
    toState(list, SafeOpToPreOp, own, 2, 2);
    toState(list, PreOpToInit, own, 0x11, 1);
    return slave;
}

/// ARMW of four bytes, process data from SAFEOP on, AL status always.
inline std::vector<fieldbus::CyclicCommand> listedFrame(std::size_t count) {
    using Kind = fieldbus::CyclicCommand::Kind;
    fieldbus::CyclicCommand time;
    time.kind = Kind::ReferenceTime;
    time.command = 13;
    time.address = 0x0910'0000;
    time.length = 4;
    time.inPreOp = time.inSafeOp = time.inOp = true;
    fieldbus::CyclicCommand data;
    data.kind = Kind::ProcessData;
    data.command = 12;
    data.address = ListedLogical;
    data.length = static_cast<std::uint16_t>(count * (OutputBytes + InputBytes));
    data.workingCounter = static_cast<std::uint16_t>(3 * count);
    data.inSafeOp = data.inOp = true;
    data.inputOffset = data.outputOffset = ImageStart;
    fieldbus::CyclicCommand status = time;
    status.kind = Kind::AlStatus;
    status.command = 7;
    status.address = 0x0130'0000;
    status.length = 2;
    return {time, data, status};
}

/// Makes a worked-out network a listed one.
inline void makeListed(fieldbus::NetworkParams& network) {
    const std::size_t count = network.slaves.size();
    for (std::size_t i = 0; i < count; ++i) network.slaves[i].listed = listedSlave(i, count);
    fieldbus::ListedNetwork all;
    all.frames = {listedFrame(count)};
    all.outputBytes = all.inputBytes =
        ImageStart + static_cast<std::uint32_t>(count * (OutputBytes + InputBytes));
    ListedCommand counted = write(Transition::InitToPreOp, 0, 0x0130, {0, 0}, "count devices");
    counted.command = 7;  // BRD
    counted.workingCounter = static_cast<std::uint16_t>(count);
    counted.beforeSlaves = true;
    all.commands.push_back(counted);
    network.listed = all;
}

}  // namespace takt::test
