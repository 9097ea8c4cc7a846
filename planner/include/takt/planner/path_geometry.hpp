#pragma once

#include <cstddef>
#include <cstdint>
#include <takt/planner/path_blend.hpp>
#include <takt/planner/path_element.hpp>
#include <vector>

namespace takt::planner {

enum class JointKind : std::uint8_t {
    Stop,     ///< the feed comes to rest here
    Through,  ///< the direction goes on
    Contour,  ///< a blend replaces the corner
};

/// A stretch of the path: (part of) an element, or the blend at the end of one.
struct PathPiece {
    double start;  ///< on the path
    double length;
    std::uint32_t element;  ///< index; a blend belongs to the element that it leaves
    std::uint32_t blend;    ///< index, or none
    double offset;          ///< behind the start of the element
    JointKind end;          ///< to the next piece; a stop at the last
    double endVelocity;     ///< greatest velocity there

    static constexpr std::uint32_t none = 0xFFFFFFFF;
    [[nodiscard]] bool isBlend() const noexcept { return blend != none; }
};

/// A bounded window of elements with the blends between them, measured by its length: q(s).
///
///     PathGeometry path{{3, 3}, 32};
///     path.append(first);                 // at rest at its end
///     path.append(second);                // the joint becomes what `first` asked for
///     path.evaluate(s, derivatives);      // rt.
class PathGeometry {
public:
    /// \pre 1 <= space.axes <= maxPathAxes, space.cartesian <= min(3, space.axes)
    PathGeometry(const PathSpace& space, std::size_t maxElements);

    void clear() noexcept;

    /// Adds an element. What lies before `notBefore` stays as it is: a blend that would begin
    /// earlier is made smaller, and is left out where nothing of it remains.
    /// \return what became of the joint before it; or TooManyElements, NotConnected
    core::Result<JointKind, PathError> append(const PathElement& element,
                                              double notBefore = 0.0) noexcept;

    /// The end becomes a stop, whatever the last element asks for. \pre elementCount() > 0
    void stopAtEnd() noexcept { elements_.back().transition.mode = TransitionMode::Stop; }

    /// What the next append() makes of the joint. \pre elementCount() > 0
    void setEndTransition(const Transition& transition) noexcept {
        elements_.back().transition = transition;
    }

    /// Forgets all pieces that end at or before `s` and begins to count at the first that is left.
    /// \return what is to be subtracted from every s
    double dropBefore(double s) noexcept;

    /// rt. Position and derivatives at `s`, clipped to 0..length().
    void evaluate(double s, PathDerivatives& out) const noexcept;
    /// rt. The same within a piece, which decides on the side of a joint.
    void evaluate(std::size_t piece, double s, PathDerivatives& out) const noexcept;

    [[nodiscard]] double length() const noexcept { return length_; }
    [[nodiscard]] const PathSpace& space() const noexcept { return space_; }
    [[nodiscard]] std::size_t maxElements() const noexcept { return maxElements_; }

    [[nodiscard]] std::size_t pieceCount() const noexcept { return pieces_.size(); }
    [[nodiscard]] const PathPiece& piece(std::size_t i) const noexcept { return pieces_[i]; }
    /// rt. The piece in which `s` lies; at a joint the later one. \pre pieceCount() > 0
    [[nodiscard]] std::size_t pieceAt(double s) const noexcept;

    [[nodiscard]] std::size_t elementCount() const noexcept { return elements_.size(); }
    [[nodiscard]] const PathElement& element(std::size_t i) const noexcept { return elements_[i]; }
    /// rt. The element in which `s` lies. An element is left at the end of its contour.
    [[nodiscard]] std::size_t elementAt(double s) const noexcept {
        return pieces_[pieceAt(s)].element;
    }
    /// rt. Where the path leaves element `i`, with its contour.
    [[nodiscard]] double endOf(std::size_t i) const noexcept;
    /// The feed limits on a piece; in a blend those that suit both neighbours.
    [[nodiscard]] PathFeed feedOf(std::size_t piece) const noexcept;

private:
    [[nodiscard]] bool connects(const PathElement& next) const noexcept;
    JointKind join(const PathElement& next, double notBefore) noexcept;
    [[nodiscard]] double reachFor(const PathElement& next, double notBefore) const noexcept;

    PathSpace space_;
    std::size_t maxElements_;
    std::vector<PathElement> elements_;
    std::vector<PathPiece> pieces_;
    std::vector<PathBlend> blends_;
    double length_{0.0};
};

}  // namespace takt::planner
