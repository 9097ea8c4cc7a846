#include <takt/core/cycle_guard.hpp>

// Present only when the trap library of the tests is loaded in front of the program.
extern "C" void taktTrapArm(bool on) __attribute__((weak));
extern "C" void taktTrapMayThrow(bool on) __attribute__((weak));

namespace takt::core {

namespace {
thread_local bool armed = false;

void tell(bool on) noexcept {
    armed = on;
    if (taktTrapArm != nullptr) taktTrapArm(on);
}
}  // namespace

void CycleGuard::arm(bool on) noexcept {
    tell(on);
}

CycleGuardPause::CycleGuardPause() noexcept : wasArmed_{armed} {
    if (wasArmed_) tell(false);
}

CycleGuardPause::~CycleGuardPause() {
    if (wasArmed_) tell(true);
}

ProgramCallGuard::ProgramCallGuard() noexcept {
    if (taktTrapMayThrow != nullptr) taktTrapMayThrow(true);
}

ProgramCallGuard::~ProgramCallGuard() {
    if (taktTrapMayThrow != nullptr) taktTrapMayThrow(false);
    if (armed) tell(true);
}

}  // namespace takt::core
