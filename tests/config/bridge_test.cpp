#include <gtest/gtest.h>

#include "machine_base.hpp"

namespace takt::config {
namespace {

class BridgeElement : public test::MachineFile {
protected:
    [[nodiscard]] LoadResult loadDds(const std::string& attributes) {
        return loadWith("  <Twin clock", element(attributes));
    }
    void expectRefused(const std::string& attributes, std::string_view what,
                       std::string_view allowed) {
        expectError("  <Twin clock", element(attributes), what, allowed);
    }
    static std::string element(const std::string& attributes) {
        return "<Bridge><Dds " + attributes + "/></Bridge><Twin clock";
    }
};

TEST_F(BridgeElement, OpensNoDoorWhenItIsLeftOut) {
    const auto result = loadText(test::BaseMachine);
    ASSERT_TRUE(result.machine.has_value());
    EXPECT_FALSE(result.machine->bridge.dds.enabled);
}

TEST_F(BridgeElement, IsOpenToThisComputerWithoutCommandsUnlessToldOtherwise) {
    const auto result = loadDds("");
    ASSERT_TRUE(result.machine.has_value()) << format(result.diagnostics);
    const bridge::DdsParams& dds = result.machine->bridge.dds;
    EXPECT_TRUE(dds.enabled);
    EXPECT_EQ(dds.everyCycles, 10U);
    EXPECT_EQ(dds.domain, 0U);
    EXPECT_EQ(dds.interface, "lo");
    EXPECT_FALSE(dds.commands);
}

TEST_F(BridgeElement, SetsEverythingItNames) {
    const auto result = loadDds(R"(rate="0.25 kHz" domain="7" interface="lo" commands="on")");
    ASSERT_TRUE(result.machine.has_value()) << format(result.diagnostics);
    const bridge::DdsParams& dds = result.machine->bridge.dds;
    EXPECT_EQ(dds.everyCycles, 4U);
    EXPECT_EQ(dds.domain, 7U);
    EXPECT_TRUE(dds.commands);
}

TEST_F(BridgeElement, RefusesARateThatIsNoWholePartOfTheCycle) {
    expectRefused(R"(rate="300 Hz")", "every n-th cycle", "333.333 Hz, 250 Hz");
}
TEST_F(BridgeElement, RefusesARateAboveThatOfTheCycle) {
    expectRefused(R"(rate="2 kHz")", "every n-th cycle", "1000 Hz");
}
TEST_F(BridgeElement, RefusesARateOfNothing) {
    expectRefused(R"(rate="0 Hz")", "rate", "");
}
TEST_F(BridgeElement, RefusesADomainThatDoesNotExist) {
    expectRefused(R"(domain="231")", "domain", "0 to 230");
}
TEST_F(BridgeElement, RefusesAnInterfaceThatCannotExist) {
    expectRefused(R"(interface="a-name-of-16-abc")", "so long a name", "15");
}
TEST_F(BridgeElement, RefusesCommandsFromANetwork) {
    expectRefused(R"(interface="eth0" commands="on")", "could move the axes", "off");
}
TEST_F(BridgeElement, RefusesABridgeWithoutADoor) {
    expectError("  <Twin clock", "<Bridge/><Twin clock", "Dds", "");
}

}  // namespace
}  // namespace takt::config
