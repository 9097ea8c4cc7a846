#include "event_queue.hpp"

#include <cassert>

namespace takt::twin {

namespace {

std::uint32_t slotOf(std::size_t device, EventKind kind) noexcept {
    return static_cast<std::uint32_t>(device * EventKinds + static_cast<std::size_t>(kind));
}

}  // namespace

EventQueue::EventQueue(std::size_t devices)
    : time_(devices * EventKinds), position_(devices * EventKinds, NotPending) {
    heap_.reserve(devices * EventKinds);
}

void EventQueue::place(std::size_t at, Slot slot) noexcept {
    heap_[at] = slot;
    position_[slot] = static_cast<Slot>(at);
}

void EventQueue::siftUp(std::size_t at) noexcept {
    const Slot slot = heap_[at];
    while (at > 0) {
        const std::size_t parent = (at - 1) / 2;
        if (!before(slot, heap_[parent])) break;
        place(at, heap_[parent]);
        at = parent;
    }
    place(at, slot);
}

void EventQueue::siftDown(std::size_t at) noexcept {
    const Slot slot = heap_[at];
    for (;;) {
        std::size_t child = 2 * at + 1;
        if (child >= heap_.size()) break;
        if (child + 1 < heap_.size() && before(heap_[child + 1], heap_[child])) ++child;
        if (!before(heap_[child], slot)) break;
        place(at, heap_[child]);
        at = child;
    }
    place(at, slot);
}

void EventQueue::schedule(std::size_t device, EventKind kind, core::TrueTime time) noexcept {
    const Slot slot = slotOf(device, kind);
    if (slot == handled_) handled_ = NotPending;
    if (position_[slot] == NotPending) {
        time_[slot] = time;
        heap_.push_back(slot);  // never allocates: reserved for every slot there is
        siftUp(heap_.size() - 1);
        return;
    }
    const bool earlier = time < time_[slot];
    time_[slot] = time;
    if (earlier) {
        siftUp(position_[slot]);
    } else {
        siftDown(position_[slot]);
    }
}

void EventQueue::removeAt(std::size_t at) noexcept {
    const Slot slot = heap_[at];
    const Slot last = heap_.back();
    heap_.pop_back();
    position_[slot] = NotPending;
    if (last == slot) return;
    const bool up = before(last, slot);
    place(at, last);
    if (up) {
        siftUp(at);
    } else {
        siftDown(at);
    }
}

void EventQueue::cancel(std::size_t device, EventKind kind) noexcept {
    const Slot at = position_[slotOf(device, kind)];
    if (at != NotPending) removeAt(at);
}

bool EventQueue::pending(std::size_t device, EventKind kind) const noexcept {
    const Slot slot = slotOf(device, kind);
    return slot != handled_ && position_[slot] != NotPending;
}

EventQueue::Event EventQueue::begin() noexcept {
    assert(!heap_.empty());
    handled_ = heap_[0];
    return {handled_ / EventKinds, static_cast<EventKind>(handled_ % EventKinds), time_[handled_]};
}

void EventQueue::done() noexcept {
    if (handled_ != NotPending && position_[handled_] != NotPending) removeAt(position_[handled_]);
    handled_ = NotPending;
}

}  // namespace takt::twin
