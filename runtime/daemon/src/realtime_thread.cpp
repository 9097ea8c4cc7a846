#include "realtime_thread.hpp"

#include <fmt/format.h>
#include <sched.h>
#include <sys/capability.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <utility>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace takt::daemon {

namespace {

constexpr std::size_t StackBytes = std::size_t{1} << 20;

/// Denormal numbers cost a hundred times as much as others, at a moment nobody chooses.
void flushDenormals() noexcept {
#if defined(__SSE2__)
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _mm_setcsr(_mm_getcsr() | 0x0040U);  // denormals are zero
#elif defined(__aarch64__)
    std::uint64_t control = 0;
    asm volatile("mrs %0, fpcr" : "=r"(control));
    asm volatile("msr fpcr, %0" : : "r"(control | (std::uint64_t{1} << 24)));
#endif
}

struct Start {
    std::string name;
    std::function<void()> body;
};

void* runThread(void* argument) {
    const std::unique_ptr<Start> start{static_cast<Start*>(argument)};
    pthread_setname_np(pthread_self(), start->name.substr(0, 15).c_str());
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, nullptr);  // signals are for the thread that keeps house
    dropCapabilities();
    flushDenormals();
    start->body();
    return nullptr;
}

/// Attributes of a new thread; they end with the object.
class Attributes {
public:
    Attributes(int priority, int cpu) {
        pthread_attr_init(&attributes_);
        pthread_attr_setstacksize(&attributes_, StackBytes);
        if (priority > 0) {
            sched_param parameter{};
            parameter.sched_priority = priority;
            pthread_attr_setinheritsched(&attributes_, PTHREAD_EXPLICIT_SCHED);
            pthread_attr_setschedpolicy(&attributes_, SCHED_FIFO);
            pthread_attr_setschedparam(&attributes_, &parameter);
        }
        if (cpu >= 0 && cpu < CPU_SETSIZE) {
            cpu_set_t set;
            CPU_ZERO(&set);
            CPU_SET(static_cast<unsigned>(cpu), &set);
            pthread_attr_setaffinity_np(&attributes_, sizeof set, &set);
        }
    }
    ~Attributes() { pthread_attr_destroy(&attributes_); }
    Attributes(const Attributes&) = delete;
    Attributes& operator=(const Attributes&) = delete;

    [[nodiscard]] const pthread_attr_t* get() const noexcept { return &attributes_; }

private:
    pthread_attr_t attributes_{};
};

}  // namespace

void Notes::add(const std::string& text) {
    if (std::find(lines_.begin(), lines_.end(), text) == lines_.end()) lines_.push_back(text);
}

RealtimeThread::RealtimeThread(const ThreadPlace& place, std::function<void()> body, Notes& notes) {
    auto start = std::make_unique<Start>(Start{place.name, std::move(body)});
    int error = pthread_create(&thread_, Attributes{place.priority, place.cpu}.get(), &runThread,
                               start.get());
    if (error == EINVAL && place.cpu >= 0) {
        notes.add(
            fmt::format("note: there is no processor {} for the cycle; it runs on any", place.cpu));
        error =
            pthread_create(&thread_, Attributes{place.priority, -1}.get(), &runThread, start.get());
    }
    if (error == EPERM && place.priority > 0) {
        notes.add(
            "note: no real-time priority (SCHED_FIFO is refused), cycles may come late; do: give "
            "takt "
            "CAP_SYS_NICE or an RLIMIT_RTPRIO");
        error = pthread_create(&thread_, Attributes{0, -1}.get(), &runThread, start.get());
    }
    if (error != 0) {
        throw std::runtime_error(fmt::format("thread '{}': {}", place.name, std::strerror(error)));
    }
    running_ = true;
    static_cast<void>(start.release());  // now the thread's own
}

RealtimeThread::~RealtimeThread() {
    join();
}

void RealtimeThread::join() {
    if (running_) pthread_join(thread_, nullptr);
    running_ = false;
}

void RealtimeThread::letGo() noexcept {
    if (running_) pthread_detach(thread_);
    running_ = false;
}

void lockMemory(Notes& notes) {
    // Memory that comes later is locked too only where that can never make an allocation fail: the
    // right to lock is given up, so a limit would then count.
    rlimit limit{};
    getrlimit(RLIMIT_MEMLOCK, &limit);
    const int future = limit.rlim_cur == RLIM_INFINITY ? MCL_FUTURE : 0;
    if (mlockall(MCL_CURRENT | future) == 0) return;
    notes.add(fmt::format(
        "note: memory is not locked ({}), a page that is swapped out makes a cycle late; do: give "
        "takt CAP_IPC_LOCK or an unlimited RLIMIT_MEMLOCK",
        std::strerror(errno)));
}

void dropCapabilities() noexcept {
    constexpr std::array<cap_value_t, 3> used{CAP_NET_RAW, CAP_SYS_NICE, CAP_IPC_LOCK};
    const cap_t own = cap_get_proc();
    if (own == nullptr) return;
    const auto count = static_cast<int>(used.size());
    for (const cap_flag_t set : {CAP_EFFECTIVE, CAP_PERMITTED, CAP_INHERITABLE}) {
        cap_set_flag(own, set, count, used.data(), CAP_CLEAR);
    }
    cap_set_proc(own);  // only ever takes away: cannot be refused
    cap_free(own);
}

}  // namespace takt::daemon
