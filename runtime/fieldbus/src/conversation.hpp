#pragma once

#include <span>
#include <takt/core/clock_source.hpp>
#include <takt/wire/link.hpp>

#include "acyclic.hpp"
#include "frame_set.hpp"

namespace takt::fieldbus::ethercat {

/// Sends frames outside the cycle and waits for each: for bring-up only.
class Conversation {
public:
    Conversation(FrameSet& frames, wire::Link& link, core::ClockSource& clock)
        : frames_{frames}, link_{link}, clock_{clock} {}

    /// Sends what has been appended to `frames()` since begin() and waits for the replies.
    wire::LinkStatus exchange();
    /// One datagram, repeated while it is lost; its reply is valid until the next call.
    Reply ask(const Request& request);
    /// Steps the machines until none has work. Every machine ends by its own time-outs.
    void run(AcyclicSlice& slice, std::span<AcyclicMachine* const> machines);
    void pause(core::Duration duration);

    [[nodiscard]] FrameSet& frames() noexcept { return frames_; }
    [[nodiscard]] wire::LinkStatus linkStatus() const noexcept { return linkStatus_; }

private:
    FrameSet& frames_;
    wire::Link& link_;
    core::ClockSource& clock_;
    wire::LinkStatus linkStatus_{wire::LinkStatus::Ok};
};

}  // namespace takt::fieldbus::ethercat
