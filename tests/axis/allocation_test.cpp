#include <cstdlib>
#include <new>

#include "axis_rig.hpp"

namespace {

bool counting = false;
int allocations = 0;

}  // namespace

// This executable counts its allocations; nothing else of the standard behaviour changes.
[[gnu::noinline]] void* operator new(std::size_t size) {
    if (counting) ++allocations;
    void* const p = std::malloc(size == 0 ? 1 : size);
    if (p == nullptr) throw std::bad_alloc{};
    return p;
}
[[gnu::noinline]] void operator delete(void* p) noexcept {
    std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept {
    std::free(p);
}

using namespace takt;
using namespace takt::test;
using axis::CommandKind;

TEST(AxisCycle, AllocatesNothing) {
    auto p = testParams();
    p.limits.softPositive = core::Position{250.0};
    Rig rig{p};
    counting = true;
    allocations = 0;
    const auto submit = [&](const axis::Command& c) {
        rig.cycle([&] { static_cast<void>(rig.port.submit(c)); });
        rig.cycles(60);
    };
    submit(command(CommandKind::PowerOn));
    submit(command(CommandKind::Home));
    rig.cycles(100);
    submit(moveTo(200.0, 400.0));
    submit(buffered(moveTo(20.0)));
    submit(buffered(moveTo(30.0)));
    submit(moveTo(10.0, 100.0));
    submit(runAt(500.0));
    rig.cycles(1000);
    submit(command(CommandKind::Stop));
    submit(command(CommandKind::PowerOff));
    submit(command(CommandKind::PowerOn));
    rig.drive.faultCode = 0x1234;
    rig.cycles(10);
    submit(command(CommandKind::Reset));
    counting = false;
    EXPECT_EQ(allocations, 0);
    EXPECT_EQ(rig.x.state(), AxisState::Standstill);
}
