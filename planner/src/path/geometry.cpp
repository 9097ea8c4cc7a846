#include <algorithm>
#include <cassert>
#include <cmath>
#include <takt/planner/path_geometry.hpp>

namespace takt::planner {

namespace {

/// Differences of direction: none, so that a blend has nothing to do; and small enough to be run
/// through at a speed that depends on it. Between them lies what drawings call tangent.
constexpr double kStraight = 1e-9;
constexpr double kTangent = 1e-3;

/// Cosine of 170 degrees: beyond that a contour is all but a point where the path turns back.
constexpr double kTurnsBack = -0.984807753;

/// A remainder of an element between two blends, relative to its length, that is left out.
constexpr double kNothing = 1e-9;

/// How the directions and curvatures at a joint fit.
struct Meeting {
    bool sameMeasure;  ///< the length is measured in the same axes on both sides
    double kink;       ///< greatest difference of direction of an axis
    double bend;       ///< greatest difference of curvature of an axis
    double cosine;     ///< of the turn, in the axes that measure the length
};

Meeting meetingOf(const PathElement& before, const PathElement& after) noexcept {
    PathDerivatives from;
    PathDerivatives to;
    evaluate(before, before.length, from);
    evaluate(after, 0.0, to);
    const bool cartesian = hasCartesianMotion(before);
    const std::size_t first = cartesian ? 0 : before.space.cartesian;
    const std::size_t last = cartesian ? before.space.cartesian : before.space.axes;
    Meeting meeting{cartesian == hasCartesianMotion(after), 0.0, 0.0, 0.0};
    for (std::size_t i = 0; i < before.space.axes; ++i) {
        meeting.kink = std::max(meeting.kink, std::fabs(to.d1[i] - from.d1[i]));
        meeting.bend = std::max(meeting.bend, std::fabs(to.d2[i] - from.d2[i]));
        if (i >= first && i < last) meeting.cosine += from.d1[i] * to.d1[i];
    }
    return meeting;
}

}  // namespace

PathGeometry::PathGeometry(const PathSpace& space, std::size_t maxElements)
    : space_{space}, maxElements_{maxElements} {
    assert(space.axes >= 1 && space.axes <= maxPathAxes);
    assert(space.cartesian <= std::min<std::size_t>(3, space.axes));
    elements_.reserve(maxElements);
    pieces_.reserve(2 * maxElements);
    blends_.reserve(maxElements);
}

void PathGeometry::clear() noexcept {
    elements_.clear();
    pieces_.clear();
    blends_.clear();
    length_ = 0.0;
}

bool PathGeometry::connects(const PathElement& next) const noexcept {
    if (next.space.axes != space_.axes || next.space.cartesian != space_.cartesian) return false;
    if (elements_.empty()) return true;
    for (std::size_t i = 0; i < space_.axes; ++i) {
        const double end = elements_.back().to[i].count();
        const double gap = next.from[i].count() - end;
        if (!(std::fabs(gap) <= 1e-9 * std::max(1.0, std::fabs(end)))) return false;
    }
    return true;
}

/// How long the contour at the end of the last element may be on either side of the corner.
double PathGeometry::reachFor(const PathElement& next, double notBefore) const noexcept {
    const PathElement& last = elements_.back();
    const PathPiece& piece = pieces_.back();
    double most = 0.5 * std::min(last.length, next.length);
    most = std::min({most, piece.length, length_ - notBefore});
    if (!(most > kNothing * last.length)) return 0.0;
    const Transition& transition = last.transition;
    double reach = std::min(most, transition.size.count());
    if (transition.mode == TransitionMode::CornerDeviation)
        reach = reachForDeviation(last, next, transition.size.count(), most);
    return piece.length - reach < kNothing * last.length ? piece.length : reach;
}

JointKind PathGeometry::join(const PathElement& next, double notBefore) noexcept {
    const PathElement& last = elements_.back();
    PathPiece& piece = pieces_.back();
    if (last.transition.mode == TransitionMode::Stop) return JointKind::Stop;
    const Meeting meeting = meetingOf(last, next);
    if (!meeting.sameMeasure) return JointKind::Stop;

    const JointKind exact = meeting.kink <= kTangent ? JointKind::Through : JointKind::Stop;
    piece.endVelocity = last.transition.velocity.count();
    const bool smooth =
        meeting.kink <= kStraight && meeting.bend * std::min(last.length, next.length) <= kStraight;
    if (last.transition.mode == TransitionMode::Exact || smooth) return exact;
    if (meeting.cosine < kTurnsBack) return JointKind::Stop;
    const double reach = reachFor(next, notBefore);
    if (!(reach > kNothing * last.length)) return exact;

    const auto index = static_cast<std::uint32_t>(blends_.size());
    blends_.emplace_back(last, next, reach);
    const PathPiece contour{
        length_ - reach, blends_.back().length(), piece.element, index, 0.0, JointKind::Through,
        unlimited};
    piece.length -= reach;
    piece.end = JointKind::Through;
    piece.endVelocity = unlimited;
    if (!(piece.length > 0.0)) pieces_.pop_back();
    pieces_.push_back(contour);
    length_ = contour.start + contour.length;
    return JointKind::Contour;
}

core::Result<JointKind, PathError> PathGeometry::append(const PathElement& element,
                                                        double notBefore) noexcept {
    if (elements_.size() == maxElements_) return PathError::TooManyElements;
    if (!connects(element)) return PathError::NotConnected;
    JointKind joint = JointKind::Stop;
    double offset = 0.0;
    if (!elements_.empty()) {
        joint = join(element, notBefore);
        if (joint == JointKind::Contour) {
            offset = blends_.back().reach();
        } else {
            pieces_.back().end = joint;
        }
    }
    elements_.push_back(element);
    pieces_.push_back({length_, element.length - offset,
                       static_cast<std::uint32_t>(elements_.size() - 1), PathPiece::none, offset,
                       JointKind::Stop, unlimited});
    length_ += element.length - offset;
    return joint;
}

double PathGeometry::dropBefore(double s) noexcept {
    std::size_t count = 0;
    while (count + 1 < pieces_.size() && pieces_[count].start + pieces_[count].length <= s) ++count;
    if (count == 0) return 0.0;
    pieces_.erase(pieces_.begin(), pieces_.begin() + static_cast<std::ptrdiff_t>(count));
    const double shift = pieces_.front().start;
    const std::uint32_t elements = pieces_.front().element;
    elements_.erase(elements_.begin(), elements_.begin() + static_cast<std::ptrdiff_t>(elements));
    std::uint32_t blends = PathPiece::none;
    for (PathPiece& piece : pieces_) {
        if (piece.isBlend()) blends = std::min(blends, piece.blend);
    }
    for (PathPiece& piece : pieces_) {
        piece.start -= shift;
        piece.element -= elements;
        if (piece.isBlend()) piece.blend -= blends;
    }
    const std::size_t dropped = std::min<std::size_t>(blends, blends_.size());
    blends_.erase(blends_.begin(), blends_.begin() + static_cast<std::ptrdiff_t>(dropped));
    length_ -= shift;
    return shift;
}

std::size_t PathGeometry::pieceAt(double s) const noexcept {
    std::size_t low = 0;
    std::size_t high = pieces_.size();
    while (high - low > 1) {
        const std::size_t middle = low + (high - low) / 2;
        (pieces_[middle].start <= s ? low : high) = middle;
    }
    return low;
}

void PathGeometry::evaluate(double s, PathDerivatives& out) const noexcept {
    evaluate(pieceAt(s), s, out);
}

void PathGeometry::evaluate(std::size_t index, double s, PathDerivatives& out) const noexcept {
    const PathPiece& piece = pieces_[index];
    const double way = std::clamp(s - piece.start, 0.0, piece.length);
    if (piece.isBlend()) {
        blends_[piece.blend].evaluate(way, out);
    } else {
        const PathElement& element = elements_[piece.element];
        // Where the element is not cut, its end is met exactly.
        const bool atEnd = s >= piece.start + piece.length && piece.end != JointKind::Through;
        planner::evaluate(element, atEnd ? element.length : piece.offset + way, out);
    }
}

double PathGeometry::endOf(std::size_t i) const noexcept {
    // The pieces of an element follow each other, so the last of them is found by halving.
    std::size_t low = 0;
    std::size_t high = pieces_.size();
    while (high - low > 1) {
        const std::size_t middle = low + (high - low) / 2;
        (pieces_[middle].element <= i ? low : high) = middle;
    }
    return pieces_[low].start + pieces_[low].length;
}

PathFeed PathGeometry::feedOf(std::size_t index) const noexcept {
    const PathPiece& piece = pieces_[index];
    const PathElement& element = elements_[piece.element];
    if (!piece.isBlend()) return element.feed;
    const PathFeed& a = element.feed;
    const PathFeed& b = elements_[piece.element + 1].feed;
    return {std::min(element.transition.velocity, std::max(a.velocity, b.velocity)),
            std::min(a.acceleration, b.acceleration), std::min(a.deceleration, b.deceleration),
            std::min(a.jerk, b.jerk)};
}

}  // namespace takt::planner
