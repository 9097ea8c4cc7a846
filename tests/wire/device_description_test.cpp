#include <gmock/gmock.h>

#include <takt/wire/device_description.hpp>

namespace {

using namespace takt::wire;

DeviceDescription example() {
    DeviceDescription device;
    device.objects = {{0x1000, "type", {}}, {0x1018, "identity", {}}, {0x6040, "controlword", {}}};
    device.rxPdos = {{0x1600, "rx", 2, false, false, {}}};
    device.txPdos = {{0x1A00, "tx", 3, false, false, {}}};
    return device;
}

TEST(DeviceDescription, FindsObjectsByIndex) {
    const auto device = example();
    ASSERT_NE(device.findObject(0x1018), nullptr);
    EXPECT_EQ(device.findObject(0x1018)->name, "identity");
    EXPECT_EQ(device.findObject(0x6040)->name, "controlword");
    EXPECT_EQ(device.findObject(0x0FFF), nullptr);
    EXPECT_EQ(device.findObject(0x1017), nullptr);
    EXPECT_EQ(device.findObject(0x6041), nullptr);
}

TEST(DeviceDescription, FindsPdosOfBothDirections) {
    const auto device = example();
    EXPECT_EQ(device.findPdo(0x1600)->name, "rx");
    EXPECT_EQ(device.findPdo(0x1A00)->name, "tx");
    EXPECT_EQ(device.findPdo(0x1601), nullptr);
}

}  // namespace
