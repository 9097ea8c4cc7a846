// `takt jog` with its keys, on a terminal of its own.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <csignal>
#include <cstdlib>

#include "machine_files.hpp"
#include "running_takt.hpp"

namespace takt::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// `takt jog X` at the other end of a pseudo terminal.
class Jogger {
public:
    Jogger(const RunningTakt& machine, const std::string& distance, const std::string& velocity)
        : machine_{machine} {
        terminal_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
        EXPECT_EQ(::grantpt(terminal_), 0);
        EXPECT_EQ(::unlockpt(terminal_), 0);
        std::array<char, 64> name{};
        EXPECT_EQ(::ptsname_r(terminal_, name.data(), name.size()), 0);
        keyboard_ = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
        before_ = settings();
        child_ = ::fork();
        if (child_ == 0) {
            ::dup2(keyboard_, STDIN_FILENO);
            ::dup2(keyboard_, STDOUT_FILENO);
            ::dup2(keyboard_, STDERR_FILENO);
            const std::string takt = std::string{TAKT_BINARY_DIR} + "/takt";
            ::execl(takt.c_str(), "takt", "jog", "X", "--distance", distance.c_str(), "--velocity",
                    velocity.c_str(), "--socket", machine.socket().c_str(), nullptr);
            ::_exit(127);
        }
        awaitText("step " + distance);
    }
    ~Jogger() {
        if (child_ > 0) {
            ::kill(child_, SIGKILL);
            static_cast<void>(end());
        }
        ::close(keyboard_);
        ::close(terminal_);
    }
    Jogger(const Jogger&) = delete;
    Jogger& operator=(const Jogger&) = delete;

    void press(const std::string& keys) {
        EXPECT_EQ(::write(terminal_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
    }
    /// Reads what is shown until the text has come.
    void awaitText(const std::string& text) {
        while (shown_.find(text) == std::string::npos) {
            pollfd wait{terminal_, POLLIN, 0};
            if (::poll(&wait, 1, 60'000) <= 0) throw std::runtime_error{"not shown: " + text};
            std::array<char, 4096> buffer{};
            const ssize_t count = ::read(terminal_, buffer.data(), buffer.size());
            if (count <= 0) throw std::runtime_error{"ended without " + text + ": " + shown_};
            shown_.append(buffer.data(), static_cast<std::size_t>(count));
        }
        shown_.erase(0, shown_.find(text) + text.size());
    }
    /// The step of the key before has begun and has ended.
    void awaitStep() {
        awaitText("under way");
        awaitText("mm/s  \r");
    }
    void freeze() const { ::kill(child_, SIGSTOP); }
    /// \return its exit code
    int end() {
        int status = 0;
        ::waitpid(child_, &status, 0);
        child_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    [[nodiscard]] termios settings() const {
        termios now{};
        EXPECT_EQ(::tcgetattr(keyboard_, &now), 0);
        return now;
    }
    [[nodiscard]] bool terminalIsAsBefore() const {
        const termios now = settings();
        return now.c_lflag == before_.c_lflag && now.c_iflag == before_.c_iflag &&
               now.c_cc[VMIN] == before_.c_cc[VMIN];
    }

private:
    const RunningTakt& machine_;
    int terminal_{-1};
    int keyboard_{-1};
    pid_t child_{-1};
    termios before_{};
    std::string shown_;
};

class JogTerminal : public testing::Test {
protected:
    void SetUp() override {
        const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
        machine_ = std::make_unique<RunningTakt>(
            std::string{"jog_"} + test->name(),
            std::vector<std::string>{"run", Gantry, "--sim", "--manual"});
        watcher_ = std::make_unique<SocketClient>(machine_->socket());
        while (watcher_->status().at("phase") != "operating") {
            SocketClient::pause();
        }
        EXPECT_EQ(machine_->tell({"power", "on", "X"}).exitCode, 0);
        awaitNoOwner();
    }
    void TearDown() override {
        watcher_.reset();
        machine_->terminate();
    }
    /// A key that is pressed before the operator before has left would be refused.
    void awaitNoOwner() {
        while (watcher_->status().at("owner") != "") {
            SocketClient::pause();
        }
    }
    void awaitRestAt(double position) {
        for (;;) {
            const auto axis = watcher_->axis("X");
            const bool there = std::abs(axis.at("set").get<double>() - position) < 0.01;
            if (there && axis.at("state") == "Standstill") return;
            SocketClient::pause();
        }
    }

    std::unique_ptr<RunningTakt> machine_;
    std::unique_ptr<SocketClient> watcher_;
};

constexpr double Start = 120.0;

TEST_F(JogTerminal, MovesOneStepForEachKey) {
    Jogger jog{*machine_, "2", "100"};
    jog.press("\033[C");
    jog.awaitStep();
    awaitRestAt(Start + 2.0);
    jog.press("-");
    jog.awaitStep();
    awaitRestAt(Start);
    jog.press("q");
    EXPECT_EQ(jog.end(), 0);
}

TEST_F(JogTerminal, ChangesTheStepWithUpAndDown) {
    Jogger jog{*machine_, "2", "100"};
    jog.press("k");
    jog.awaitText("step 10 ");
    jog.press("j");
    jog.awaitText("step 2 ");
    jog.press("j");
    jog.awaitText("step 1 ");
    jog.press("q");
    EXPECT_EQ(jog.end(), 0);
}

TEST_F(JogTerminal, StopsWithTheSpaceBar) {
    Jogger jog{*machine_, "250", "5"};
    jog.press("+");
    watcher_->awaitState("X", "DiscreteMotion");
    jog.press(" ");
    const auto axis = watcher_->awaitState("X", "Standstill");
    EXPECT_LT(axis.at("set"), Start + 249.0);
    jog.press("q");
    EXPECT_EQ(jog.end(), 0);
}

TEST_F(JogTerminal, StopsTheAxisWhenItIsFrozenItself) {
    Jogger jog{*machine_, "250", "5"};
    jog.press("+");
    watcher_->awaitState("X", "DiscreteMotion");
    jog.freeze();
    const auto axis = watcher_->awaitState("X", "Standstill");
    EXPECT_LT(axis.at("set"), Start + 249.0);
    EXPECT_THAT(watcher_->events(), Contains("axis X stops: no sign of life from the operator"));
}

TEST_F(JogTerminal, StopsTheAxisAndRestoresTheTerminalAtItsEnd) {
    for (const std::string& key : {std::string{"q"}, std::string{"\003"}}) {
        Jogger jog{*machine_, "250", "5"};
        EXPECT_FALSE(jog.terminalIsAsBefore()) << "keys come at once and without echo";
        jog.press("+");
        watcher_->awaitState("X", "DiscreteMotion");
        jog.press(key);
        EXPECT_EQ(jog.end(), 0);
        EXPECT_TRUE(jog.terminalIsAsBefore());
        EXPECT_LT(watcher_->awaitState("X", "Standstill").at("set"), Start + 249.0);
        awaitNoOwner();
    }
}

TEST_F(JogTerminal, RestoresTheTerminalWhenTheMachineGoes) {
    Jogger jog{*machine_, "1", "5"};
    machine_->terminate();
    jog.awaitText("the machine has gone");
    EXPECT_EQ(jog.end(), 2);
    EXPECT_TRUE(jog.terminalIsAsBefore());
}

}  // namespace
}  // namespace takt::test
