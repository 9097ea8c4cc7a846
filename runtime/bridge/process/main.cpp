// takt-bridge: carries the status of a running machine to DDS and commands back. Started by the
// daemon with the two memories as descriptors; it has no rights and touches no file.
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <exception>
#include <takt/bridge/command_memory.hpp>
#include <takt/bridge/status_memory.hpp>

#include "dds_node.hpp"
#include "privileges.hpp"
#include "publisher.hpp"

namespace takt::bridge {

namespace {

volatile std::sig_atomic_t ending = 0;

void onSignal(int) {
    ending = 1;
}

void rest(std::chrono::nanoseconds time) {
    const timespec duration{0, static_cast<long>(time.count())};
    nanosleep(&duration, nullptr);  // a signal ends it
}

void serve() {
    StatusReader status{StatusDescriptor};
    CommandSender commands{CommandDescriptor};
    DdsNode node{status.header(), status.axisNames(), status.groupNames()};
    Publisher publisher{status, commands, node};
    while (ending == 0) {
        publisher.step();
        rest(publisher.rest());
    }
    // The last samples and events of a machine that has ended are told still.
    constexpr int mostSteps = 64;
    for (int i = 0; i < mostSteps && publisher.step(); ++i) {
    }
}

int run(int argc, char** argv) {
    pid_t parent = 0;
    if (argc == 2) std::from_chars(argv[1], argv[1] + std::strlen(argv[1]), parent);
    if (parent <= 0) {
        std::fputs("takt-bridge is started by takt, for a machine file with <Bridge>\n", stderr);
        return 2;
    }
    try {
        becomeUnprivileged(parent);
        struct sigaction action {};
        action.sa_handler = onSignal;
        sigaction(SIGTERM, &action, nullptr);
        serve();
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "takt-bridge: %s\n", error.what());
        return 2;
    }
}

}  // namespace

}  // namespace takt::bridge

int main(int argc, char** argv) {
    return takt::bridge::run(argc, argv);
}
