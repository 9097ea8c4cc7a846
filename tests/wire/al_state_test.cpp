#include <gmock/gmock.h>

#include <string>
#include <takt/wire/al_state.hpp>
#include <takt/wire/mailbox.hpp>

namespace {

using namespace takt::wire;
using testing::HasSubstr;

TEST(AlWords, NameEveryState) {
    EXPECT_STREQ(name(AlState::Init), "INIT");
    EXPECT_STREQ(name(AlState::PreOp), "PREOP");
    EXPECT_STREQ(name(AlState::Boot), "BOOT");
    EXPECT_STREQ(name(AlState::SafeOp), "SAFEOP");
    EXPECT_STREQ(name(AlState::Op), "OP");
}

struct CodeWord {
    std::uint32_t code;
    const char* part;
};

TEST(AlWords, ExplainStatusCodes) {
    for (const CodeWord& row :
         {CodeWord{0x0000, "no error"}, CodeWord{0x0011, "invalid requested state"},
          CodeWord{0x0016, "mailbox"}, CodeWord{0x0017, "SyncManager"}, CodeWord{0x0019, "outputs"},
          CodeWord{0x001A, "synchronization"}, CodeWord{0x001B, "watchdog"},
          CodeWord{0x001D, "output"}, CodeWord{0x001E, "input"}, CodeWord{0x002C, "SYNC0"},
          CodeWord{0x0030, "DC SYNC"}, CodeWord{0x0032, "PLL"}, CodeWord{0x0036, "SYNC0 cycle"}}) {
        EXPECT_THAT(explainAlStatus(static_cast<std::uint16_t>(row.code)), HasSubstr(row.part))
            << std::hex << row.code;
    }
}

TEST(AlWords, ExplainUnknownCodesToo) {
    EXPECT_THAT(explainAlStatus(0x8123), HasSubstr("vendor"));
    EXPECT_THAT(explainAlStatus(0x00AB), HasSubstr("not in the standard"));
}

TEST(AbortWords, ExplainAbortCodes) {
    for (const CodeWord& row :
         {CodeWord{abortcode::Timeout, "timed out"}, CodeWord{abortcode::ReadOnly, "read-only"},
          CodeWord{abortcode::WriteOnly, "write-only"},
          CodeWord{abortcode::NoObject, "does not exist"},
          CodeWord{abortcode::NotMappable, "cannot be mapped"},
          CodeWord{abortcode::LengthMismatch, "length"},
          CodeWord{abortcode::NoSubindex, "sub-index"}, CodeWord{abortcode::OutOfRange, "range"},
          CodeWord{abortcode::WrongDeviceState, "state"}}) {
        EXPECT_THAT(explainAbort(row.code), HasSubstr(row.part)) << std::hex << row.code;
    }
    EXPECT_THAT(explainAbort(0x12345678), HasSubstr("not in the standard"));
}

}  // namespace
