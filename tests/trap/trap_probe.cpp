// Does one thing inside, outside or in a pause of the cycle: trap_probe WHAT inside|outside|paused
#include <dlfcn.h>
#include <fcntl.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <shared_mutex>
#include <stdexcept>
#include <string>
#include <takt/core/cycle_guard.hpp>
#include <thread>
#include <vector>

namespace {

// Made before the cycle, so that only the deed itself is inside.
std::mutex mutex;
std::shared_mutex sharedMutex;
std::condition_variable condition;
sem_t semaphore;
std::unique_ptr<int> owned;
std::vector<int> full(4);
void* block = nullptr;
volatile std::size_t eight = 8;  // keeps the compiler from removing an allocation
std::atomic<int> gate{0};

struct Slow {
    Slow() : value{static_cast<int>(eight)} {}
    int value;
};

int firstUse() {
    static const Slow slow;
    return slow.value;
}

const std::map<std::string, std::function<void()>>& deeds() {
    static const std::map<std::string, std::function<void()>> all{
        {"nothing", [] {}},
        {"malloc", [] { block = std::malloc(eight); }},
        {"calloc", [] { block = std::calloc(1, eight); }},
        {"realloc", [] { block = std::realloc(block, eight); }},
        {"free", [] { owned.reset(); }},
        {"new", [] { owned = std::make_unique<int>(1); }},
        {"vector", [] { full.push_back(1); }},
        {"aligned", [] { block = std::aligned_alloc(64, 64); }},
        {"memalign", [] { (void)!posix_memalign(&block, 64, 64); }},
        {"mutex", [] { const std::lock_guard lock{mutex}; }},
        {"rdlock", [] { const std::shared_lock lock{sharedMutex}; }},
        {"wrlock", [] { const std::unique_lock lock{sharedMutex}; }},
        {"semaphore", [] { ::sem_wait(&semaphore); }},
        {"atomicwait",
         [] {
             std::thread waker{[] {
                 gate = 1;
                 gate.notify_all();
             }};
             gate.wait(0);
             waker.join();
         }},
        {"thread", [] { std::thread{[] {}}.join(); }},
        {"sleep", [] { std::this_thread::sleep_for(std::chrono::nanoseconds{1}); }},
        {"usleep", [] { ::usleep(1); }},
        {"open", [] { ::close(::open("/dev/null", O_RDONLY)); }},
        {"write", [] { (void)!::write(STDOUT_FILENO, "x", 1); }},
        {"read", [] { (void)!::read(STDIN_FILENO, full.data(), 0); }},
        {"fopen", [] { std::fclose(std::fopen("/dev/null", "r")); }},
        {"printf", [] { std::printf("%zu\n", eight); }},
        {"fprintf", [] { std::fprintf(stderr, "%zu\n", eight); }},
        {"puts", [] { std::puts("x"); }},
        {"cout", [] { std::cout << eight << std::flush; }},
        {"dlopen", [] { ::dlopen(nullptr, RTLD_NOW); }},
        {"mmap",
         [] {
             ::munmap(::mmap(nullptr, 4096, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0), 4096);
         }},
        {"static", [] { eight = static_cast<std::size_t>(firstUse()); }},
        {"throw",
         [] {
             try {
                 throw 1;
             } catch (int) {
             }
         }},
    };
    return all;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    const std::string where = argv[2];
    const auto deed = deeds().find(argv[1]);
    if (deed == deeds().end()) return 2;
    ::sem_init(&semaphore, 0, 1);
    owned = std::make_unique<int>(7);
    full.shrink_to_fit();
    std::cout << "ready" << std::endl;
    const std::function<void()>& act = deed->second;
    if (where == "inside") {
        const takt::core::CycleGuard guard;
        act();
    } else if (where == "paused") {
        const takt::core::CycleGuard guard;
        const takt::core::CycleGuardPause pause;
        act();
    } else if (where == "program") {
        const takt::core::CycleGuard guard;
        {
            const takt::core::ProgramCallGuard call;
            act();
        }
    } else if (where == "afterprogram") {
        const takt::core::CycleGuard guard;
        {
            const takt::core::ProgramCallGuard call;
            deeds().at("throw")();
        }
        act();
    } else if (where == "outside") {
        { const takt::core::CycleGuard guard; }
        act();
    } else if (where == "otherthread") {
        std::atomic<bool> go{false};
        std::thread other{[&] {
            while (!go) std::this_thread::yield();
            act();
            go = false;
        }};
        {
            const takt::core::CycleGuard guard;
            go = true;
            while (go) {
            }
        }
        other.join();
    } else {
        return 2;
    }
    return 0;
}
