#include <takt/wire/byte_io.hpp>

#include "master_fixture.hpp"

namespace {

using namespace takt;
using fieldbus::ethercat::NetworkState;
using test::MasterOnFake;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class MasterBringUp : public MasterOnFake {};
class MasterCycle : public MasterOnFake {};

TEST_F(MasterBringUp, EndsInPreOpWithoutProblems) {
    build(test::exampleNetwork(3));
    EXPECT_THAT(bringUp(), IsEmpty());
    EXPECT_EQ(master->state(), NetworkState::PreOp);
}

TEST_F(MasterBringUp, ReachesOpInTheCycles) {
    build(test::exampleNetwork(3));
    ASSERT_THAT(bringUp(), IsEmpty());
    EXPECT_TRUE(toOp()) << name(master->state()) << ' ' << master->problem();
    EXPECT_EQ(master->expectedWorkingCounter(), 9);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_TRUE(master->image(i).health->operational);
        EXPECT_TRUE(master->image(i).health->inputsFresh);
    }
}

}  // namespace
