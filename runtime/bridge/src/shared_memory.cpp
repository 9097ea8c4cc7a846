#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>
#include <takt/bridge/shared_memory.hpp>
#include <utility>

namespace takt::bridge {

namespace {

[[noreturn]] void fail(const char* what) {
    throw std::runtime_error{std::string{"shared memory: "} + what + ": " + std::strerror(errno)};
}

/// The size is fixed before anybody else sees the memory.
constexpr int FixedSize = F_SEAL_SHRINK | F_SEAL_GROW;

}  // namespace

SharedMemory SharedMemory::create(const char* name, std::size_t bytes, Others others) {
    const int descriptor = memfd_create(name, MFD_CLOEXEC | MFD_ALLOW_SEALING);
    if (descriptor < 0) fail("memfd_create");
    SharedMemory memory{descriptor, true};
    if (ftruncate(descriptor, static_cast<off_t>(bytes)) != 0) fail("ftruncate");
    memory.map(bytes, true);
    // The mapping above stays writable; every later one and every write() is refused.
    const int writes = others == Others::Read ? F_SEAL_FUTURE_WRITE : 0;
    if (fcntl(descriptor, F_ADD_SEALS, FixedSize | writes | F_SEAL_SEAL) != 0) fail("sealing");
    return memory;
}

SharedMemory SharedMemory::attach(int descriptor, Others access) {
    const int seals = fcntl(descriptor, F_GET_SEALS);
    if (seals < 0) fail("this is no descriptor of shared memory");
    struct stat status {};
    if (fstat(descriptor, &status) != 0) fail("fstat");
    if ((seals & FixedSize) != FixedSize) {
        throw std::runtime_error{"shared memory: its size is not fixed"};
    }
    SharedMemory memory{descriptor, false};
    memory.map(static_cast<std::size_t>(status.st_size), access == Others::Write);
    return memory;
}

void SharedMemory::map(std::size_t bytes, bool writable) {
    const int protection = writable ? PROT_READ | PROT_WRITE : PROT_READ;
    void* const at = mmap(nullptr, bytes, protection, MAP_SHARED, descriptor_, 0);
    if (at == MAP_FAILED) fail("mmap");  // NOLINT(performance-no-int-to-ptr): the kernel's macro
    data_ = static_cast<std::byte*>(at);
    size_ = bytes;
}

SharedMemory::SharedMemory(SharedMemory&& other) noexcept
    : data_{std::exchange(other.data_, nullptr)},
      size_{other.size_},
      descriptor_{std::exchange(other.descriptor_, -1)},
      owned_{other.owned_} {}

SharedMemory::~SharedMemory() {
    if (data_ != nullptr) munmap(data_, size_);
    if (owned_ && descriptor_ >= 0) close(descriptor_);
}

}  // namespace takt::bridge
