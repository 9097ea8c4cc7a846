#pragma once

#include <cstddef>
#include <cstdint>
#include <takt/core/units.hpp>
#include <vector>

namespace takt::planner {

/// Where the feed is on the path, and its first three derivatives in time.
struct FeedState {
    double s{0.0};
    double s1{0.0};
    double s2{0.0};
    double s3{0.0};
};

/// A stretch of feed on which s1^2 is a quadratic of s, so s2 = from.s2 + bend * (s - from.s), or
/// of constant jerk.
struct FeedPiece {
    double start;  ///< seconds
    double duration;
    FeedState from;
    double bend;  ///< 1/s^2; not used with constant jerk
    bool constantJerk;
};

/// rt. The state `time` seconds after the beginning of a piece.
[[nodiscard]] FeedState evaluate(const FeedPiece& piece, double time) noexcept;

/// The feed along a path as pieces in time: s(t), ending at rest. Evaluated once per cycle.
class FeedProfile {
public:
    explicit FeedProfile(core::Seconds cycle) noexcept : cycle_{cycle.count()} {}

    void reserve(std::size_t pieces) { pieces_.reserve(pieces); }
    void clear() noexcept;
    /// Goes on with a piece. \pre it begins where the feed ends
    void add(const FeedPiece& piece);
    /// The feed is at rest at `s` from the next whole cycle on.
    void restAt(double s);
    /// Makes all pieces from `first` on slower. \pre it begins at rest, factor >= 1
    void stretch(std::size_t first, double factor) noexcept;
    /// Takes away all pieces from `first` on.
    void truncate(std::size_t first) noexcept;
    /// Adds what `other` does from a time on up to where it reaches `until`, which is a stop of it
    /// or its end; `shift` is subtracted from its places. \pre empty
    void addRest(const FeedProfile& other, double time, double until, double shift);
    /// The first whole cycle after the last piece, in seconds: where a next section may begin.
    [[nodiscard]] double nextStart() const noexcept;

    /// rt. The state at a number of cycles after the beginning; at rest at the end of the path
    /// from duration() on. O(log pieces).
    [[nodiscard]] FeedState at(std::uint64_t cycle) const noexcept {
        return atTime(static_cast<double>(cycle) * cycle_);
    }
    /// rt. The same at any time, in seconds.
    [[nodiscard]] FeedState atTime(double time) const noexcept;

    /// rt. When the feed next comes to rest, at a stop or at its end; `time` if it has. O(pieces).
    [[nodiscard]] double restAfter(double time) const noexcept;

    /// Whole cycles until it rests at its end.
    [[nodiscard]] std::uint64_t cycles() const noexcept { return cycles_; }
    /// Seconds of motion, without the rounding up to whole cycles.
    [[nodiscard]] double duration() const noexcept { return duration_; }
    [[nodiscard]] double cycle() const noexcept { return cycle_; }
    [[nodiscard]] std::size_t size() const noexcept { return pieces_.size(); }
    [[nodiscard]] const FeedPiece& operator[](std::size_t i) const noexcept { return pieces_[i]; }

private:
    double cycle_;
    std::vector<FeedPiece> pieces_;
    double duration_{0.0};
    double end_{0.0};
    std::uint64_t cycles_{0};
};

}  // namespace takt::planner
