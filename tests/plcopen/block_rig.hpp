#pragma once

#include <concepts>
#include <takt/plcopen/plcopen.hpp>

#include "../axis/axis_rig.hpp"

namespace takt::test {

using namespace takt::plcopen;  // the blocks are spelled as in the standard

/// At most one of Busy, Done, Error, CommandAborted, and of Active, Done, Error, CommandAborted.
inline void expectExclusive(bool busy, bool active, bool done, bool error, bool aborted,
                            ErrorId id) {
    EXPECT_LE(int{busy} + int{done} + int{error} + int{aborted}, 1);
    EXPECT_LE(int{active} + int{done} + int{error} + int{aborted}, 1);
    EXPECT_TRUE(!active || busy);
    EXPECT_EQ(error, id != ErrorId::None);
}
template <typename Move>
void expectExclusive(const Move& b) {
    expectExclusive(b.Busy, b.Active, b.Done, b.Error, b.CommandAborted, b.ErrorID);
}
inline void expectExclusive(const MC_MoveVelocity& b) {
    expectExclusive(b.Busy, b.Active, false, b.Error, b.CommandAborted, b.ErrorID);
    EXPECT_TRUE(!b.InVelocity || b.Active);
}
template <typename Move>
requires std::derived_from<Move, ContinuousMoveBlock>
void expectExclusive(const Move& b) {
    expectExclusive(b.Busy, b.Active, false, b.Error, b.CommandAborted, b.ErrorID);
    EXPECT_TRUE(!b.InEndVelocity || b.Active);
}
inline void expectExclusive(const MC_Stop& b) {
    // The lock after Done is shown by Active; see the block's own words.
    expectExclusive(b.Busy, b.Active && !b.Done, b.Done, b.Error, b.CommandAborted, b.ErrorID);
}
inline void expectExclusive(const MC_Reset& b) {
    expectExclusive(b.Busy, false, b.Done, b.Error, false, b.ErrorID);
}

/// A rig whose program calls the blocks given, in this order, in every cycle.
class BlockRig : public Rig {
public:
    explicit BlockRig(const axis::AxisParams& params = testParams()) : Rig{params}, axisX{port} {}

    template <typename... Blocks>
    void call(Blocks&... blocks) {
        cycle([&] {
            power(axisX);
            (one(blocks), ...);
            status(axisX);
        });
    }
    template <typename... Blocks>
    void calls(int n, Blocks&... blocks) {
        for (int i = 0; i < n; ++i) call(blocks...);
    }
    template <typename Condition, typename... Blocks>
    [[nodiscard]] bool callUntil(Condition&& condition, Blocks&... blocks) {
        for (int i = 0; i < 20000 && !condition(); ++i) call(blocks...);
        return condition();
    }
    void start() {
        power.Enable = true;
        status.Enable = true;
        ASSERT_TRUE(callUntil([&] { return power.Status; }));
        ASSERT_TRUE(status.Standstill);
    }

    axis::AxisRef axisX;
    MC_Power power;
    MC_ReadStatus status;

private:
    template <typename Block>
    void one(Block& block) {
        block(axisX);
        if constexpr (requires { block.Busy&& block.Execute; }) expectExclusive(block);
    }
};

inline void setMove(MC_MoveAbsolute& move, double position, double velocity = 100.0) {
    move.Position = position;
    move.Velocity = velocity;
}

}  // namespace takt::test
