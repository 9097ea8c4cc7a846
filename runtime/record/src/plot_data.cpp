#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <takt/record/plot_data.hpp>

namespace takt::record {

namespace {

constexpr double SecondsPerNanosecond = 1e-9;
constexpr std::size_t MaxRuns = 8192;

PlotBin merged(const PlotBin& a, const PlotBin& b) {
    if (!b.valid) return a;
    if (!a.valid) return b;
    PlotBin bin = a;
    if (b.low < a.low) {
        bin.low = b.low;
        bin.lowTime = b.lowTime;
    }
    if (b.high > a.high) {
        bin.high = b.high;
        bin.highTime = b.highTime;
    }
    return bin;
}

}  // namespace

PlotData::PlotData(const std::vector<TraceColumn>& columns, std::string_view timeColumn,
                   std::span<const std::string> wanted, std::size_t bins)
    : maxBins_{bins} {
    if (bins < 2) throw std::invalid_argument{"a plot needs at least two bins"};
    bool timeFound = false;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        if (columns[i].name == timeColumn && columns[i].kind == ColumnKind::Integer) {
            timeIndex_ = i;
            timeFound = true;
        }
        if (std::find(wanted.begin(), wanted.end(), columns[i].name) == wanted.end()) continue;
        Kept& kept = kept_.emplace_back();
        kept.index = i;
        kept.column = columns[i];
        if (kept.column.kind != ColumnKind::Text) kept.bins.reserve(bins);
    }
    if (!timeFound) {
        throw std::invalid_argument{"the trace has no integer column " + std::string{timeColumn}};
    }
}

void PlotData::take(std::span<const TraceCell> row) {
    const double time = static_cast<double>(row[timeIndex_].integer) * SecondsPerNanosecond;
    if (rows_ == 0) begin_ = time;
    if (rowsInBin_ == rowsPerBin_ && binCount_ == maxBins_) halve();
    const bool newBin = rows_ == 0 || rowsInBin_ >= rowsPerBin_;
    for (Kept& kept : kept_) {
        const TraceCell cell = row[kept.index];
        switch (kept.column.kind) {
            case ColumnKind::Real:
                takeNumber(kept, time, cell.real, newBin);
                break;
            case ColumnKind::Integer:
                takeNumber(kept, time, static_cast<double>(cell.integer), newBin);
                break;
            case ColumnKind::Text:
                takeText(kept, time, static_cast<std::uint32_t>(cell.integer));
                break;
        }
    }
    if (newBin) {
        ++binCount_;
        rowsInBin_ = 0;
    }
    ++rowsInBin_;
    ++rows_;
    end_ = time;
}

void PlotData::takeNumber(Kept& kept, double time, double value, bool newBin) const {
    const PlotBin one{value, value, time, time, std::isfinite(value)};
    if (newBin) {
        kept.bins.push_back(one);
    } else {
        kept.bins.back() = merged(kept.bins.back(), one);
    }
}

void PlotData::takeText(Kept& kept, double time, std::uint32_t value) const {
    std::vector<PlotRun>& runs = kept.runs;
    if (!runs.empty() && runs.back().value == value) return;
    runs.push_back(PlotRun{time, value});
    while (runs.size() > MaxRuns) {
        // A flickering state must not fill the memory: runs too short to be seen join the one
        // before.
        kept.shortest = std::max(
            {2.0 * kept.shortest, (time - begin_) / (4.0 * MaxRuns), SecondsPerNanosecond});
        std::vector<PlotRun> longOnes{runs.front()};
        for (std::size_t i = 1; i < runs.size(); ++i) {
            const bool last = i + 1 == runs.size();
            const bool tooShort = !last && runs[i + 1].begin - runs[i].begin < kept.shortest;
            if (!tooShort && runs[i].value != longOnes.back().value) longOnes.push_back(runs[i]);
        }
        runs = std::move(longOnes);
    }
}

void PlotData::halve() {
    for (Kept& kept : kept_) {
        std::vector<PlotBin>& bins = kept.bins;
        if (bins.empty()) continue;
        const std::size_t pairs = bins.size() / 2;
        for (std::size_t i = 0; i < pairs; ++i) bins[i] = merged(bins[2 * i], bins[2 * i + 1]);
        if (bins.size() % 2 != 0) bins[pairs] = bins.back();
        bins.resize(pairs + bins.size() % 2);
    }
    // An odd last bin is only half as long and goes on filling.
    rowsInBin_ = binCount_ % 2 != 0 ? rowsPerBin_ : 2 * rowsPerBin_;
    binCount_ = binCount_ / 2 + binCount_ % 2;
    rowsPerBin_ *= 2;
}

const PlotData::Kept* PlotData::find(std::string_view column) const {
    const auto kept = std::find_if(kept_.begin(), kept_.end(),
                                   [&](const Kept& k) { return k.column.name == column; });
    return kept == kept_.end() ? nullptr : &*kept;
}

std::span<const PlotBin> PlotData::curve(std::string_view column) const {
    const Kept* kept = find(column);
    return kept == nullptr ? std::span<const PlotBin>{} : std::span<const PlotBin>{kept->bins};
}

std::span<const PlotRun> PlotData::runs(std::string_view column) const {
    const Kept* kept = find(column);
    return kept == nullptr ? std::span<const PlotRun>{} : std::span<const PlotRun>{kept->runs};
}

std::span<const std::string> PlotData::names(std::string_view column) const {
    const Kept* kept = find(column);
    return kept == nullptr ? std::span<const std::string>{}
                           : std::span<const std::string>{kept->column.names};
}

}  // namespace takt::record
