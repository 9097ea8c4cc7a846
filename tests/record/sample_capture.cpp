// Writes the capture of a small segment: sample_capture FILE. Three drives are addressed, their
// mailboxes and process data set up, brought to OP, and fifty cycles run. Every working counter
// stands here as a plain number, so that a judge of captures is tested against something that no
// slave model computed.
#include <algorithm>
#include <cstdio>
#include <string>
#include <takt/record/pcapng_writer.hpp>
#include <takt/wire/byte_io.hpp>
#include <takt/wire/frame.hpp>
#include <takt/wire/registers.hpp>
#include <utility>
#include <vector>

using namespace takt;
using wire::Command;

namespace {

constexpr std::uint16_t Slaves = 3;
constexpr std::uint32_t Logical = 0x00010000;
constexpr std::uint16_t Outputs = 8;
constexpr std::uint16_t Inputs = 12;
constexpr std::uint16_t Window = Slaves * (Outputs + Inputs);

using Bytes = std::vector<std::uint8_t>;

struct Datagram {
    Command command;
    std::uint32_t address;  ///< adp + ado << 16, or the logical address
    Bytes data;             ///< as sent
    std::uint16_t counter;  ///< as returned
    Bytes reply;            ///< data as returned; empty: as sent
};

std::uint32_t at(std::uint16_t adp, std::uint16_t ado) {
    return adp | (std::uint32_t{ado} << 16);
}

bool passesEverySlave(Command command) {
    return command == Command::Aprd || command == Command::Apwr || command == Command::Aprw ||
           command == Command::Brd || command == Command::Bwr || command == Command::Brw ||
           command == Command::Armw;
}

/// Sends frames and gives the answers of the segment.
class Segment {
public:
    explicit Segment(record::PcapngWriter& capture) : capture_{capture} {}

    void exchange(const std::vector<Datagram>& datagrams) {
        wire::Frame frame;
        wire::FrameWriter writer{frame};
        for (const Datagram& d : datagrams) {
            const auto place = writer.appendLogical(d.command, index_++, d.address,
                                                    static_cast<std::uint16_t>(d.data.size()));
            std::copy(d.data.begin(), d.data.end(), writer.data(place).begin());
        }
        writer.finish();
        put(record::Direction::Outbound, frame);
        frame.bytes[6] |= wire::SourceSeenBit;
        wire::DatagramCursor cursor{frame.view()};
        for (const Datagram& d : datagrams) {
            if (!cursor.next()) return;
            answer(d, cursor.datagram());
        }
        now_ += std::chrono::microseconds{20};
        put(record::Direction::Inbound, frame);
        now_ += std::chrono::microseconds{980};
    }
    void read(std::uint16_t station, std::uint16_t ado, const Bytes& reply,
              std::uint16_t counter = 1) {
        exchange({{Command::Fprd, at(station, ado), Bytes(reply.size()), counter, reply}});
    }
    void write(std::uint16_t station, std::uint16_t ado, const Bytes& data,
               std::uint16_t counter = 1) {
        exchange({{Command::Fpwr, at(station, ado), data, counter, {}}});
    }

private:
    static void answer(const Datagram& d, const wire::DatagramView& view) {
        std::copy(d.reply.begin(), d.reply.end(), view.data().begin());
        if (passesEverySlave(d.command)) {
            view.setAdp(static_cast<std::uint16_t>(view.adp() + Slaves));
        }
        view.setWorkingCounter(d.counter);
    }
    void put(record::Direction direction, const wire::Frame& frame) {
        capture_.packet(direction, core::HostTime{now_}, frame.view());
        capture_.drain();
    }

    record::PcapngWriter& capture_;
    std::chrono::nanoseconds now_{0};
    std::uint8_t index_{0};
};

Bytes syncManager(std::uint16_t start, std::uint16_t length, std::uint8_t control) {
    return {static_cast<std::uint8_t>(start),
            static_cast<std::uint8_t>(start >> 8),
            static_cast<std::uint8_t>(length),
            static_cast<std::uint8_t>(length >> 8),
            control,
            0,
            1,
            0};
}

Bytes fmmu(std::uint32_t logical, std::uint16_t length, std::uint16_t physical, std::uint8_t type) {
    Bytes bytes(16);
    wire::store32(bytes, 0, logical);
    wire::store16(bytes, 4, length);
    bytes[7] = 7;
    wire::store16(bytes, 8, physical);
    bytes[11] = type;
    bytes[12] = 1;
    return bytes;
}

/// An SDO upload of 1018h:01: the request, or the expedited answer with one byte.
Bytes mailbox(std::uint8_t coeService, std::uint8_t sdoCommand) {
    Bytes bytes{0x0A, 0, 0, 0, 0, 0x13, 0, coeService, sdoCommand, 0x18, 0x10, 0x01};
    bytes.resize(128);
    return bytes;
}

void bringUp(Segment& segment) {
    segment.exchange({{Command::Brd, at(0, wire::reg::Type), Bytes(2), Slaves, {0x11, 0x02}}});
    for (std::uint16_t i = 0; i < Slaves; ++i) {
        const auto station = static_cast<std::uint16_t>(1001 + i);
        const auto position = static_cast<std::uint16_t>(-i);
        segment.exchange(
            {{Command::Apwr,
              at(position, wire::reg::StationAddress),
              {static_cast<std::uint8_t>(station), static_cast<std::uint8_t>(station >> 8)},
              1,
              {}},
             {Command::Aprd, at(position, wire::reg::DlStatus), Bytes(2), 1, {0x31, 0x55}}});
    }
    segment.read(999, wire::reg::AlStatus, Bytes(2), 0);  // nobody has this address
    segment.exchange({{Command::Bwr, at(0, wire::reg::DcReceiveTimePort0), Bytes(4), Slaves, {}}});
    for (std::uint16_t station = 1001; station < 1001 + Slaves; ++station) {
        segment.write(station, wire::reg::SyncManager, syncManager(0x1000, 128, 0x26));
        segment.write(station, wire::reg::SyncManager + 8, syncManager(0x1080, 128, 0x22));
        segment.write(station, wire::reg::AlControl, {2, 0});
        segment.read(station, wire::reg::AlStatus, {2, 0, 0, 0, 0, 0});
        segment.write(station, 0x1000, mailbox(0x20, 0x40));
        segment.write(station, 0x1000, mailbox(0x20, 0x40), 0);  // the box is still full
        segment.read(station, 0x1080, Bytes(128), 0);            // no answer yet
        segment.read(station, 0x1080, mailbox(0x30, 0x4F));
    }
}

void processData(Segment& segment) {
    for (std::uint16_t i = 0; i < Slaves; ++i) {
        const auto station = static_cast<std::uint16_t>(1001 + i);
        const std::uint32_t outputs = Logical + i * std::uint32_t{Outputs};
        const std::uint32_t inputs = Logical + Slaves * Outputs + i * std::uint32_t{Inputs};
        segment.write(station, wire::reg::SyncManager + 16, syncManager(0x1100, Outputs, 0x64));
        segment.write(station, wire::reg::SyncManager + 24, syncManager(0x1400, Inputs, 0x20));
        segment.exchange({{Command::Fpwr,
                           at(station, wire::reg::Fmmu),
                           fmmu(outputs, Outputs, 0x1100, 2),
                           1,
                           {}},
                          {Command::Fpwr,
                           at(station, wire::reg::Fmmu + 16),
                           fmmu(inputs, Inputs, 0x1400, 1),
                           1,
                           {}}});
        // Not every device has put its inputs there before it is asked to go to SAFEOP.
        segment.exchange(
            {{Command::Lrw, Logical, Bytes(Window), static_cast<std::uint16_t>(2 * (i + 1)), {}}});
        segment.write(station, wire::reg::AlControl, {4, 0});
        segment.read(station, wire::reg::AlStatus, {4, 0});
    }
    segment.exchange({{Command::Lrw, Logical, Bytes(Window), 3 * Slaves, {}},
                      {Command::Lrd, Logical, Bytes(Window), Slaves, {}},
                      {Command::Lwr, Logical, Bytes(Window), Slaves, {}}});
    segment.exchange({{Command::Bwr, at(0, wire::reg::AlControl), {8, 0}, Slaves, {}}});
}

void cycles(Segment& segment) {
    for (int k = 0; k < 50; ++k) {
        segment.exchange(
            {{Command::Frmw, at(1001, wire::reg::DcSystemTime), Bytes(8), Slaves, Bytes(8, 0x33)},
             {Command::Lrw, Logical, Bytes(Window), 3 * Slaves, {}},
             {Command::Brd, at(0, wire::reg::AlStatus), Bytes(2), Slaves, {8, 0}},
             {Command::Fprd, at(1002, 0x080D), Bytes(1), 1, {0}},
             {Command::Nop, 0, Bytes(4), 0, {}}});
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: sample_capture FILE\n", stderr);
        return 2;
    }
    record::OutputFile file{argv[1]};
    record::PcapngWriter capture{file, "sample", std::size_t{1} << 16};
    Segment segment{capture};
    bringUp(segment);
    processData(segment);
    cycles(segment);
    return capture.finish() ? 0 : 1;
}
