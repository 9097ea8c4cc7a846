#include <gtest/gtest.h>

#include <takt/config/esi_reader.hpp>

#include "test_files.hpp"

namespace takt::config {
namespace {

using test::firstOf;
using test::lineOf;
using test::ScratchFolder;

const std::string SmallEsi = R"(<?xml version="1.0" encoding="ISO8859-1"?>
<!-- from the wild -->
<EtherCATInfo Version="1.2">
  <Vendor><Id>#x0000abcd</Id><Name><![CDATA[Firm & Co]]></Name><ImageData16x14>424d</ImageData16x14></Vendor>
  <Descriptions>
    <Devices>
      <Device Physics="YY" Invisible="0">
        <!-- a comment between -->
        <Type ProductCode="0x1234" RevisionNo="#x10001">DRV</Type>
        <Name LcId="2052">wrong</Name>
        <Name LcId="1033">Drive one</Name>
        <VendorSpecific><Whatever deep="1"><x/></Whatever></VendorSpecific>
        <Profile>
          <Dictionary>
            <DataTypes>
              <DataType><Name>UDINT</Name><BitSize>32</BitSize></DataType>
              <DataType><Name>MYINT</Name><BaseType>INT</BaseType><BitSize>16</BitSize></DataType>
              <DataType><Name>DT1C12ARR</Name><BaseType>UINT</BaseType><BitSize>32</BitSize>
                <ArrayInfo><LBound>1</LBound><Elements>2</Elements></ArrayInfo></DataType>
              <DataType><Name>DT1C12</Name><BitSize>48</BitSize>
                <SubItem><SubIdx>0</SubIdx><Name>SubIndex 000</Name><Type>USINT</Type><BitSize>8</BitSize><BitOffs>0</BitOffs>
                  <Flags><Access WriteRestrictions="PreOp">rw</Access></Flags></SubItem>
                <SubItem><Name>Elements</Name><Type>DT1C12ARR</Type><BitSize>32</BitSize><BitOffs>16</BitOffs>
                  <Flags><Access>RW</Access></Flags></SubItem>
              </DataType>
            </DataTypes>
            <Objects>
              <Object><Index>#x6098</Index><Name>Homing method</Name><Type>SINT</Type><BitSize>8</BitSize>
                <Info><DefaultValue>-1</DefaultValue><MinValue>#x80</MinValue><MaxValue>37</MaxValue></Info>
                <Flags><Access>rw</Access><PdoMapping>R</PdoMapping></Flags></Object>
              <Object><Index>#x1000</Index><Name>Device type</Name><Type>UDINT</Type><BitSize>32</BitSize>
                <Info><DefaultData>92010200</DefaultData></Info><Flags><Access>ro</Access></Flags></Object>
              <Object><Index>#x1008</Index><Name>Device name</Name><Type>STRING(3)</Type><BitSize>24</BitSize>
                <Info><DefaultString>abc</DefaultString></Info></Object>
              <Object><Index>#x1c12</Index><Name>Assignment</Name><Type>DT1C12</Type><BitSize>48</BitSize>
                <Info><SubItem><Name>SubIndex 000</Name><Info><DefaultData>01</DefaultData></Info></SubItem>
                      <SubItem><Name>SubIndex 001</Name><Info><DefaultData>0016</DefaultData></Info></SubItem></Info></Object>
              <Object><Index>#x2000</Index><Name>Own</Name><Type>MYINT</Type><BitSize>16</BitSize>
                <Flags><Access>wo</Access><PdoMapping>tr</PdoMapping></Flags></Object>
            </Objects>
          </Dictionary>
        </Profile>
        <Fmmu>Outputs</Fmmu><Fmmu>Inputs</Fmmu>
        <Sm DefaultSize="128" StartAddress="#x1000" ControlByte="#x26" Enable="1">MBoxOut</Sm>
        <Sm DefaultSize="128" StartAddress="#x1080" ControlByte="#x22" Enable="#x9">MBoxIn</Sm>
        <RxPdo Sm="2" Fixed="true" Mandatory="1"><Index DependOnSlot="0">#x1600</Index><Name>Out</Name>
          <Entry><Index>#x6040</Index><SubIndex>0</SubIndex><BitLen>16</BitLen><Name>Controlword</Name><DataType>UINT</DataType></Entry>
          <Entry Fixed="1"><Index>0</Index><BitLen>8</BitLen></Entry>
        </RxPdo>
        <TxPdo><Index>#x1A00</Index><Name>In</Name></TxPdo>
        <Mailbox><CoE SdoInfo="true" PdoAssign="1"/></Mailbox>
        <Dc><OpMode><Name>DC</Name><AssignActivate>#x0700</AssignActivate>
          <CycleTimeSync0 Factor="#xFFFE">0</CycleTimeSync0><ShiftTimeSync0>-5000</ShiftTimeSync0>
          <CycleTimeSync1 Factor="-1">0</CycleTimeSync1></OpMode></Dc>
      </Device>
    </Devices>
  </Descriptions>
</EtherCATInfo>
)";

class EsiFile : public testing::Test {
protected:
    std::vector<wire::DeviceDescription> read(std::string_view text) {
        return readEsi(folder_.write("device.xml", text), diagnostics_);
    }
    wire::DeviceDescription readSmall() {
        auto devices = read(SmallEsi);
        EXPECT_EQ(devices.size(), 1U) << format(diagnostics_);
        EXPECT_TRUE(diagnostics_.empty()) << format(diagnostics_);
        return devices.empty() ? wire::DeviceDescription{} : std::move(devices.front());
    }
    std::vector<wire::DeviceDescription> readWith(std::string_view old, std::string_view fresh) {
        std::string text = SmallEsi;
        const std::size_t at = text.find(old);
        EXPECT_NE(at, std::string::npos) << old;
        changedLine_ = lineOf(text, at);
        text.replace(at, old.size(), fresh);
        return read(text);
    }
    void expectError(std::string_view old, std::string_view fresh, std::string_view what) {
        EXPECT_TRUE(readWith(old, fresh).empty());
        ASSERT_EQ(diagnostics_.errorCount(), 1U) << format(diagnostics_);
        const Diagnostic error = firstOf(diagnostics_, Severity::Error);
        EXPECT_EQ(error.place.line, changedLine_) << format(diagnostics_);
        EXPECT_NE(error.what.find(what), std::string::npos) << format(diagnostics_);
        EXPECT_FALSE(error.allowed.empty());
    }

    ScratchFolder folder_;
    Diagnostics diagnostics_;
    int changedLine_{0};
};

TEST_F(EsiFile, TellsIdentityAndNames) {
    const auto device = readSmall();
    EXPECT_EQ(device.identity.vendor, 0xABCDU);
    EXPECT_EQ(device.identity.product, 0x1234U);
    EXPECT_EQ(device.identity.revision, 0x10001U);
    EXPECT_EQ(device.type, "DRV");
    EXPECT_EQ(device.name, "Drive one");
    EXPECT_EQ(device.vendorName, "Firm & Co");
    EXPECT_EQ(device.physics, "YY");
    EXPECT_TRUE(device.lrwSupported);
}

TEST_F(EsiFile, TellsSyncManagersFmmusAndMailbox) {
    const auto device = readSmall();
    ASSERT_EQ(device.syncManagers.size(), 2U);
    EXPECT_EQ(device.syncManagers[0].use, wire::SyncManagerUse::MailboxOut);
    EXPECT_EQ(device.syncManagers[1].start, 0x1080);
    EXPECT_EQ(device.syncManagers[1].control, 0x22);
    EXPECT_TRUE(device.syncManagers[1].enabled);
    EXPECT_EQ(device.fmmus, (std::vector{wire::FmmuUse::Outputs, wire::FmmuUse::Inputs}));
    ASSERT_TRUE(device.mailbox);
    EXPECT_TRUE(device.mailbox->coe && device.mailbox->sdoInfo && device.mailbox->pdoAssign);
    EXPECT_FALSE(device.mailbox->pdoConfig || device.mailbox->completeAccess);
    EXPECT_EQ(device.timeouts.preOp, std::chrono::milliseconds{3000});
}

TEST_F(EsiFile, TellsPdosWithGapsAndAssignment) {
    const auto device = readSmall();
    ASSERT_EQ(device.rxPdos.size(), 1U);
    EXPECT_EQ(device.rxPdos[0].index, 0x1600);
    EXPECT_EQ(device.rxPdos[0].syncManager, 2);
    EXPECT_TRUE(device.rxPdos[0].fixed && device.rxPdos[0].mandatory);
    ASSERT_EQ(device.rxPdos[0].entries.size(), 2U);
    EXPECT_EQ(device.rxPdos[0].entries[0].type, "UINT");
    EXPECT_EQ(device.rxPdos[0].entries[1].index, 0);
    EXPECT_EQ(device.rxPdos[0].entries[1].bits, 8);
    ASSERT_EQ(device.txPdos.size(), 1U);
    EXPECT_FALSE(device.txPdos[0].syncManager);
}

TEST_F(EsiFile, TellsDcModesWithBothWritingsOfAFactor) {
    const auto device = readSmall();
    ASSERT_EQ(device.dcModes.size(), 1U);
    EXPECT_EQ(device.dcModes[0].assignActivate, 0x0700);
    EXPECT_EQ(device.dcModes[0].cycleSync0Factor, -2);
    EXPECT_EQ(device.dcModes[0].cycleSync1Factor, -1);
    EXPECT_EQ(device.dcModes[0].shiftSync0, core::Duration{-5000});
}

TEST_F(EsiFile, SortsTheDictionary) {
    const auto device = readSmall();
    ASSERT_EQ(device.objects.size(), 5U);
    for (std::size_t i = 1; i < device.objects.size(); ++i) {
        EXPECT_LT(device.objects[i - 1].index, device.objects[i].index);
    }
}

TEST_F(EsiFile, TakesDefaultsAsDataValueAndText) {
    const auto device = readSmall();
    EXPECT_EQ(device.findObject(0x1000)->entries[0].defaultValue,
              (std::vector<std::uint8_t>{0x92, 0x01, 0x02, 0x00}));
    EXPECT_EQ(device.findObject(0x1008)->entries[0].defaultValue,
              (std::vector<std::uint8_t>{'a', 'b', 'c'}));
    const auto& method = device.findObject(0x6098)->entries[0];
    EXPECT_EQ(method.defaultValue, (std::vector<std::uint8_t>{0xFF}));
    EXPECT_EQ(method.minimum, -128) << "#x80 of a signed byte";
    EXPECT_EQ(method.maximum, 37);
    EXPECT_EQ(method.mappable, wire::PdoMappable::Receive);
}

TEST_F(EsiFile, UnfoldsArraysIntoSubindices) {
    const auto device = readSmall();
    const auto& entries = device.findObject(0x1C12)->entries;
    ASSERT_EQ(entries.size(), 3U);
    EXPECT_EQ(entries[0].bits, 8);
    EXPECT_TRUE(entries[0].writable && entries[0].writableOnlyInPreOp);
    EXPECT_EQ(entries[1].subindex, 1);
    EXPECT_EQ(entries[1].type, wire::DataType::Unsigned16);
    EXPECT_EQ(entries[1].defaultValue, (std::vector<std::uint8_t>{0x00, 0x16}));
    EXPECT_TRUE(entries[2].writable);
    EXPECT_EQ(entries[2].subindex, 2);
}

TEST_F(EsiFile, FollowsATypeToItsBase) {
    const auto device = readSmall();
    const auto& own = device.findObject(0x2000)->entries[0];
    EXPECT_EQ(own.type, wire::DataType::Integer16);
    EXPECT_FALSE(own.readable);
    EXPECT_TRUE(own.writable);
    EXPECT_EQ(own.mappable, wire::PdoMappable::Both);
}

TEST_F(EsiFile, ReadsAListOfInfos) {
    std::string text = SmallEsi;
    const std::size_t open = text.find("<EtherCATInfo ");
    text = text.substr(0, open) + "<EtherCATInfoList>" + text.substr(open) + "</EtherCATInfoList>";
    EXPECT_EQ(read(text).size(), 1U) << format(diagnostics_);
}

TEST_F(EsiFile, ReadsADeviceWithNearlyNothing) {
    const auto devices = read(
        "<EtherCATInfo><Vendor><Id>1</Id></Vendor><Descriptions><Devices><Device>"
        "<Type ProductCode=\"2\">T</Type></Device></Devices></Descriptions></EtherCATInfo>");
    ASSERT_EQ(devices.size(), 1U) << format(diagnostics_);
    EXPECT_EQ(devices[0].name, "T");
    EXPECT_FALSE(devices[0].mailbox);
    EXPECT_TRUE(devices[0].objects.empty());
}

TEST_F(EsiFile, LeavesOutOnlyTheFaultyDevice) {
    std::string text = SmallEsi;
    const std::size_t at = text.find("</Devices>");
    text.insert(at, "<Device><Type ProductCode=\"x\">BAD</Type></Device>");
    const auto devices = read(text);
    ASSERT_EQ(devices.size(), 1U);
    EXPECT_EQ(devices[0].type, "DRV");
    EXPECT_EQ(diagnostics_.errorCount(), 1U);
}

TEST_F(EsiFile, RefusesNonsenseNumbersWithTheirLine) {
    expectError("0x1234", "12ab", "'12ab' is not a number");
}
TEST_F(EsiFile, RefusesANumberOutOfRange) {
    expectError("#x1600", "#x11600", "out of range");
}
TEST_F(EsiFile, RefusesAHugeNumber) {
    expectError("#x10001", "99999999999999999999999999", "not a number");
}
TEST_F(EsiFile, RefusesAnOddFlag) {
    expectError("SdoInfo=\"true\"", "SdoInfo=\"maybe\"", "neither true nor false");
}
TEST_F(EsiFile, RefusesBrokenData) {
    expectError("92010200", "9201020", "not hexadecimal");
}
TEST_F(EsiFile, RefusesAMissingProductCode) {
    EXPECT_TRUE(readWith("ProductCode=\"0x1234\" ", "").empty());
    EXPECT_NE(format(diagnostics_).find("product code is missing"), std::string::npos);
}
TEST_F(EsiFile, RefusesAMissingVendor) {
    readWith("<Id>#x0000abcd</Id>", "");
    EXPECT_NE(format(diagnostics_).find("vendor's id is missing"), std::string::npos);
}
TEST_F(EsiFile, RefusesAFileWithoutDevices) {
    EXPECT_TRUE(read("<EtherCATInfo><Vendor><Id>1</Id></Vendor></EtherCATInfo>").empty());
    EXPECT_NE(format(diagnostics_).find("describes no device"), std::string::npos);
}
TEST_F(EsiFile, RefusesAnotherKindOfFile) {
    EXPECT_TRUE(read("<EtherCATConfig/>").empty());
    EXPECT_NE(format(diagnostics_).find("<EtherCATInfo>, <EtherCATInfoList>"), std::string::npos);
}
TEST_F(EsiFile, RefusesADocumentType) {
    EXPECT_TRUE(read("<!DOCTYPE x>"
                     "<EtherCATInfo/>")
                    .empty());
    EXPECT_TRUE(diagnostics_.hasErrors());
}

TEST_F(EsiFile, BoundsAHostileArray) {
    readWith("<Elements>2</Elements>", "<Elements>4000000000</Elements>");
    EXPECT_NE(format(diagnostics_).find("out of range"), std::string::npos);
}

TEST_F(EsiFile, BoundsAHostileDictionary) {
    std::string objects;
    for (int i = 0; i < 60'000; ++i)
        objects += "<Object><Index>1</Index><Type>DT1C12</Type></Object>";
    EXPECT_TRUE(readWith("            </Objects>", objects + "</Objects>").empty());
    EXPECT_NE(format(diagnostics_).find("dictionary is too large"), std::string::npos);
}

TEST_F(EsiFile, SurvivesTypesThatNameEachOther) {
    const auto devices = readWith("<Name>MYINT</Name><BaseType>INT</BaseType>",
                                  "<Name>MYINT</Name><BaseType>MYINT</BaseType>");
    ASSERT_EQ(devices.size(), 1U) << format(diagnostics_);
    EXPECT_EQ(devices[0].findObject(0x2000)->entries[0].type, wire::DataType::OctetString);
}

TEST_F(EsiFile, EveryTruncationIsAnsweredNotSuffered) {
    for (std::size_t length = 0; length < SmallEsi.size(); length += 13) {
        diagnostics_ = {};
        const auto devices = read(std::string_view{SmallEsi}.substr(0, length));
        EXPECT_TRUE(devices.empty()) << length;
        EXPECT_TRUE(diagnostics_.hasErrors()) << length;
    }
}

TEST_F(EsiFile, EveryFlippedByteIsEitherReadOrRefused) {
    for (std::size_t at = 0; at < SmallEsi.size(); at += 11) {
        std::string text = SmallEsi;
        text[at] = static_cast<char>(static_cast<unsigned char>(text[at]) ^ 0x15U);
        diagnostics_ = {};
        const auto devices = read(text);
        EXPECT_TRUE(!devices.empty() || diagnostics_.hasErrors()) << at;
    }
}

}  // namespace
}  // namespace takt::config
