#include "stop_request.hpp"

#include <atomic>

namespace takt::daemon {

namespace {
// A signal handler can reach nothing but objects of static duration.
std::atomic<int> signalCount{0};
std::atomic<int> firstSignal{0};

void onSignal(int number) {
    if (signalCount.fetch_add(1, std::memory_order_relaxed) == 0) {
        firstSignal.store(number, std::memory_order_relaxed);
    }
}
}  // namespace

StopRequest::StopRequest() {
    signalCount = 0;
    firstSignal = 0;
    struct sigaction action {};
    action.sa_handler = onSignal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, &oldInt_);
    sigaction(SIGTERM, &action, &oldTerm_);
    sigaction(SIGHUP, &action, &oldHup_);
    action.sa_handler = SIG_IGN;
    sigaction(SIGPIPE, &action, &oldPipe_);
    sigaction(SIGTSTP, &action, &oldStop_);
    sigaction(SIGTTOU, &action, &oldTtou_);
}

StopRequest::~StopRequest() {
    sigaction(SIGINT, &oldInt_, nullptr);
    sigaction(SIGTERM, &oldTerm_, nullptr);
    sigaction(SIGHUP, &oldHup_, nullptr);
    sigaction(SIGPIPE, &oldPipe_, nullptr);
    sigaction(SIGTSTP, &oldStop_, nullptr);
    sigaction(SIGTTOU, &oldTtou_, nullptr);
}

int StopRequest::count() const noexcept {
    return signalCount.load(std::memory_order_relaxed);
}
int StopRequest::signal() const noexcept {
    return firstSignal.load(std::memory_order_relaxed);
}

}  // namespace takt::daemon
