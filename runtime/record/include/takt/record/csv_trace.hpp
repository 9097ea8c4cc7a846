#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <takt/record/output_file.hpp>
#include <takt/record/trace.hpp>
#include <vector>

namespace takt::record {

/// Appends the shortest decimal text that reads back as exactly `value`; "nan", "inf" and "-inf"
/// else.
void appendNumber(std::string& text, double value);
void appendNumber(std::string& text, std::int64_t value);

/// A trace as CSV: a header line, one line per row, LF, numbers in shortest round-trip form. The
/// same rows give the same bytes on every machine.
class CsvTrace : public TraceSink {
public:
    /// Writes the header. `file` must outlive the object.
    CsvTrace(OutputFile& file, const std::vector<TraceColumn>& columns);

    void take(std::span<const TraceCell> row) override;
    /// Hands the last lines to the file. \return whether all of the trace reached it
    bool finish();

private:
    /// The text a column had last: most cells of a machine at rest do not change.
    struct Cached {
        std::int64_t bits{0};
        std::string text;
    };
    void appendCell(std::size_t column, TraceCell cell);

    OutputFile& file_;
    std::vector<TraceColumn> columns_;
    std::vector<Cached> cache_;
    std::string line_;
};

}  // namespace takt::record
