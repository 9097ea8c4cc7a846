#pragma once

namespace takt::core {

/// Marks the calling thread as being inside the cycle for the lifetime of the object. A test build, or a
/// trap library loaded in front of the program, then stops the process on any allocation or lock.
/// Without such a trap it costs one test of a pointer.
class CycleGuard {
public:
    CycleGuard() noexcept { arm(true); }
    ~CycleGuard() { arm(false); }
    CycleGuard(const CycleGuard&) = delete;
    CycleGuard& operator=(const CycleGuard&) = delete;

private:
    static void arm(bool on) noexcept;
    friend class CycleGuardPause;
};

/// Lifts the guard where design allows it: inside the memory link (the simulated world is not the
/// controller) and on the catch path of a program that threw.
class CycleGuardPause {
public:
    CycleGuardPause() noexcept;
    ~CycleGuardPause();
    CycleGuardPause(const CycleGuardPause&) = delete;
    CycleGuardPause& operator=(const CycleGuardPause&) = delete;

private:
    bool wasArmed_;
};

}  // namespace takt::core
