#pragma once

#include <cstddef>
#include <cstdint>

namespace takt::bridge {

/// Memory without a name, shared with whoever inherits its descriptor. Its size never changes, so
/// that no access can fail.
class SharedMemory {
public:
    /// What the holder of the descriptor may do; the creator may always write.
    enum class Others : std::uint8_t { Read, Write };

    /// New memory, all zero. \throw std::runtime_error
    [[nodiscard]] static SharedMemory create(const char* name, std::size_t bytes, Others others);
    /// Maps what another process has created. Does not own the descriptor.
    /// \throw std::runtime_error when it is no such memory
    [[nodiscard]] static SharedMemory attach(int descriptor, Others access);

    SharedMemory(SharedMemory&& other) noexcept;
    SharedMemory& operator=(SharedMemory&&) = delete;
    ~SharedMemory();

    [[nodiscard]] std::byte* data() noexcept { return data_; }
    [[nodiscard]] const std::byte* data() const noexcept { return data_; }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    [[nodiscard]] int descriptor() const noexcept { return descriptor_; }

private:
    SharedMemory(int descriptor, bool owned) noexcept : descriptor_{descriptor}, owned_{owned} {}
    void map(std::size_t bytes, bool writable);

    std::byte* data_{nullptr};
    std::size_t size_{0};
    int descriptor_;
    bool owned_;
};

}  // namespace takt::bridge
