#include <cassert>
#include <stdexcept>
#include <takt/record/trace.hpp>
#include <utility>

namespace takt::record {

void TraceRow::put(TraceCell cell, [[maybe_unused]] ColumnKind kind) noexcept {
    if (cells_ == nullptr) return;
    assert(next_ < recorder_->columns_.size() && recorder_->columns_[next_].kind == kind);
    if (next_ < recorder_->columns_.size()) cells_[next_++] = cell;
}

void TraceRow::commit() noexcept {
    if (cells_ == nullptr) return;
    assert(next_ == recorder_->columns_.size());
    cells_ = nullptr;
    recorder_->publish();
}

TraceRecorder::TraceRecorder(std::vector<TraceColumn> columns, std::size_t rows)
    : columns_{std::move(columns)}, capacity_{rows}, cells_(columns_.size() * rows) {
    if (rows == 0 || columns_.empty()) {
        throw std::invalid_argument{"a trace needs at least one column and room for one row"};
    }
}

TraceCell* TraceRecorder::at(std::uint64_t row) noexcept {
    return cells_.data() + static_cast<std::size_t>(row % capacity_) * columns_.size();
}

TraceRow TraceRecorder::row() noexcept {
    const std::uint64_t written = written_.load(std::memory_order_relaxed);
    if (written - drained_.load(std::memory_order_acquire) >= capacity_) {
        dropped_.fetch_add(1, std::memory_order_relaxed);
        return TraceRow{*this, nullptr};
    }
    return TraceRow{*this, at(written)};
}

void TraceRecorder::publish() noexcept {
    written_.store(written_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
}

std::size_t TraceRecorder::drain(std::span<TraceSink* const> sinks) {
    const std::uint64_t end = written_.load(std::memory_order_acquire);
    const std::uint64_t begin = drained_.load(std::memory_order_relaxed);
    for (std::uint64_t row = begin; row != end; ++row) {
        const std::span<const TraceCell> cells{at(row), columns_.size()};
        for (TraceSink* sink : sinks) sink->take(cells);
        drained_.store(row + 1, std::memory_order_release);
    }
    return static_cast<std::size_t>(end - begin);
}

}  // namespace takt::record
