#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace takt::record {

enum class ColumnKind : std::uint8_t { Real, Integer, Text };

/// One column of a trace. A Text column holds numbers that index `names`.
struct TraceColumn {
    std::string name;
    ColumnKind kind{ColumnKind::Real};
    std::vector<std::string> names;
};

/// One value of a row; which member counts is said by the column.
union TraceCell {
    std::int64_t integer;  ///< Integer, and the index of a Text
    double real;
};

/// Takes the rows of a trace, outside the cycle.
class TraceSink {
public:
    virtual ~TraceSink() = default;
    /// One row; the cells are in column order and are valid during the call only.
    virtual void take(std::span<const TraceCell> row) = 0;
};

/// A row being written. Fill the columns from left to right, then commit; a row that is dropped
/// without commit was never there. Without room in the ring all calls do nothing.
class TraceRow {
public:
    /// rt.
    void real(double value) noexcept { put(TraceCell{.real = value}, ColumnKind::Real); }
    /// rt.
    void integer(std::int64_t value) noexcept {
        put(TraceCell{.integer = value}, ColumnKind::Integer);
    }
    /// rt. `index` into the names of the column.
    void text(std::uint32_t index) noexcept { put(TraceCell{.integer = index}, ColumnKind::Text); }
    /// rt. Hands the row over. \pre every column has been given a value of its kind
    void commit() noexcept;

private:
    friend class TraceRecorder;
    TraceRow(class TraceRecorder& recorder, TraceCell* cells) noexcept
        : recorder_{&recorder}, cells_{cells} {}
    void put(TraceCell cell, ColumnKind kind) noexcept;

    TraceRecorder* recorder_;
    TraceCell* cells_;  ///< null: no room in the ring
    std::size_t next_{0};
};

/// Rows of fixed columns, from the cycle to a thread that has time. One producer, one consumer.
///
///     TraceRecorder trace{columns, 4096};
///     auto row = trace.row();                     // in the cycle
///     row.integer(cycle); row.real(x); row.commit();
///     trace.drain(sinks);                         // outside, often enough
class TraceRecorder {
public:
    /// Room for `rows` rows, allocated and touched here.
    TraceRecorder(std::vector<TraceColumn> columns, std::size_t rows);

    /// rt. Producer only. Starts a row; when the ring is full the row is counted as dropped.
    [[nodiscard]] TraceRow row() noexcept;
    /// Consumer only. Hands all rows written so far to every sink, oldest first. \return how many
    std::size_t drain(std::span<TraceSink* const> sinks);

    [[nodiscard]] const std::vector<TraceColumn>& columns() const noexcept { return columns_; }
    /// rt. Rows that found the ring full.
    [[nodiscard]] std::uint64_t dropped() const noexcept {
        return dropped_.load(std::memory_order_relaxed);
    }

private:
    friend class TraceRow;
    void publish() noexcept;
    [[nodiscard]] TraceCell* at(std::uint64_t row) noexcept;

    std::vector<TraceColumn> columns_;
    std::size_t capacity_;
    std::vector<TraceCell> cells_;
    alignas(64) std::atomic<std::uint64_t> written_{0};
    std::atomic<std::uint64_t> dropped_{0};
    alignas(64) std::atomic<std::uint64_t> drained_{0};
};

}  // namespace takt::record
