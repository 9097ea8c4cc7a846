#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <takt/record/trace.hpp>
#include <vector>

namespace takt::record {

/// A run of rows drawn as one pixel: what the curve did in it.
struct PlotBin {
    double low{0.0};
    double high{0.0};
    double lowTime{0.0};  ///< when the low was reached first, s
    double highTime{0.0};
    bool valid{false};  ///< any finite value in it
};

/// A stretch of time in which a Text column kept its value.
struct PlotRun {
    double begin{0.0};  ///< s
    std::uint32_t value{0};
};

/// Keeps selected columns of a trace in bounded memory while it is recorded: numbers as low and
/// high of at most `bins` stretches of equal length, states as runs. When a trace grows beyond
/// that, neighbours are merged; a peak is never lost, only its place becomes coarser.
class PlotData : public TraceSink {
public:
    /// `wanted` are column names; a name that the trace does not have is left out.
    /// \param timeColumn an Integer column in ns
    /// \param bins at least 2
    PlotData(const std::vector<TraceColumn>& columns, std::string_view timeColumn,
             std::span<const std::string> wanted, std::size_t bins = 1600);

    void take(std::span<const TraceCell> row) override;

    /// Empty when the column is not kept.
    [[nodiscard]] std::span<const PlotBin> curve(std::string_view column) const;
    [[nodiscard]] std::span<const PlotRun> runs(std::string_view column) const;
    /// The names of a Text column; empty when the column is not kept.
    [[nodiscard]] std::span<const std::string> names(std::string_view column) const;
    [[nodiscard]] double beginTime() const noexcept { return begin_; }
    [[nodiscard]] double endTime() const noexcept { return end_; }  ///< of the last row, s
    [[nodiscard]] std::uint64_t rows() const noexcept { return rows_; }

private:
    struct Kept {
        std::size_t index{0};
        TraceColumn column;
        std::vector<PlotBin> bins;
        std::vector<PlotRun> runs;
        double shortest{0.0};  ///< runs shorter than this have been merged away
    };
    [[nodiscard]] const Kept* find(std::string_view column) const;
    void takeNumber(Kept& kept, double time, double value, bool newBin) const;
    void takeText(Kept& kept, double time, std::uint32_t value) const;
    void halve();

    std::vector<Kept> kept_;
    std::size_t timeIndex_{0};
    std::size_t maxBins_;
    std::size_t binCount_{0};
    std::uint64_t rowsPerBin_{1};
    std::uint64_t rowsInBin_{0};
    std::uint64_t rows_{0};
    double begin_{0.0};
    double end_{0.0};
};

}  // namespace takt::record
