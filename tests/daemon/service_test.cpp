#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "machine_files.hpp"
#include "takt_process.hpp"

namespace takt::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

/// Listens like the manager of a service (sd_notify(3)).
class ServiceManager {
public:
    explicit ServiceManager(std::string path)
        : path_{std::move(path)}, socket_{::socket(AF_UNIX, SOCK_DGRAM, 0)} {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        path_.copy(address.sun_path, sizeof address.sun_path - 1);
        ::unlink(path_.c_str());
        EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    }
    ~ServiceManager() { ::close(socket_); }
    ServiceManager(const ServiceManager&) = delete;
    ServiceManager& operator=(const ServiceManager&) = delete;

    std::vector<std::string> heard() {
        std::vector<std::string> all;
        std::array<char, 4096> text{};
        for (ssize_t size = 0;
             (size = ::recv(socket_, text.data(), text.size(), MSG_DONTWAIT)) > 0;) {
            all.emplace_back(text.data(), static_cast<std::size_t>(size));
        }
        return all;
    }

private:
    std::string path_;
    int socket_;
};

std::vector<std::string> toldBy(const std::vector<std::string>& arguments,
                                const std::vector<std::string>& environment = {}) {
    const std::string path = "/tmp/takt-service-" + std::to_string(getpid());
    ServiceManager manager{path};
    std::vector<std::string> settings{"NOTIFY_SOCKET=" + path};
    settings.insert(settings.end(), environment.begin(), environment.end());
    const auto result = runTakt(arguments, TAKT_BINARY_DIR, settings);
    EXPECT_EQ(result.exitCode, 0) << result.output;
    ::unlink(path.c_str());
    return manager.heard();
}

TEST(Service, HearsWhenTheMachineOperatesAndWhenItIsTakenDown) {
    EXPECT_THAT(toldBy({"run", Gantry, "--fast", "--manual", "--for", "100ms"}),
                ElementsAre("READY=1\nSTATUS=gantry in operation", "STOPPING=1"));
}

TEST(Service, GetsSignsOfLifeWhereItAsksForThem) {
    const auto heard =
        toldBy({"run", Gantry, "--fast", "--manual", "--for", "100ms"}, {"WATCHDOG_USEC=2"});
    EXPECT_THAT(heard, Contains("WATCHDOG=1"));
}

TEST(Service, OfAnotherProcessGetsNoSignsOfLife) {
    const auto heard = toldBy({"run", Gantry, "--fast", "--manual", "--for", "100ms"},
                              {"WATCHDOG_USEC=2", "WATCHDOG_PID=1"});
    EXPECT_THAT(heard, testing::Not(Contains("WATCHDOG=1")));
}

TEST(Service, WithoutAnInterfaceDoesNotRunTheSimulatedMachineInstead) {
    const auto result = runTakt({"run", Gantry, "--interface", "", "--quiet"}, TAKT_BINARY_DIR);
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_THAT(result.output, HasSubstr("--interface: no interface is named"));
}

}  // namespace
}  // namespace takt::test
