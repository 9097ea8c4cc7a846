#pragma once

#include <takt/record/pcapng_writer.hpp>
#include <takt/wire/link.hpp>

namespace takt::daemon {

/// A link whose frames are captured on their way: each sent frame and each frame that came back.
class TappedLink : public wire::Link {
public:
    TappedLink(wire::Link& inner, record::PcapngWriter& capture) noexcept
        : inner_{inner}, capture_{capture} {}

    wire::LinkStatus send(std::span<wire::Frame> frames) noexcept override;
    std::size_t receive(std::span<wire::Frame> slots, core::HostTime deadline) noexcept override;

private:
    wire::Link& inner_;
    record::PcapngWriter& capture_;
};

}  // namespace takt::daemon
