#include "test_master.hpp"

#include <algorithm>
#include <takt/wire/byte_io.hpp>

namespace takt::twin::test {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using wire::Command;

namespace {
constexpr std::uint32_t OutputsAt = 0x10000;
}  // namespace

Reply TestMaster::exchange(wire::Frame& frame, wire::DatagramPlace place) {
    if (tracing) trace.emplace_back(frame.bytes.begin(), frame.bytes.begin() + frame.size);
    twin_.link().send({&frame, 1});
    Reply reply;
    if (twin_.link().receive({&slot_, 1}, twin_.clock().now() + microseconds{500}) == 0)
        return reply;
    if (tracing) trace.emplace_back(slot_.bytes.begin(), slot_.bytes.begin() + slot_.size);
    const auto b = slot_.view();
    reply.arrived = true;
    reply.adp = static_cast<std::uint16_t>(number(b.subspan(place.offset + 2U, 2)));
    reply.irq = static_cast<std::uint16_t>(number(b.subspan(place.offset + 8U, 2)));
    const auto data = b.subspan(place.dataOffset(), place.length);
    reply.data.assign(data.begin(), data.end());
    reply.wkc = static_cast<std::uint16_t>(number(b.subspan(place.dataOffset() + place.length, 2)));
    return reply;
}

Reply TestMaster::send(Command command, std::uint16_t adp, std::uint16_t ado, const Bytes& data) {
    wire::FrameWriter writer{frame_};
    const auto place =
        writer.append(command, index_++, adp, ado, static_cast<std::uint16_t>(data.size()));
    std::copy(data.begin(), data.end(), writer.data(place).begin());
    writer.finish();
    return exchange(frame_, place);
}

Reply TestMaster::logical(Command command, std::uint32_t address, const Bytes& data) {
    wire::FrameWriter writer{frame_};
    const auto place =
        writer.appendLogical(command, index_++, address, static_cast<std::uint16_t>(data.size()));
    std::copy(data.begin(), data.end(), writer.data(place).begin());
    writer.finish();
    return exchange(frame_, place);
}

void TestMaster::addressAll() {
    for (std::size_t i = 0; i < twin_.deviceCount(); ++i) {
        send(Command::Apwr, static_cast<std::uint16_t>(0 - i), 0x0010, le16(station(i)));
    }
}

Bytes TestMaster::readSii(std::size_t device, std::uint32_t word) {
    const Bytes address = le32(word);
    const Bytes request{0x00, 0x01, address[0], address[1], address[2], address[3]};
    write(device, 0x0502, request);
    for (int polls = 0; polls < 100; ++polls) {
        if ((number(read(device, 0x0502, 2).data) & 0x8000) == 0) break;
    }
    return read(device, 0x0508, 8).data;
}

std::pair<std::uint16_t, std::uint16_t> TestMaster::requestState(std::size_t device,
                                                                 std::uint16_t control,
                                                                 core::Duration patience) {
    write(device, 0x0120, le16(control));
    const auto end = twin_.clock().now() + patience;
    Reply status;
    sleep(milliseconds{4});  // an error of before is still shown until the device has looked
    do {
        sleep(microseconds{500});
        status = read(device, 0x0130, 6);
    } while (twin_.clock().now() < end && (status.data[0] & 0x0F) != (control & 0x0F) &&
             (status.data[0] & 0x10) == 0);
    return {static_cast<std::uint16_t>(number(std::span{status.data}.first(2))),
            static_cast<std::uint16_t>(number(std::span{status.data}.subspan(4, 2)))};
}

void TestMaster::setMailboxes(std::size_t device) {
    write(device, 0x0800, {0x00, 0x10, 0x80, 0x00, 0x26, 0x00, 0x01, 0x00});
    write(device, 0x0808, {0x80, 0x10, 0x80, 0x00, 0x22, 0x00, 0x01, 0x00});
}

void TestMaster::setProcessData(std::size_t device, std::uint16_t outputs, std::uint16_t inputs) {
    outSize_ = outputs;
    inSize_ = inputs;
    const auto low = [](std::uint16_t v) { return static_cast<std::uint8_t>(v); };
    write(device, 0x0810, {0x00, 0x11, low(outputs), 0x00, 0x64, 0x00, 0x01, 0x00});
    write(device, 0x0818, {0x00, 0x14, low(inputs), 0x00, 0x20, 0x00, 0x01, 0x00});
    const auto fmmu = [&](std::uint16_t at, std::uint32_t logicalAt, std::uint16_t size,
                          std::uint16_t physical, std::uint8_t type) {
        Bytes b = le32(logicalAt);
        const Bytes rest{
            low(size), 0, 0, 7, low(physical), static_cast<std::uint8_t>(physical >> 8), 0, type,
            1,         0, 0, 0};
        b.insert(b.end(), rest.begin(), rest.end());
        write(device, at, b);
    };
    const auto number32 = static_cast<std::uint32_t>(device);
    fmmu(0x0600, OutputsAt + number32 * outputs, outputs, 0x1100, 2);
    // Inputs lie behind all outputs so that one LRW covers both.
    fmmu(0x0610,
         OutputsAt + static_cast<std::uint32_t>(twin_.deviceCount()) * outputs + number32 * inputs,
         inputs, 0x1400, 1);
}

void TestMaster::toPreOp() {
    addressAll();
    for (std::size_t i = 0; i < twin_.deviceCount(); ++i) {
        setMailboxes(i);
        requestState(i, 0x0002);
    }
}

Bytes TestMaster::mailbox(std::size_t device, const Bytes& message) {
    Bytes box = message;
    box.resize(128, 0);
    if (write(device, 0x1000, box).wkc != 1) return {};
    for (int polls = 0; polls < 40; ++polls) {
        sleep(microseconds{250});
        if ((read(device, 0x080D, 1).data[0] & 0x08) != 0) return read(device, 0x1080, 128).data;
    }
    return {};
}

namespace {
Bytes sdoMessage(std::uint8_t counter, const Bytes& sdo) {
    const auto length = static_cast<std::uint8_t>(sdo.size() + 2);
    Bytes message{length, 0, 0, 0, 0, static_cast<std::uint8_t>(0x03 | (counter << 4)), 0x00, 0x20};
    message.insert(message.end(), sdo.begin(), sdo.end());
    return message;
}
}  // namespace

SdoReply TestMaster::upload(std::size_t device, std::uint16_t index, std::uint8_t subindex) {
    counter_ = static_cast<std::uint8_t>(counter_ % 7 + 1);
    const Bytes answer = mailbox(
        device,
        sdoMessage(counter_, {0x40, static_cast<std::uint8_t>(index),
                              static_cast<std::uint8_t>(index >> 8), subindex, 0, 0, 0, 0}));
    if (answer.empty()) return {0x05040000, {}};
    const std::span<const std::uint8_t> sdo = std::span{answer}.subspan(8);
    if (sdo[0] == 0x80) return {static_cast<std::uint32_t>(number(sdo.subspan(4, 4))), {}};
    if ((sdo[0] & 0x02) != 0) {
        const auto data = sdo.subspan(4, 4U - ((sdo[0] >> 2) & 3U));
        return {0, {data.begin(), data.end()}};
    }
    const auto data = sdo.subspan(8, number(sdo.subspan(4, 4)));
    return {0, {data.begin(), data.end()}};
}

std::uint32_t TestMaster::download(std::size_t device, std::uint16_t index, std::uint8_t subindex,
                                   const Bytes& data) {
    counter_ = static_cast<std::uint8_t>(counter_ % 7 + 1);
    Bytes sdo{static_cast<std::uint8_t>(0x23 | ((4 - data.size()) << 2)),
              static_cast<std::uint8_t>(index), static_cast<std::uint8_t>(index >> 8), subindex};
    sdo.insert(sdo.end(), data.begin(), data.end());
    sdo.resize(8, 0);
    const Bytes answer = mailbox(device, sdoMessage(counter_, sdo));
    if (answer.empty()) return 0x05040000;
    return answer[8] == 0x80 ? static_cast<std::uint32_t>(number(std::span{answer}.subspan(12, 4)))
                             : 0;
}

void TestMaster::setUpClocks(int driftFrames) {
    send(Command::Bwr, 0, 0x0910, Bytes(32, 0));
    send(Command::Bwr, 0, 0x0934, {0x00, 0x0C});
    send(Command::Bwr, 0, 0x0930, le16(0x1000));
    send(Command::Bwr, 0, 0x0900, le32(0));
    const std::size_t count = twin_.deviceCount();
    std::vector<std::uint64_t> local(count);
    std::vector<std::uint32_t> port0(count);
    std::vector<std::uint32_t> port1(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Bytes times = read(i, 0x0900, 16).data;
        port0[i] = static_cast<std::uint32_t>(number(std::span{times}.first(4)));
        port1[i] = static_cast<std::uint32_t>(number(std::span{times}.subspan(4, 4)));
        local[i] = number(read(i, 0x0918, 8).data);
    }
    std::uint32_t delay = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (i > 0) {
            const std::uint32_t outer = port1[i - 1] - port0[i - 1];
            const std::uint32_t inner = i + 1 < count ? port1[i] - port0[i] : 0;
            delay += (outer - inner) / 2;
        }
        const std::uint64_t wanted = 1'000'000'000'000U + delay;
        write(i, 0x0920, le64(wanted - local[i]));
        write(i, 0x0928, le32(delay));
    }
    send(Command::Bwr, 0, 0x0930, le16(0x1000));
    for (int i = 0; i < driftFrames; ++i) send(Command::Frmw, station(0), 0x0910, Bytes(8, 0));
}

void TestMaster::startSync0(core::Duration cycleTime, core::Duration shift) {
    beat_ = cycleTime;
    const auto cycleNs = static_cast<std::uint64_t>(cycleTime.count());
    const std::uint64_t system = number(send(Command::Frmw, station(0), 0x0910, Bytes(8, 0)).data);
    const std::uint64_t start = (system + 20'000'000) / cycleNs * cycleNs;
    for (std::size_t i = 0; i < twin_.deviceCount(); ++i) {
        write(i, 0x0980, {0});
        write(i, 0x09A0, le32(static_cast<std::uint32_t>(cycleNs)));
        write(i, 0x0990, le64(start + static_cast<std::uint64_t>(shift.count())));
        write(i, 0x0981, {0x03});
    }
    // The next beat: where system time is a multiple of the cycle, by the host's own clock.
    const std::uint64_t now = number(send(Command::Frmw, station(0), 0x0910, Bytes(8, 0)).data);
    nextBeat_ =
        twin_.clock().now() + core::Duration{static_cast<std::int64_t>(cycleNs - now % cycleNs)};
}

void TestMaster::cycle() {
    if (!nextBeat_) nextBeat_ = twin_.clock().now() + beat_;
    while (*nextBeat_ < twin_.clock().now()) *nextBeat_ += beat_;
    twin_.clock().sleepUntil(*nextBeat_);
    *nextBeat_ += beat_;
    wire::FrameWriter writer{frame_};
    const auto clock = writer.append(Command::Frmw, index_++, station(0), 0x0910, 8);
    outputs_.resize(twin_.deviceCount() * outSize_, 0);
    inputs_.resize(twin_.deviceCount() * inSize_, 0);
    const auto size = static_cast<std::uint16_t>(outputs_.size() + inputs_.size());
    const auto data = writer.appendLogical(Command::Lrw, index_++, OutputsAt, size);
    std::copy(outputs_.begin(), outputs_.end(), writer.data(data).begin());
    writer.finish();
    const Reply reply = exchange(frame_, data);
    lastWkc = reply.wkc;
    if (!reply.arrived) return;
    std::copy(reply.data.begin() + static_cast<std::ptrdiff_t>(outputs_.size()), reply.data.end(),
              inputs_.begin());
    // Follow the reference clock, as the master of a DC segment does: a tenth of the phase error.
    const auto system = number(slot_.view().subspan(clock.dataOffset(), 8));
    auto phase = static_cast<std::int64_t>(system % static_cast<std::uint64_t>(beat_.count()));
    if (phase > beat_.count() / 2) phase -= beat_.count();
    *nextBeat_ -= core::Duration{phase / 10};
}

void TestMaster::toOp(core::Duration cycleTime) {
    toPreOp();
    for (std::size_t i = 0; i < twin_.deviceCount(); ++i) setProcessData(i);
    setUpClocks(1000);
    startSync0(cycleTime, cycleTime / 2);
    for (std::size_t i = 0; i < twin_.deviceCount(); ++i) {
        write(i, 0x0120, le16(0x0004));
    }
    cycles(100);
    for (std::size_t i = 0; i < twin_.deviceCount(); ++i) write(i, 0x0120, le16(0x0008));
    cycles(20);
}

std::uint64_t TestMaster::input(std::size_t device, std::size_t at, std::size_t size) const {
    return number(std::span{inputs_}.subspan(device * inSize_ + at, size));
}

void TestMaster::command(std::size_t device, std::uint16_t controlWord, std::int8_t mode,
                         std::int32_t target) {
    outputs_.resize(twin_.deviceCount() * outSize_, 0);
    const auto own = std::span{outputs_}.subspan(device * outSize_, 7);
    wire::store16(own, 0, controlWord);
    own[2] = static_cast<std::uint8_t>(mode);
    wire::store32(own, 3, static_cast<std::uint32_t>(target));
}

bool TestMaster::enable(std::size_t device, std::int8_t mode) {
    for (const std::uint16_t word : {std::uint16_t{6}, std::uint16_t{7}, std::uint16_t{15}}) {
        for (int i = 0; i < 20; ++i) {
            command(device, word, mode, position(device));
            cycle();
        }
    }
    return (statusWord(device) & 0x6F) == 0x27;
}

}  // namespace takt::twin::test
