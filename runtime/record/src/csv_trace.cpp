#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <takt/record/csv_trace.hpp>

namespace takt::record {

namespace {

constexpr std::size_t FlushSize = std::size_t{1} << 16;

/// Which member of the union counts does not matter for "is it the value of the row before".
std::int64_t bitsOf(TraceCell cell, ColumnKind kind) {
    return kind == ColumnKind::Real ? std::bit_cast<std::int64_t>(cell.real) : cell.integer;
}

template <typename T>
void appendShortest(std::string& text, T value) {
    std::array<char, 32> buffer{};
    const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    text.append(buffer.data(), result.ptr);
}

}  // namespace

void appendNumber(std::string& text, double value) {
    if (std::isnan(value)) {
        text += "nan";  // the sign of a NaN differs between processors
        return;
    }
    appendShortest(text, value);
}

void appendNumber(std::string& text, std::int64_t value) {
    appendShortest(text, value);
}

CsvTrace::CsvTrace(OutputFile& file, const std::vector<TraceColumn>& columns)
    : file_{file}, columns_{columns}, cache_(columns.size()) {
    line_.reserve(FlushSize + 4096);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
        line_ += i == 0 ? "" : ",";
        line_ += columns_[i].name;
    }
    line_ += '\n';
}

void CsvTrace::take(std::span<const TraceCell> row) {
    for (std::size_t i = 0; i < row.size(); ++i) {
        if (i != 0) line_ += ',';
        appendCell(i, row[i]);
    }
    line_ += '\n';
    if (line_.size() >= FlushSize) {
        file_.write(line_);
        line_.clear();
    }
}

void CsvTrace::appendCell(std::size_t column, TraceCell cell) {
    const TraceColumn& kind = columns_[column];
    Cached& cached = cache_[column];
    const std::int64_t bits = bitsOf(cell, kind.kind);
    if (cached.text.empty() || cached.bits != bits) {
        cached.bits = bits;
        cached.text.clear();
        switch (kind.kind) {
            case ColumnKind::Real:
                appendNumber(cached.text, cell.real);
                break;
            case ColumnKind::Integer:
                appendNumber(cached.text, cell.integer);
                break;
            case ColumnKind::Text: {
                const auto index = static_cast<std::uint64_t>(cell.integer);
                if (index < kind.names.size()) {
                    cached.text = kind.names[index];
                } else {
                    appendNumber(cached.text, cell.integer);
                }
                break;
            }
        }
    }
    line_ += cached.text;
}

bool CsvTrace::finish() {
    file_.write(line_);
    line_.clear();
    return file_.flush();
}

}  // namespace takt::record
