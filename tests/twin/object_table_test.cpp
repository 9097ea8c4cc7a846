// Every object of the manuals' tables, read and written over SDO through the whole simulated
// device.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <span>
#include <takt/config/esi_reader.hpp>
#include <takt/wire/mailbox.hpp>

#include "devices.hpp"
#include "object_tables.hpp"
#include "position_scale.hpp"
#include "test_master.hpp"

namespace takt::twin::test {
namespace {

namespace abortcode = wire::abortcode;

/// A drive in PREOP, built from its sample device file.
class SampleDrive {
public:
    explicit SampleDrive(const std::string& profile) : params_{lineOf(1, profile)} {
        config::Diagnostics diagnostics;
        const auto file =
            std::filesystem::path{TAKT_SOURCE_DIR} / "samples/devices" / (profile + ".xml");
        const auto devices = config::readEsi(file, diagnostics);
        if (devices.empty()) throw std::runtime_error{file.string()};
        auto device = std::make_shared<wire::DeviceDescription>(devices.front());
        // The test master has its mailboxes at the places of the test devices.
        device->syncManagers = servoDescription(profile)->syncManagers;
        twin_ = std::make_unique<Twin>(
            params_, std::vector<std::shared_ptr<const wire::DeviceDescription>>{device},
            std::chrono::milliseconds{1});
        master_ = std::make_unique<TestMaster>(*twin_);
        master_->toPreOp();
    }
    TestMaster& master() { return *master_; }

private:
    TwinParams params_;
    std::unique_ptr<Twin> twin_;
    std::unique_ptr<TestMaster> master_;
};

Bytes bytesOf(std::int64_t value, std::size_t size) {
    Bytes bytes = le64(static_cast<std::uint64_t>(value));
    bytes.resize(size);
    return bytes;
}

/// Values that the running drive shows instead of what it was delivered with.
bool live(const ObjectRow& row) {
    switch (row.index) {
        case 0x603F:
        case 0x6041:
        case 0x6061:
        case 0x6062:
        case 0x6064:
        case 0x606B:
        case 0x606C:
        case 0x6074:
        case 0x6077:
        case 0x608F:
        case 0x60F4:
        case 0x60FD:
            return true;
        default:
            return row.index == 0x1C32 || row.index == 0x1C33 || row.index == 0x3EE1;
    }
}

/// Rules of their own: mapping and assignment.
bool configuresPdos(const ObjectRow& row) {
    return (row.index >= 0x1600 && row.index <= 0x1BFF) || row.index == 0x1C12 ||
           row.index == 0x1C13;
}

std::int64_t limitOf(const ObjectRow& row, bool upper) {
    const int bits = 8 * row.bytes;
    if (row.isSigned)
        return upper ? (std::int64_t{1} << (bits - 1)) - 1 : -(std::int64_t{1} << (bits - 1));
    return upper ? (std::int64_t{1} << bits) - 1 : 0;
}

std::string nameOf(const ObjectRow& row) {
    char text[16];
    std::snprintf(text, sizeof text, "%04X:%02X", row.index, row.subindex);
    return text;
}

void expectRow(TestMaster& master, const ObjectRow& row, bool detailedAborts) {
    SCOPED_TRACE(nameOf(row));
    const SdoReply read = master.upload(0, row.index, row.subindex);
    if (!row.readable) {
        EXPECT_EQ(read.abort, abortcode::WriteOnly);
        return;
    }
    ASSERT_EQ(read.abort, 0U);
    if (row.bytes == 0) return;
    EXPECT_EQ(read.data.size(), row.bytes);
    if (row.hasDefault && !live(row)) {
        EXPECT_EQ(read.data, bytesOf(row.value, row.bytes));
    }
    if (configuresPdos(row) || row.bytes > 4) return;  // the test master sends up to four bytes
    const auto write = [&](std::int64_t value, std::size_t size) {
        return master.download(0, row.index, row.subindex, bytesOf(value, size));
    };
    if (!row.writable) {
        EXPECT_EQ(write(0, row.bytes), abortcode::ReadOnly);
        return;
    }
    EXPECT_EQ(write(0, row.bytes == 1 ? 2U : row.bytes - 1U), abortcode::LengthMismatch);
    if (row.hasMaximum && row.maximum < limitOf(row, true)) {
        EXPECT_EQ(write(row.maximum + 1, row.bytes),
                  detailedAborts ? abortcode::ValueTooHigh : abortcode::OutOfRange);
    }
    if (row.hasMinimum && row.minimum > limitOf(row, false)) {
        EXPECT_EQ(write(row.minimum - 1, row.bytes),
                  detailedAborts ? abortcode::ValueTooLow : abortcode::OutOfRange);
    }
    const bool defaultIsLegal = row.index != 0x6098 || detailedAborts;  // RA: 0 is no method
    if (row.hasDefault && defaultIsLegal && !live(row)) {
        EXPECT_EQ(write(row.value, row.bytes), 0U);
    }
}

TEST(TwinObjectTable, EveryObjectOfTheCd300eManualAnswersAsPrinted) {
    SampleDrive drive{"cd300e"};
    for (const ObjectRow& row : Cd300eObjects) expectRow(drive.master(), row, true);
}

TEST(TwinObjectTable, EveryObjectOfTheRaManualAnswersAsPrinted) {
    SampleDrive drive{"ra"};
    for (const ObjectRow& row : RaObjects) expectRow(drive.master(), row, false);
}

TEST(TwinParameters, OfRaAreStoredUnderTwoThousandAndVolatileUnderThreeThousand) {
    SampleDrive drive{"ra"};
    TestMaster& master = drive.master();
    ASSERT_EQ(master.download(0, 0x2100, 0, le16(123)), 0U);
    EXPECT_EQ(number(master.upload(0, 0x3100, 0).data), 123U);
    ASSERT_EQ(master.download(0, 0x3100, 0, le16(77)), 0U);
    EXPECT_EQ(number(master.upload(0, 0x2100, 0).data), 123U);
    EXPECT_EQ(number(master.upload(0, 0x3100, 0).data), 77U);
}

TEST(TwinParameters, OfCd300eAreKeptOnlyAfterTheStoreCommand) {
    SampleDrive drive{"cd300e"};
    TestMaster& master = drive.master();
    ASSERT_EQ(master.download(0, 0x6065, 0, le32(1111)), 0U);
    ASSERT_EQ(master.download(0, 0x6085, 0, le32(2222)), 0U);
    ASSERT_EQ(master.download(0, 0x1010, 1, le32(1)), 0U);
    EXPECT_EQ(number(master.upload(0, 0x1010, 1).data), 2U);  // storing
    EXPECT_EQ(master.download(0, 0x1010, 1, le32(1)), abortcode::WrongDeviceState);
    master.sleep(std::chrono::milliseconds{150});
    EXPECT_EQ(number(master.upload(0, 0x1010, 1).data), 0U);
    ASSERT_EQ(master.download(0, 0x6065, 0, le32(3333)), 0U);
    ASSERT_EQ(master.download(0, 0x1010, 4, le32(1)), 0U);  // restart
    EXPECT_EQ(number(master.upload(0, 0x6065, 0).data), 1111U);
    EXPECT_EQ(number(master.upload(0, 0x6085, 0).data), 2222U);
    ASSERT_EQ(master.download(0, 0x1010, 1, le32(2)), 0U);  // as delivered
    EXPECT_EQ(number(master.upload(0, 0x6065, 0).data), 50'000U);
}

TEST(TwinParameters, OfCd300eKnowTheCommandsOfTheManualOnly) {
    SampleDrive drive{"cd300e"};
    TestMaster& master = drive.master();
    for (const std::uint32_t code : {5U, 0x65766173U, 0x64616F6CU}) {
        EXPECT_EQ(master.download(0, 0x1010, 1, le32(code)), abortcode::OutOfRange) << code;
    }
}

TEST(TwinParameters, TheGearOfCd300eFollowsItsObjects) {
    SampleDrive drive{"cd300e"};
    TestMaster& master = drive.master();
    EXPECT_EQ(number(master.upload(0, 0x6092, 1).data), 10'000U);
    EXPECT_EQ(number(master.upload(0, 0x608F, 1).data), 8'388'608U);
    ASSERT_EQ(master.download(0, 0x6092, 1, le32(36'000)), 0U);
    ASSERT_EQ(master.download(0, 0x6091, 1, le32(5)), 0U);
    // 5 turns of the motor are 36,000 counts: worked out with the position scale on its own.
    const PositionScale scale{36'000, true, 5};
    EXPECT_EQ(scale.fromCounts(36'000), 5 * 8'388'608);
    EXPECT_EQ(scale.counts(5 * 8'388'608), 36'000);
    EXPECT_EQ(scale.fromCounts(7200), 8'388'608);
}

}  // namespace
}  // namespace takt::twin::test
