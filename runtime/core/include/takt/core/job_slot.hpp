#pragma once

#include <atomic>
#include <cstdint>

namespace takt::core {

/// Where the cycle leaves one piece of work for whoever has time, and finds it done. What the work
/// is about lies beside the slot: the cycle touches it while the slot is free or done, the other
/// side while it is wanted.
///
///     if (slot.free()) { …fill in…; slot.want(); }            // the cycle
///     if (slot.wanted()) { …compute…; slot.finish(); }        // outside
///     if (slot.done()) { …take…; slot.release(); }            // the cycle, some cycles later
class JobSlot {
public:
    // The cycle's side (rt).
    [[nodiscard]] bool free() const noexcept { return is(State::Free); }
    [[nodiscard]] bool done() const noexcept { return is(State::Done); }
    /// \pre free()
    void want() noexcept { set(State::Wanted); }
    /// \pre done()
    void release() noexcept { set(State::Free); }

    // The side that computes.
    [[nodiscard]] bool wanted() const noexcept { return is(State::Wanted); }
    /// \pre wanted()
    void finish() noexcept { set(State::Done); }

private:
    enum class State : std::uint8_t { Free, Wanted, Done };

    [[nodiscard]] bool is(State state) const noexcept {
        return state_.load(std::memory_order_acquire) == state;
    }
    void set(State state) noexcept { state_.store(state, std::memory_order_release); }

    std::atomic<State> state_{State::Free};
};

}  // namespace takt::core
