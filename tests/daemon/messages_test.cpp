#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <string>
#include <takt/daemon/control_messages.hpp>
#include <takt/daemon/control_socket.hpp>

#include "takt_process.hpp"

namespace takt::daemon {
namespace {

TEST(ControlMessages, ARequestComesBackAsItWas) {
    ControlRequest request{
        .id = 7, .verb = "inch", .axis = "X", .program = {}, .distance = -0.1, .velocity = 5};
    std::string error;
    const auto read = parseRequest(encode(request), error);
    ASSERT_TRUE(read) << error;
    EXPECT_EQ(read->id, 7U);
    EXPECT_EQ(read->verb, "inch");
    EXPECT_EQ(read->axis, "X");
    EXPECT_EQ(read->distance, -0.1);
    EXPECT_EQ(read->velocity, 5.0);
}

TEST(ControlMessages, ReadsWhatAPersonWouldType) {
    std::string error;
    const auto read = parseRequest(R"({"do":"power-on","axis":"X"})", error);
    ASSERT_TRUE(read) << error;
    EXPECT_EQ(read->verb, "power-on");
}

TEST(ControlMessages, RefusesWhatIsNoRequestInWords) {
    for (const char* bad :
         {"", "stop", "[]", "{}", "{\"do\":7}", "{\"do\":\"inch\",\"distance\":\"far\"}",
          "{\"do\":\"inch\",\"distance\":1e999}", "{\"do\":\"inch\",\"id\":-1}", "{\"do\":"}) {
        std::string error;
        EXPECT_FALSE(parseRequest(bad, error)) << bad;
        EXPECT_FALSE(error.empty()) << bad;
    }
}

TEST(ControlMessages, AStatusWithANumberThatJsonDoesNotKnowIsStillALine) {
    StatusReport status;
    status.axes.push_back({.name = "X", .unit = "mm", .state = "Disabled", .set = std::nan("")});
    ControlReply reply{.id = 1};
    reply.status = status;
    const std::string line = encode(reply);
    EXPECT_NE(line.find("\"set\":null"), std::string::npos);
    EXPECT_EQ(line.find('\n'), line.size() - 1);
}

TEST(ControlSocket, LetsOwnerAndGroupConnectOnly) {
    const std::string path = test::freshFolder("socket_mode") + "/m.sock";
    const ControlSocket socket{path, "m"};
    struct stat info {};
    ASSERT_EQ(::stat(path.c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 0777U, 0660U);
}

TEST(ControlSocket, BelongsToOneProcessAtATime) {
    const std::string path = test::freshFolder("socket_twice") + "/m.sock";
    const ControlSocket first{path, "m"};
    EXPECT_THROW((ControlSocket{path, "m"}), std::runtime_error);
}

TEST(ControlSocket, TakesOverWhatADeadProcessLeft) {
    const std::string path = test::freshFolder("socket_stale") + "/m.sock";
    const pid_t child = ::fork();
    if (child == 0) {
        new ControlSocket{path, "m"};  // never destroyed: as after kill -9
        ::_exit(0);
    }
    ASSERT_GT(child, 0);
    siginfo_t ended{};
    ASSERT_EQ(::waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED), 0);
    const ControlSocket again{path, "m"};
    EXPECT_EQ(again.path(), path);
}

TEST(ControlSocket, KnowsThatItsOwnUserIsAllowed) {
    std::array<int, 2> ends{};
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
    const Peer peer = peerOf(ends[0]);
    EXPECT_TRUE(peer.allowed);
    EXPECT_EQ(peer.pid, ::getpid());
    ::close(ends[0]);
    ::close(ends[1]);
}

}  // namespace
}  // namespace takt::daemon
