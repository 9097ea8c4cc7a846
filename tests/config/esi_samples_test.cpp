#include <gtest/gtest.h>

#include <takt/config/esi_reader.hpp>

namespace takt::config {
namespace {

// Figures from the drives' manuals, not from the files that are read.

wire::DeviceDescription readSample(const char* name) {
    Diagnostics diagnostics;
    auto devices = readEsi(std::string{TAKT_SOURCE_DIR "/samples/devices/"} + name, diagnostics);
    EXPECT_TRUE(diagnostics.empty()) << format(diagnostics);
    EXPECT_EQ(devices.size(), 1U);
    return devices.empty() ? wire::DeviceDescription{} : std::move(devices.front());
}

std::vector<std::uint32_t> mapping(const wire::PdoDescription* pdo) {
    std::vector<std::uint32_t> words;
    if (pdo == nullptr) return words;
    for (const auto& entry : pdo->entries) {
        words.push_back(std::uint32_t{entry.index} << 16U | std::uint32_t{entry.subindex} << 8U |
                        entry.bits);
    }
    return words;
}

const wire::ObjectEntryDescription& entryOf(const wire::DeviceDescription& device,
                                            std::uint16_t index, std::uint8_t subindex = 0) {
    static const wire::ObjectEntryDescription None{};
    const auto* const object = device.findObject(index);
    if (object != nullptr) {
        for (const auto& entry : object->entries) {
            if (entry.subindex == subindex) return entry;
        }
    }
    ADD_FAILURE() << "no object " << std::hex << index << ":" << int{subindex};
    return None;
}

std::uint64_t defaultOf(const wire::DeviceDescription& device, std::uint16_t index,
                        std::uint8_t subindex = 0) {
    std::uint64_t value = 0;
    const auto& bytes = entryOf(device, index, subindex).defaultValue;
    for (std::size_t i = 0; i < bytes.size() && i < 8; ++i)
        value |= std::uint64_t{bytes[i]} << (8U * i);
    return value;
}

/// The default mapping in the PDO list and in the dictionary say the same.
void expectMappingObjects(const wire::DeviceDescription& device,
                          const std::vector<wire::PdoDescription>& pdos) {
    for (const auto& pdo : pdos) {
        const auto words = mapping(&pdo);
        EXPECT_EQ(defaultOf(device, pdo.index), words.size()) << std::hex << pdo.index;
        for (std::size_t i = 0; i < words.size(); ++i) {
            EXPECT_EQ(defaultOf(device, pdo.index, static_cast<std::uint8_t>(i + 1)), words[i])
                << std::hex << pdo.index;
        }
    }
}

/// Three-buffer areas and mailboxes must not overlap inside the process RAM.
void expectRoomForBuffers(const wire::DeviceDescription& device) {
    ASSERT_EQ(device.syncManagers.size(), 4U);
    std::uint32_t free = 0x1000;
    for (const auto& manager : device.syncManagers) {
        const bool buffered = (manager.control & 0x03U) == 0;
        EXPECT_GE(manager.start, free);
        EXPECT_GE(manager.maxSize, manager.defaultSize);
        free = manager.start + std::uint32_t{manager.maxSize} * (buffered ? 3U : 1U);
    }
    EXPECT_LE(free, 0x1000U + device.ramKib * 1024U);
}

TEST(Cd300eFile, HasTheDefaultMappingOfTheManual) {
    const auto device = readSample("cd300e.xml");
    EXPECT_EQ(mapping(device.findPdo(0x1600)),
              (std::vector<std::uint32_t>{0x60400010, 0x60600008, 0x607A0020, 0x60B80010}));
    EXPECT_EQ(mapping(device.findPdo(0x1A00)),
              (std::vector<std::uint32_t>{0x603F0010, 0x60410010, 0x60610008, 0x60640020,
                                          0x60B90010, 0x60BA0020, 0x60F40020}));
    EXPECT_EQ(device.syncManagers.at(2).defaultSize, 9);
    EXPECT_EQ(device.syncManagers.at(3).defaultSize, 19);
    expectMappingObjects(device, device.rxPdos);
    expectMappingObjects(device, device.txPdos);
}

TEST(Cd300eFile, OffersFourPdosOfEightEntriesEachWay) {
    const auto device = readSample("cd300e.xml");
    EXPECT_EQ(device.rxPdos.size(), 4U);
    EXPECT_EQ(device.txPdos.size(), 4U);
    for (const std::uint16_t index :
         std::initializer_list<std::uint16_t>{0x1600, 0x1603, 0x1A00, 0x1A03}) {
        const auto* const object = device.findObject(index);
        ASSERT_NE(object, nullptr);
        EXPECT_EQ(object->entries.size(), 9U);
        for (const auto& entry : object->entries)
            EXPECT_TRUE(entry.writable && entry.writableOnlyInPreOp);
    }
    EXPECT_EQ(device.findObject(0x1C12)->entries.size(), 5U);
    EXPECT_EQ(defaultOf(device, 0x1C12, 1), 0x1600U);
    EXPECT_EQ(defaultOf(device, 0x1C13, 1), 0x1A00U);
    EXPECT_TRUE(device.mailbox->pdoAssign && device.mailbox->pdoConfig);
    EXPECT_FALSE(device.mailbox->completeAccess || device.mailbox->sdoInfo);
}

TEST(Cd300eFile, HasTheObjectsOfTheManual) {
    const auto device = readSample("cd300e.xml");
    EXPECT_EQ(defaultOf(device, 0x1000), 0x00020192U);
    EXPECT_EQ(defaultOf(device, 0x6502), 0x3ADU);
    EXPECT_EQ(defaultOf(device, 0x6092, 1), 10000U);
    EXPECT_EQ(defaultOf(device, 0x6065), 50000U);
    EXPECT_EQ(defaultOf(device, 0x6099, 1), 35000U);
    EXPECT_EQ(defaultOf(device, 0x6099, 2), 15000U);
    EXPECT_EQ(defaultOf(device, 0x609A), 1000000U);
    EXPECT_EQ(defaultOf(device, 0x605A), 0U) << "delivered as coasting";
    EXPECT_TRUE(entryOf(device, 0x605A).writable);
    EXPECT_EQ(entryOf(device, 0x605A).type, wire::DataType::Integer16);
    EXPECT_EQ(entryOf(device, 0x6098).minimum, -18);
    EXPECT_EQ(entryOf(device, 0x6098).maximum, 35);
    EXPECT_EQ(entryOf(device, 0x6098).bits, 8);
    EXPECT_EQ(entryOf(device, 0x6040).mappable, wire::PdoMappable::Receive);
    EXPECT_EQ(entryOf(device, 0x6041).mappable, wire::PdoMappable::Transmit);
    EXPECT_FALSE(entryOf(device, 0x6041).writable);
    EXPECT_EQ(entryOf(device, 0x60FE, 1).mappable, wire::PdoMappable::Receive);
    EXPECT_EQ(entryOf(device, 0x1C32, 2).minimum, 125000);
    EXPECT_EQ(entryOf(device, 0x1C32, 2).maximum, 8000000);
    EXPECT_EQ(entryOf(device, 0x1008).bits, 15 * 8) << "Simphonix_Servo";
}

TEST(RaFile, HasThePresetsOfTheManual) {
    const auto device = readSample("ra.xml");
    EXPECT_EQ(
        mapping(device.findPdo(0x1600)),
        (std::vector<std::uint32_t>{0x60400010, 0x607A0020, 0x60FF0020, 0x60710010, 0x60600008}));
    EXPECT_EQ(
        mapping(device.findPdo(0x1A00)),
        (std::vector<std::uint32_t>{0x60410010, 0x60640020, 0x606C0020, 0x60770010, 0x60610008}));
    EXPECT_EQ(mapping(device.findPdo(0x1603)),
              (std::vector<std::uint32_t>{0x60400010, 0x60710010, 0x607F0020}));
    EXPECT_EQ(mapping(device.findPdo(0x1A02)),
              (std::vector<std::uint32_t>{0x60410010, 0x60640020, 0x606C0020}));
    EXPECT_EQ(device.syncManagers.at(2).defaultSize, 13);
    EXPECT_EQ(device.syncManagers.at(3).defaultSize, 13);
    expectMappingObjects(device, device.rxPdos);
    expectMappingObjects(device, device.txPdos);
}

TEST(RaFile, AssignsOnePdoOfSixteenEntriesEachWay) {
    const auto device = readSample("ra.xml");
    EXPECT_EQ(device.findObject(0x1600)->entries.size(), 17U);
    EXPECT_EQ(device.findObject(0x1C12)->entries.size(), 2U);
    EXPECT_EQ(entryOf(device, 0x1C12, 1).minimum, 0x1600);
    EXPECT_EQ(entryOf(device, 0x1C12, 1).maximum, 0x1603);
    EXPECT_FALSE(device.mailbox->completeAccess);
    EXPECT_TRUE(device.mailbox->sdoInfo);
    EXPECT_GE(device.syncManagers.at(0).minSize, 32);
    EXPECT_LE(device.syncManagers.at(0).maxSize, 256);
}

TEST(RaFile, HasTheObjectsOfTheManual) {
    const auto device = readSample("ra.xml");
    EXPECT_EQ(defaultOf(device, 0x1000), 0x04020192U);
    EXPECT_EQ(defaultOf(device, 0x6502), 0x3A0U);
    EXPECT_EQ(defaultOf(device, 0x6065), 3840000U);
    EXPECT_EQ(defaultOf(device, 0x6085), 200000U);
    EXPECT_EQ(defaultOf(device, 0x6099, 1), 5000U);
    EXPECT_EQ(defaultOf(device, 0x6099, 2), 100U);
    EXPECT_EQ(entryOf(device, 0x6099, 1).maximum, 30000);
    EXPECT_EQ(entryOf(device, 0x609A).maximum, 10000);
    EXPECT_EQ(entryOf(device, 0x6098).minimum, 1);
    EXPECT_EQ(entryOf(device, 0x607D, 2).maximum, 1073741824);
    EXPECT_EQ(entryOf(device, 0x60FD).mappable, wire::PdoMappable::Transmit);
    EXPECT_EQ(entryOf(device, 0x603F).mappable, wire::PdoMappable::Transmit);
    EXPECT_EQ(defaultOf(device, 0x1C32, 4), 7U);
    EXPECT_EQ(defaultOf(device, 0x1C32, 5), 125000U);
    EXPECT_EQ(defaultOf(device, 0x1C32), 0x20U);
    EXPECT_EQ(device.findObject(0x605A), nullptr) << "the drive has no stop options";
}

class BothFiles : public testing::TestWithParam<const char*> {};

TEST_P(BothFiles, AgreeWithTheirOwnIdentityObject) {
    const auto device = readSample(GetParam());
    EXPECT_EQ(defaultOf(device, 0x1018, 1), device.identity.vendor);
    EXPECT_EQ(defaultOf(device, 0x1018, 2), device.identity.product);
    EXPECT_EQ(defaultOf(device, 0x1018, 3), device.identity.revision);
}

TEST_P(BothFiles, LeaveRoomForThreeBuffers) {
    expectRoomForBuffers(readSample(GetParam()));
}

TEST_P(BothFiles, OfferDcWithSync0) {
    const auto device = readSample(GetParam());
    ASSERT_FALSE(device.dcModes.empty());
    EXPECT_EQ(device.dcModes[0].name, "DC-Synchron");
    EXPECT_EQ(device.dcModes[0].assignActivate, 0x0300);
    EXPECT_EQ(device.fmmuCount, 3);
    EXPECT_EQ(device.fmmus.size(), 3U);
}

TEST_P(BothFiles, GiveEveryObjectATypeOfItsSize) {
    const auto device = readSample(GetParam());
    EXPECT_GT(device.objects.size(), 50U);
    for (const auto& object : device.objects) {
        for (const auto& entry : object.entries) {
            EXPECT_NE(entry.bits, 0) << std::hex << object.index << ":" << int{entry.subindex};
            EXPECT_NE(entry.type, wire::DataType::OctetString) << std::hex << object.index;
            const std::size_t bytes = (entry.bits + 7U) / 8U;
            EXPECT_TRUE(entry.defaultValue.empty() || entry.defaultValue.size() == bytes);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Drives, BothFiles, testing::Values("cd300e.xml", "ra.xml"));

}  // namespace
}  // namespace takt::config
