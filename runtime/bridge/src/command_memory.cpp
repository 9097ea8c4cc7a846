#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <stdexcept>
#include <takt/bridge/command_memory.hpp>
#include <type_traits>

namespace takt::bridge {

namespace {

static_assert(std::is_trivially_copyable_v<CommandRecord>);

bool isPrintable(const Name& name) noexcept {
    const auto end = std::find(name.begin(), name.end(), '\0');
    return end != name.end() &&
           std::all_of(name.begin(), end, [](char c) { return c >= ' ' && c <= '~'; });
}

}  // namespace

bool isWellFormed(const CommandRecord& command) noexcept {
    return command.writer != 0 && static_cast<std::uint8_t>(command.order) < CommandOrders &&
           std::isfinite(command.distance) && std::isfinite(command.velocity) &&
           isPrintable(command.axis) && isPrintable(command.who);
}

CommandSender::CommandSender(int descriptor)
    : memory_{SharedMemory::attach(descriptor, SharedMemory::Others::Write)} {
    if (memory_.size() < sizeof(CommandLayout)) {
        throw std::runtime_error{"command memory: too small"};
    }
}

CommandLayout& CommandSender::memory() noexcept {
    return *std::launder(reinterpret_cast<CommandLayout*>(memory_.data()));
}

bool CommandSender::send(const CommandRecord& command) noexcept {
    CommandLayout& shared = memory();
    const std::uint64_t written = shared.written.load(std::memory_order_relaxed);
    const std::uint64_t taken = shared.taken.load(std::memory_order_acquire);
    if (written - taken >= CommandDepth) return false;
    std::array<std::uint64_t, CommandLayout::WordsOfRecord> words{};
    std::memcpy(words.data(), &command, sizeof command);
    auto& record = shared.records[written % CommandDepth];
    for (std::size_t i = 0; i < words.size(); ++i) {
        record[i].store(words[i], std::memory_order_relaxed);
    }
    shared.written.store(written + 1, std::memory_order_release);
    return true;
}

CommandReceiver::CommandReceiver()
    : memory_{SharedMemory::create("takt-commands", sizeof(CommandLayout),
                                   SharedMemory::Others::Write)} {
    new (memory_.data()) CommandLayout;
}

CommandLayout& CommandReceiver::memory() noexcept {
    return *std::launder(reinterpret_cast<CommandLayout*>(memory_.data()));
}
const CommandLayout& CommandReceiver::memory() const noexcept {
    return *std::launder(reinterpret_cast<const CommandLayout*>(memory_.data()));
}

bool CommandReceiver::next(CommandRecord& command) noexcept {
    CommandLayout& shared = memory();
    const std::uint64_t written = shared.written.load(std::memory_order_acquire);
    if (written - taken_ > CommandDepth) {
        // No bridge of ours counts like this: what lies there is passed over as a whole.
        ++malformed_;
        taken_ = written;
        shared.taken.store(taken_, std::memory_order_release);
        return false;
    }
    while (taken_ != written) {
        std::array<std::uint64_t, CommandLayout::WordsOfRecord> words{};
        const auto& record = shared.records[taken_ % CommandDepth];
        for (std::size_t i = 0; i < words.size(); ++i) {
            words[i] = record[i].load(std::memory_order_relaxed);
        }
        shared.taken.store(++taken_, std::memory_order_release);
        std::memcpy(static_cast<void*>(&command), words.data(), sizeof command);
        if (isWellFormed(command)) return true;
        ++malformed_;
    }
    return false;
}

void CommandReceiver::reset() noexcept {
    CommandLayout& shared = memory();
    taken_ = shared.written.load(std::memory_order_acquire);
    shared.taken.store(taken_, std::memory_order_release);
    shared.published.store(0, std::memory_order_relaxed);
}

}  // namespace takt::bridge
