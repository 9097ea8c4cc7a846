#include <algorithm>
#include <takt/axis/command_book.hpp>

namespace takt::axis {

namespace {

constexpr unsigned kPortShift = 48;

bool isPending(CommandPhase phase) noexcept {
    return phase == CommandPhase::Queued || phase == CommandPhase::Active;
}

}  // namespace

CommandBook::CommandBook(std::uint16_t port) noexcept
    : lastId_{static_cast<std::uint64_t>(port) << kPortShift} {}

CommandId CommandBook::add(CommandPhase phase, bool takesMotion) noexcept {
    const CommandId id = nextId();
    entryOf(id) = {id, {phase, ErrorId::None}, takesMotion};
    return id;
}

CommandId CommandBook::nextId() noexcept {
    // A command that is still pending keeps its place, so that its end is never missed.
    for (std::size_t tried = 0; tried < Remembered; ++tried) {
        const auto id = static_cast<CommandId>(++lastId_);
        if (!isPending(entryOf(id).status.phase)) return id;
    }
    return static_cast<CommandId>(++lastId_);
}

CommandStatus CommandBook::status(CommandId id) const noexcept {
    const Entry& entry = entryOf(id);
    if (id == CommandId::None || entry.id != id) return {};
    return entry.status;
}

bool CommandBook::pending(CommandId id) const noexcept {
    return isPending(status(id).phase);
}

void CommandBook::abortPending() noexcept {
    for (Entry& entry : entries_) {
        if (entry.takesMotion && isPending(entry.status.phase)) {
            entry.status = {CommandPhase::Aborted, ErrorId::None};
        }
    }
}

void CommandBook::note(const CommandEvent& event) noexcept {
    Entry& entry = entryOf(event.id);
    if (entry.id == event.id) entry.status = event.status;
}

void CommandBook::forgetAllBut(std::span<const CommandId> alive) noexcept {
    for (Entry& entry : entries_) {
        if (!isPending(entry.status.phase)) continue;
        if (std::find(alive.begin(), alive.end(), entry.id) == alive.end()) entry.id = {};
    }
}

void CommandEvents::report(CommandId id, CommandStatus status) noexcept {
    if (id == CommandId::None) return;
    events_[count_ % events_.size()] = {id, status};
    ++count_;
}

void CommandEvents::deliver(CommandBook& book) const noexcept {
    std::uint64_t from = book.eventsSeen_;
    if (missedBy(book)) from = count_ - events_.size();
    for (; from != count_; ++from) book.note(events_[from % events_.size()]);
    book.eventsSeen_ = count_;
}

}  // namespace takt::axis
