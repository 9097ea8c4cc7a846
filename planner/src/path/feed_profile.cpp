#include <algorithm>
#include <array>
#include <cmath>
#include <takt/planner/path_feed.hpp>

namespace takt::planner {

namespace {

/// 1/(2n(2n+1)) and 1/((2n+1)(2n+2)) from n = 1 on.
constexpr std::size_t kTerms = 9;
constexpr std::array<double, kTerms> kOdd{1.0 / 6,   1.0 / 20,  1.0 / 42,  1.0 / 72, 1.0 / 110,
                                          1.0 / 156, 1.0 / 210, 1.0 / 272, 1.0 / 342};
constexpr std::array<double, kTerms> kEven{1.0 / 12,  1.0 / 30,  1.0 / 56,  1.0 / 90, 1.0 / 132,
                                           1.0 / 182, 1.0 / 240, 1.0 / 306, 1.0 / 380};

/// s'' = half slope + bend s has the solution s = v S(t) + a K(t) with the series of sinh and cosh,
/// or of sin and cos: it depends on the sign of bend, the series do not. A cell is so short that
/// |bend| t^2 is well below 1.
struct Series {
    double s;   ///< S: sinh(w t)/w
    double s1;  ///< cosh(w t)
    double k;   ///< K: (cosh(w t) - 1)/w^2

    Series(double t, double bend) noexcept {
        const double z = bend * t * t;
        double odd = 1.0;
        double even = 1.0;
        for (std::size_t n = kTerms; n-- > 0;) {
            odd = 1.0 + z * odd * kOdd[n];
            even = 1.0 + z * even * kEven[n];
        }
        s = t * odd;
        k = 0.5 * t * t * even;
        s1 = 1.0 + bend * k;
    }
};

}  // namespace

FeedState evaluate(const FeedPiece& piece, double t) noexcept {
    const FeedState& from = piece.from;
    if (piece.constantJerk) {
        return {from.s + t * (from.s1 + t * (0.5 * from.s2 + t * from.s3 / 6.0)),
                from.s1 + t * (from.s2 + t * 0.5 * from.s3), from.s2 + t * from.s3, from.s3};
    }
    const Series series{t, piece.bend};
    const double s = from.s1 * series.s + from.s2 * series.k;
    const double s1 = from.s1 * series.s1 + from.s2 * series.s;
    return {from.s + s, s1, from.s2 + piece.bend * s, piece.bend * s1};
}

void FeedProfile::clear() noexcept {
    pieces_.clear();
    duration_ = 0.0;
    end_ = 0.0;
    cycles_ = 0;
}

void FeedProfile::add(const FeedPiece& piece) {
    pieces_.push_back(piece);
    duration_ = piece.start + piece.duration;
}

double FeedProfile::nextStart() const noexcept {
    // A duration that is whole but for its rounding is whole.
    return std::ceil(duration_ / cycle_ * (1.0 - 1e-12)) * cycle_;
}

void FeedProfile::restAt(double s) {
    end_ = s;
    cycles_ = static_cast<std::uint64_t>(std::llround(nextStart() / cycle_));
}

void FeedProfile::truncate(std::size_t first) noexcept {
    pieces_.resize(first);
    duration_ = pieces_.empty() ? 0.0 : pieces_.back().start + pieces_.back().duration;
}

void FeedProfile::stretch(std::size_t first, double factor) noexcept {
    if (first >= pieces_.size()) return;
    const double start = pieces_[first].start;
    const double slow = 1.0 / factor;
    for (std::size_t i = first; i < pieces_.size(); ++i) {
        FeedPiece& piece = pieces_[i];
        piece.start = start + (piece.start - start) * factor;
        piece.duration *= factor;
        piece.from.s1 *= slow;
        piece.from.s2 *= slow * slow;
        piece.from.s3 *= slow * slow * slow;
        piece.bend *= slow * slow;
    }
    duration_ = pieces_.back().start + pieces_.back().duration;
}

void FeedProfile::addRest(const FeedProfile& other, double time, double until, double shift) {
    for (std::size_t i = 0; i < other.pieces_.size(); ++i) {
        FeedPiece piece = other.pieces_[i];
        if (piece.from.s >= until) break;
        const double passed = time - piece.start;
        if (passed >= piece.duration) continue;
        if (passed > 0.0) {
            piece.from = evaluate(piece, passed);
            piece.duration -= passed;
            piece.start = time;
        }
        piece.start -= time;
        piece.from.s -= shift;
        add(piece);
    }
}

double FeedProfile::restAfter(double time) const noexcept {
    std::size_t i = 0;
    while (i < pieces_.size() && pieces_[i].start + pieces_[i].duration <= time) ++i;
    while (i + 1 < pieces_.size() && pieces_[i + 1].from.s1 != 0.0) ++i;
    return i < pieces_.size() ? pieces_[i].start + pieces_[i].duration : time;
}

FeedState FeedProfile::atTime(double time) const noexcept {
    if (pieces_.empty() || time >= static_cast<double>(cycles_) * cycle_)
        return {end_, 0.0, 0.0, 0.0};
    std::size_t low = 0;
    std::size_t high = pieces_.size();
    while (high - low > 1) {
        const std::size_t middle = low + (high - low) / 2;
        (pieces_[middle].start <= time ? low : high) = middle;
    }
    const FeedPiece& piece = pieces_[low];
    const double t = std::max(0.0, time - piece.start);
    if (t < piece.duration) return evaluate(piece, t);
    // Between a stop and the next whole cycle, or by rounding between two pieces.
    if (low + 1 == pieces_.size()) return {end_, 0.0, 0.0, 0.0};
    FeedState state = pieces_[low + 1].from;
    if (state.s1 == 0.0) state.s3 = 0.0;
    return state;
}

}  // namespace takt::planner
