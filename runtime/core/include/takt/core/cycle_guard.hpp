#pragma once

namespace takt::core {

/// Marks the calling thread as being inside the cycle for the lifetime of the object. A test build,
/// or a trap library loaded in front of the program, then stops the process on any allocation or
/// lock. Without such a trap it costs one test of a pointer.
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

/// Lifts the guard where design allows it: inside the memory link, since the simulated world is not
/// the controller.
class CycleGuardPause {
public:
    CycleGuardPause() noexcept;
    ~CycleGuardPause();
    CycleGuardPause(const CycleGuardPause&) = delete;
    CycleGuardPause& operator=(const CycleGuardPause&) = delete;

private:
    bool wasArmed_;
};

/// Marks the call of a user program inside the cycle, catch clauses included. A program may throw
/// (it is then stopped, fault F33): from the throw to the end of this object memory may be touched.
class ProgramCallGuard {
public:
    ProgramCallGuard() noexcept;
    ~ProgramCallGuard();
    ProgramCallGuard(const ProgramCallGuard&) = delete;
    ProgramCallGuard& operator=(const ProgramCallGuard&) = delete;
};

}  // namespace takt::core
