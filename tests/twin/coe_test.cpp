#include <gtest/gtest.h>

#include <algorithm>

#include "devices.hpp"
#include "test_master.hpp"

namespace takt::twin::test {
namespace {

using std::chrono::milliseconds;

constexpr std::uint32_t ReadOnly = 0x06010002;
constexpr std::uint32_t Locked = 0x06010003;
constexpr std::uint32_t NoCompleteAccess = 0x06010004;
constexpr std::uint32_t NoObject = 0x06020000;
constexpr std::uint32_t NotMappable = 0x06040041;
constexpr std::uint32_t TooLong = 0x06040042;
constexpr std::uint32_t LengthMismatch = 0x06070010;
constexpr std::uint32_t NoSubindex = 0x06090011;
constexpr std::uint32_t OutOfRange = 0x06090030;
constexpr std::uint32_t DeviceState = 0x08000022;

template <char Kind>
class Fixture : public ::testing::Test {
protected:
    TwinParams params = lineOf(1, Kind == 'r' ? "ra" : "cd300e");
    Twin twin{params, descriptionsFor(params), milliseconds{1}};
    TestMaster master{twin};

    void SetUp() override { master.toPreOp(); }
    std::uint32_t map(std::uint16_t index, std::uint8_t sub, std::uint32_t value) {
        return master.download(0, index, sub,
                               sub == 0 ? Bytes{static_cast<std::uint8_t>(value)} : le32(value));
    }
};
using TwinCoe = Fixture<'c'>;
using TwinCoeRa = Fixture<'r'>;

Bytes request(std::uint8_t counter, std::uint8_t type, const Bytes& body) {
    const auto last = static_cast<std::uint8_t>(type | (counter << 4));
    Bytes message{static_cast<std::uint8_t>(body.size()), 0, 0x34, 0x12, 0, last};
    message.resize(6 + body.size());
    std::copy(body.begin(), body.end(), message.begin() + 6);
    return message;
}

TEST_F(TwinCoe, AnswersAnExpeditedUploadByteForByte) {
    const Bytes answer =
        master.mailbox(0, request(1, 3, {0x00, 0x20, 0x40, 0x65, 0x60, 0, 0, 0, 0, 0}));
    const Bytes expected{10,   0,    0x34, 0x12, 0,    0x13, 0x00, 0x30,
                         0x43, 0x65, 0x60, 0x00, 0x50, 0xC3, 0,    0};
    ASSERT_GE(answer.size(), expected.size());
    EXPECT_EQ(Bytes(answer.begin(), answer.begin() + 16), expected);
}

TEST_F(TwinCoe, AnswersAnAbortByteForByte) {
    const Bytes answer =
        master.mailbox(0, request(1, 3, {0x00, 0x20, 0x40, 0x34, 0x12, 5, 0, 0, 0, 0}));
    const Bytes expected{10, 0, 0x34, 0x12, 0, 0x13, 0x00, 0x30, 0x80, 0x34, 0x12, 5, 0, 0, 2, 6};
    ASSERT_GE(answer.size(), expected.size());
    EXPECT_EQ(Bytes(answer.begin(), answer.begin() + 16), expected);
}

TEST_F(TwinCoe, ShowsTheIdentityOfTheSii) {
    EXPECT_EQ(number(master.upload(0, 0x1018, 1).data), 0xAFFEU);
    EXPECT_EQ(number(master.upload(0, 0x1018, 2).data), 0x42U);
    EXPECT_EQ(number(master.upload(0, 0x1018, 3).data), 0x00010002U);
    EXPECT_EQ(number(master.upload(0, 0x1C00, 3).data), 3U);
}

TEST_F(TwinCoe, UploadsWhatIsLongerThanFourBytesInOnePiece) {
    const SdoReply reply = master.upload(0, 0x1008, 0);
    EXPECT_EQ(std::string(reply.data.begin(), reply.data.end()),
              "A drive with a name longer than four bytes");
}

TEST_F(TwinCoe, WritesAndReadsBack) {
    EXPECT_EQ(master.download(0, 0x6065, 0, le32(1234)), 0U);
    EXPECT_EQ(number(master.upload(0, 0x6065, 0).data), 1234U);
}

TEST_F(TwinCoe, RefusesWhatDoesNotExistOrMayNotBeWritten) {
    EXPECT_EQ(master.upload(0, 0x5000, 0).abort, NoObject);
    EXPECT_EQ(master.upload(0, 0x6099, 9).abort, NoSubindex);
    EXPECT_EQ(master.download(0, 0x6041, 0, le16(0)), ReadOnly);
    EXPECT_EQ(master.download(0, 0x6065, 0, le16(0)), LengthMismatch);
    EXPECT_EQ(master.download(0, 0x6060, 0, {7}), OutOfRange);
}

TEST_F(TwinCoe, RefusesCompleteAccess) {
    const Bytes answer =
        master.mailbox(0, request(1, 3, {0x00, 0x20, 0x50, 0x18, 0x10, 0, 0, 0, 0, 0}));
    EXPECT_EQ(number(std::span{answer}.subspan(12, 4)), NoCompleteAccess);
}

TEST_F(TwinCoe, DropsARepeatedRequestByItsCounter) {
    const Bytes write1 = request(3, 3, {0x00, 0x20, 0x23, 0x65, 0x60, 0, 1, 0, 0, 0});
    const Bytes write2 = request(3, 3, {0x00, 0x20, 0x23, 0x65, 0x60, 0, 2, 0, 0, 0});
    EXPECT_FALSE(master.mailbox(0, write1).empty());
    EXPECT_TRUE(master.mailbox(0, write2).empty());
    EXPECT_EQ(number(master.upload(0, 0x6065, 0).data), 1U);
}

TEST_F(TwinCoe, NeverDropsRequestsWithoutCounter) {
    const Bytes read = request(0, 3, {0x00, 0x20, 0x40, 0x65, 0x60, 0, 0, 0, 0, 0});
    EXPECT_FALSE(master.mailbox(0, read).empty());
    EXPECT_FALSE(master.mailbox(0, read).empty());
}

TEST_F(TwinCoe, CountsItsOwnMessagesFromOneToSeven) {
    for (const unsigned expected : {1U, 2U, 3U, 4U, 5U, 6U, 7U, 1U}) {
        const Bytes answer =
            master.mailbox(0, request(0, 3, {0x00, 0x20, 0x40, 0x65, 0x60, 0, 0, 0, 0, 0}));
        EXPECT_EQ(answer[5] >> 4, expected);
    }
}

TEST_F(TwinCoe, AnswersForeignProtocolsAndBrokenMessagesWithAMailboxError) {
    const auto detail = [&](const Bytes& message) {
        const Bytes answer = master.mailbox(0, message);
        if (answer.empty() || (answer[5] & 0x0F) != 0) return std::uint64_t{0xFFFF};
        EXPECT_EQ(number(std::span{answer}.subspan(6, 2)), 1U);
        return number(std::span{answer}.subspan(8, 2));
    };
    EXPECT_EQ(detail(request(1, 4, Bytes(10, 0))), 2U);              // FoE
    EXPECT_EQ(detail(request(2, 3, {0x00, 0x20, 0x40})), 6U);        // too short
    EXPECT_EQ(detail(request(3, 3, {0x00, 0x80, 1, 0, 0, 0})), 4U);  // SDO information
    Bytes tooLong = request(4, 3, Bytes(10, 0));
    tooLong[0] = 200;
    EXPECT_EQ(detail(tooLong), 8U);
}

TEST_F(TwinCoe, PutsTheLastAnswerBackWhenAskedToRepeat) {
    const Bytes answer =
        master.mailbox(0, request(1, 3, {0x00, 0x20, 0x40, 0x65, 0x60, 0, 0, 0, 0, 0}));
    EXPECT_EQ(master.read(0, 0x1080, 128).wkc, 0);
    master.write(0, 0x080E, {0x03});
    EXPECT_EQ(master.read(0, 0x080F, 1).data[0] & 0x02, 0x02);
    EXPECT_EQ(master.read(0, 0x1080, 128).data, answer);
}

TEST_F(TwinCoe, WritesAndReadsInSegments) {
    // A normal upload whose answer does not fit is not possible with 128 bytes here; download a
    // number by segments of the smallest size.
    const Bytes start =
        master.mailbox(0, request(1, 3, {0x00, 0x20, 0x21, 0x65, 0x60, 0, 4, 0, 0, 0}));
    ASSERT_EQ(start[8], 0x60);
    const Bytes wrong = master.mailbox(0, request(2, 3, {0x00, 0x20, 0x17, 1, 2, 3, 4, 0, 0, 0}));
    EXPECT_EQ(number(std::span{wrong}.subspan(12, 4)), 0x05030000U);  // toggle
    master.mailbox(0, request(3, 3, {0x00, 0x20, 0x21, 0x65, 0x60, 0, 4, 0, 0, 0}));
    const Bytes last = master.mailbox(0, request(4, 3, {0x00, 0x20, 0x07, 1, 2, 3, 4, 0, 0, 0}));
    EXPECT_EQ(last[8], 0x20);
    EXPECT_EQ(number(master.upload(0, 0x6065, 0).data), 0x04030201U);
}

// PDO configuration

TEST_F(TwinCoe, LocksMappingEntriesWhileTheCountIsNotZero) {
    EXPECT_EQ(map(0x1600, 1, 0x60400010), Locked);
    EXPECT_EQ(map(0x1600, 0, 0), 0U);
    EXPECT_EQ(map(0x1600, 1, 0x60400010), 0U);
    EXPECT_EQ(map(0x1600, 0, 1), 0U);
    EXPECT_EQ(number(master.upload(0, 0x1600, 0).data), 1U);
}

TEST_F(TwinCoe, MapsOnlyWhatIsMappableInThatDirection) {
    map(0x1600, 0, 0);
    EXPECT_EQ(map(0x1600, 1, 0x60410010), NotMappable);  // an input
    EXPECT_EQ(map(0x1600, 1, 0x60400020), NotMappable);  // wrong length
    EXPECT_EQ(map(0x1600, 1, 0x50000010), NoObject);
    EXPECT_EQ(map(0x1600, 1, 0x60650020), NotMappable);
}

TEST_F(TwinCoe, MapsAtMostEightEntries) {
    map(0x1600, 0, 0);
    EXPECT_EQ(map(0x1600, 9, 0x60400010), NoSubindex);
    EXPECT_EQ(map(0x1600, 0, 9), TooLong);
}

TEST_F(TwinCoeRa, MapsAtMostThirtyTwoBytes) {
    map(0x1A00, 0, 0);
    for (std::uint8_t i = 1; i <= 9; ++i) EXPECT_EQ(map(0x1A00, i, 0x60640020), 0U);
    EXPECT_EQ(map(0x1A00, 0, 9), TooLong);
    EXPECT_EQ(map(0x1A00, 0, 8), 0U);
}

TEST_F(TwinCoe, AssignsOnlyPdosOfTheRightDirection) {
    EXPECT_EQ(master.download(0, 0x1C12, 1, le16(0x1600)), Locked);
    EXPECT_EQ(master.download(0, 0x1C12, 0, {0}), 0U);
    EXPECT_EQ(master.download(0, 0x1C12, 1, le16(0x1A00)), OutOfRange);
    EXPECT_EQ(master.download(0, 0x1C12, 1, le16(0x1601)), OutOfRange);
    EXPECT_EQ(master.download(0, 0x1C12, 1, le16(0x1600)), 0U);
    EXPECT_EQ(master.download(0, 0x1C12, 0, {1}), 0U);
}

TEST_F(TwinCoe, ChangesPdosOnlyInPreOp) {
    master.setProcessData(0);
    master.requestState(0, 4);
    EXPECT_EQ(map(0x1600, 0, 0), DeviceState);
    EXPECT_EQ(master.download(0, 0x1C12, 0, {0}), DeviceState);
}

TEST_F(TwinCoe, ExchangesWhatWasMapped) {
    map(0x1600, 0, 0);
    map(0x1600, 1, 0x60400010);
    map(0x1600, 2, 0x00000008);  // a gap
    map(0x1600, 3, 0x607A0020);
    EXPECT_EQ(map(0x1600, 0, 3), 0U);
    master.setProcessData(0);
    EXPECT_EQ(master.requestState(0, 4).first, 4);
    master.write(0, 0x0120, le16(8));
    master.command(0, 0x0006, 0x55, -123456);  // 55h falls into the gap
    master.cycles(20);
    EXPECT_EQ(signed32(number(master.upload(0, 0x607A, 0).data)), -123456);
    EXPECT_EQ(number(master.upload(0, 0x6060, 0).data), 1U);
    EXPECT_EQ(number(master.upload(0, 0x6040, 0).data), 6U);
}

TEST_F(TwinCoeRa, RefusesHomingMethodsItDoesNotHaveWithOneCode) {
    EXPECT_EQ(master.download(0, 0x6098, 0, {7}), OutOfRange);
    EXPECT_EQ(master.download(0, 0x6098, 0, {0}), OutOfRange);
    EXPECT_EQ(master.download(0, 0x6098, 0, {35}), 0U);
    EXPECT_EQ(master.upload(0, 0x605A, 0).abort, NoObject);
}

}  // namespace
}  // namespace takt::twin::test
