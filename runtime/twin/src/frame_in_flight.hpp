#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <takt/wire/frame.hpp>

namespace takt::twin {

/// A datagram on its way, decoded once when its frame was sent. The fields that slave controllers
/// change are kept here and written back to the frame's bytes when it leaves the segment.
struct Datagram {
    wire::DatagramView view;
    std::span<std::uint8_t> data;
    std::uint32_t logical{0};
    std::uint16_t adp{0};
    std::uint16_t ado{0};
    std::uint16_t workingCounter{0};
    std::uint16_t irq{0};
    std::uint8_t command{0};
};

/// A frame inside the segment.
struct FrameInFlight {
    static constexpr std::size_t MaxDatagrams =
        (wire::MaxFrameSize - wire::EthernetHeaderSize) / wire::DatagramOverhead;

    wire::Frame frame;
    std::array<Datagram, MaxDatagrams> datagrams;
    std::size_t count{0};
    bool latchesTimes{false};  ///< a datagram latches receive times on its way

    /// rt. Decodes the frame. \return false when it is not a sound EtherCAT frame
    bool decode() noexcept {
        count = 0;
        latchesTimes = false;
        wire::DatagramCursor cursor{frame.view()};
        while (count < MaxDatagrams && cursor.next()) {
            const wire::DatagramView& view = cursor.datagram();
            datagrams[count++] = {view,       view.data(),      view.logicalAddress(),
                                  view.adp(), view.ado(),       view.workingCounter(),
                                  view.irq(), view.rawCommand()};
        }
        return !cursor.malformed();
    }
    /// rt. Writes what has changed back into the bytes.
    void encode() noexcept {
        for (std::size_t i = 0; i < count; ++i) {
            const Datagram& datagram = datagrams[i];
            const auto command = static_cast<wire::Command>(datagram.command);
            // The first two address bytes of a logical datagram are not an ADP.
            if (command < wire::Command::Lrd || command > wire::Command::Lrw) {
                datagram.view.setAdp(datagram.adp);
            }
            datagram.view.orIrq(datagram.irq);
            datagram.view.setWorkingCounter(datagram.workingCounter);
        }
    }
};

}  // namespace takt::twin
