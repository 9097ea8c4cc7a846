#include <gtest/gtest.h>

#include <cmath>

#include "path_cases.hpp"

namespace takt::planner {
namespace {

using test::lineTo;
using test::point;
using test::Random;

constexpr PathSpace kPlane{2, 2};
constexpr PathSpace kSpace{3, 3};

PathDerivatives at(const PathElement& element, double offset) {
    PathDerivatives out;
    evaluate(element, offset, out);
    return out;
}

TEST(PathElement, ALineIsMeasuredInItsCartesianAxes) {
    const PathSpace space{4, 2};
    const PathElement e = lineTo(space, {0.0, 0.0, 0.0, 10.0}, {3.0, 4.0, 100.0, 20.0});
    EXPECT_DOUBLE_EQ(e.length, 5.0);
    EXPECT_DOUBLE_EQ(at(e, 2.5).q[2], 50.0);
    EXPECT_DOUBLE_EQ(at(e, 2.5).q[3], 15.0);
    EXPECT_DOUBLE_EQ(at(e, 2.5).d1[2], 20.0);
}

TEST(PathElement, ALineWithoutCartesianMotionIsMeasuredInTheOthers) {
    const PathSpace space{3, 2};
    EXPECT_DOUBLE_EQ(lineTo(space, {1.0, 2.0, 0.0}, {1.0, 2.0, -7.0}).length, 7.0);
}

TEST(PathElement, NoLengthIsRefused) {
    EXPECT_EQ(line(kPlane, point({1.0, 2.0}), point({1.0, 2.0})).error(), PathError::NoLength);
}

TEST(PathElement, AnArcByBorderPassesItsBorderPoint) {
    const auto arc = arcByBorder(kSpace, point({1.0, 0.0, 5.0}), point({0.0, 1.0, 5.0}),
                                 point({-1.0, 0.0, 5.0}));
    ASSERT_TRUE(arc.ok());
    EXPECT_NEAR(arc.value().radius, 1.0, 1e-14);
    EXPECT_NEAR(arc.value().angle, 3.14159265358979, 1e-13);
    const PathDerivatives middle = at(arc.value(), 0.5 * arc.value().length);
    EXPECT_NEAR(middle.q[0], 0.0, 1e-13);
    EXPECT_NEAR(middle.q[1], 1.0, 1e-13);
    EXPECT_NEAR(middle.q[2], 5.0, 1e-13);
}

TEST(PathElement, ABorderOnTheChordIsRefused) {
    EXPECT_EQ(arcByBorder(kPlane, point({0.0, 0.0}), point({1.0, 1.0}), point({2.0, 2.0})).error(),
              PathError::CollinearPoints);
}

TEST(PathElement, AnArcByCentreGoesTheWayThatIsChosen) {
    const auto make = [](ArcChoice choice) {
        return arcByCentre(kPlane, point({1.0, 0.0}), point({0.0, 0.0}), point({0.0, 1.0}), choice,
                           core::Distance{0.0});
    };
    EXPECT_NEAR(make(ArcChoice::CounterClockwise).value().length, 0.5 * 3.14159265358979, 1e-13);
    EXPECT_NEAR(make(ArcChoice::Clockwise).value().length, 1.5 * 3.14159265358979, 1e-13);
}

TEST(PathElement, TheSameEndIsAFullCircle) {
    const auto arc =
        arcByCentre(kSpace, point({2.0, 0.0, 0.0}), point({1.0, 0.0, 0.0}), point({2.0, 0.0, 0.0}),
                    ArcChoice::CounterClockwise, core::Distance{0.0});
    ASSERT_TRUE(arc.ok());
    EXPECT_NEAR(arc.value().length, 2.0 * 3.14159265358979, 1e-12);
    EXPECT_NEAR(at(arc.value(), 0.25 * arc.value().length).q[1], 1.0, 1e-13);
}

TEST(PathElement, RadiiMayDifferByTheTolerance) {
    const auto make = [](double tolerance) {
        return arcByCentre(kPlane, point({1.0, 0.0}), point({0.0, 0.0}), point({0.0, 1.01}),
                           ArcChoice::CounterClockwise, core::Distance{tolerance});
    };
    EXPECT_EQ(make(0.001).error(), PathError::RadiiDiffer);
    const auto arc = make(0.02);
    ASSERT_TRUE(arc.ok());
    EXPECT_NEAR(at(arc.value(), 0.0).q[0], 1.0, 1e-12);
    EXPECT_NEAR(at(arc.value(), 0.999999999 * arc.value().length).q[1], 1.01, 1e-8);
}

TEST(PathElement, AnArcByRadiusTurnsAboutItsNormalByHalfATurnAtMost) {
    const auto arc = arcByRadius(kSpace, point({0.0, 0.0, 0.0}), {0.0, 0.0, 5.0},
                                 point({6.0, 0.0, 0.0}), ArcChoice::CounterClockwise);
    ASSERT_TRUE(arc.ok());
    EXPECT_NEAR(arc.value().centre[1], 4.0, 1e-13);
    EXPECT_LT(arc.value().angle, 3.1416);
    EXPECT_EQ(arcByRadius(kSpace, point({0.0, 0.0, 0.0}), {0.0, 0.0, 2.0}, point({6.0, 0.0, 0.0}),
                          ArcChoice::CounterClockwise)
                  .error(),
              PathError::RadiusTooSmall);
}

TEST(PathElement, AnEndBesideThePlaneMakesAHelix) {
    const auto arc = arcByRadius(kSpace, point({0.0, 0.0, 0.0}), {0.0, 0.0, 5.0},
                                 point({6.0, 0.0, 2.0}), ArcChoice::CounterClockwise);
    ASSERT_TRUE(arc.ok());
    EXPECT_NEAR(at(arc.value(), 0.5 * arc.value().length).q[2], 1.0, 1e-13);
    const PathDerivatives d = at(arc.value(), 0.3);
    EXPECT_NEAR(std::sqrt(d.d1[0] * d.d1[0] + d.d1[1] * d.d1[1] + d.d1[2] * d.d1[2]), 1.0, 1e-13);
}

TEST(PathBlend, PassesACornerOfLinesAtTheDeviation) {
    for (const double angle : {0.3, 1.0, 1.5707963267949, 2.5}) {
        const PathElement a = lineTo(kPlane, {-20.0, 0.0}, {0.0, 0.0});
        const PathElement b =
            lineTo(kPlane, {0.0, 0.0}, {20.0 * std::cos(angle), 20.0 * std::sin(angle)});
        const double reach = reachForDeviation(a, b, 0.1, 10.0);
        EXPECT_NEAR(deviationOf(a, b, reach), 0.1, 1e-12) << angle;
    }
}

TEST(PathBlend, IsClippedToHalfOfTheShorterNeighbour) {
    PathGeometry path{kPlane, 4};
    PathElement a = lineTo(kPlane, {0.0, 0.0}, {20.0, 0.0});
    a.transition = {TransitionMode::CornerDistance, core::Distance{15.0}};
    ASSERT_TRUE(path.append(a).ok());
    ASSERT_EQ(path.append(lineTo(kPlane, {20.0, 0.0}, {20.0, 8.0})).value(), JointKind::Contour);
    EXPECT_DOUBLE_EQ(path.piece(1).start, 16.0);
    EXPECT_DOUBLE_EQ(path.piece(2).length, 4.0);
}

TEST(PathGeometry, StopsAtACornerThatIsToBeExact) {
    PathGeometry path{kPlane, 4};
    PathElement a = lineTo(kPlane, {0.0, 0.0}, {20.0, 0.0});
    a.transition.mode = TransitionMode::Exact;
    ASSERT_TRUE(path.append(a).ok());
    PathElement b = lineTo(kPlane, {20.0, 0.0}, {30.0, 0.0});
    b.transition.mode = TransitionMode::Exact;
    EXPECT_EQ(path.append(b).value(), JointKind::Through);
    EXPECT_EQ(path.append(lineTo(kPlane, {30.0, 0.0}, {30.0, 5.0})).value(), JointKind::Stop);
}

TEST(PathGeometry, RefusesWhatDoesNotConnectOrFit) {
    PathGeometry path{kPlane, 1};
    ASSERT_TRUE(path.append(lineTo(kPlane, {0.0, 0.0}, {20.0, 0.0})).ok());
    EXPECT_EQ(path.append(lineTo(kPlane, {20.0, 0.0}, {21.0, 0.0})).error(),
              PathError::TooManyElements);
    PathGeometry wide{kPlane, 2};
    ASSERT_TRUE(wide.append(lineTo(kPlane, {0.0, 0.0}, {20.0, 0.0})).ok());
    EXPECT_EQ(wide.append(lineTo(kPlane, {20.1, 0.0}, {21.0, 0.0})).error(),
              PathError::NotConnected);
}

/// Differences of positions, and of each derivative, against the next derivative.
TEST(PathGeometry, DerivativesAreThoseOfThePositions) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        Random random{seed};
        const test::PathCase c = test::randomPath(random, 6);
        PathGeometry path{c.space, 8};
        for (const PathElement& e : c.elements) ASSERT_TRUE(path.append(e).ok());
        for (std::size_t i = 0; i < path.pieceCount(); ++i) {
            const PathPiece& piece = path.piece(i);
            const double step = 1e-4 * piece.length;
            const double s = piece.start + random.uniform(0.1, 0.9) * piece.length;
            PathDerivatives low;
            PathDerivatives here;
            PathDerivatives high;
            path.evaluate(i, s - step, low);
            path.evaluate(i, s, here);
            path.evaluate(i, s + step, high);
            for (std::size_t k = 0; k < c.space.axes; ++k) {
                const double size = 1.0 + std::fabs(here.d1[k]);
                EXPECT_NEAR((high.q[k] - low.q[k]) / (2.0 * step), here.d1[k],
                            (1e-5 + 1e-13 / step) * size)
                    << "seed " << seed << " piece " << i;
                const double bend = (high.d1[k] - low.d1[k]) / (2.0 * step);
                EXPECT_NEAR(bend * piece.length, here.d2[k] * piece.length,
                            1e-3 * size + 1e-2 * std::fabs(here.d2[k]) * piece.length)
                    << "seed " << seed << " piece " << i;
            }
        }
    }
}

TEST(PathGeometry, JoinsContoursWithPositionDirectionAndCurvature) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        Random random{seed};
        const test::PathCase c = test::randomPath(random, 6);
        PathGeometry path{c.space, 8};
        for (const PathElement& e : c.elements) ASSERT_TRUE(path.append(e).ok());
        for (std::size_t i = 0; i + 1 < path.pieceCount(); ++i) {
            if (!path.piece(i).isBlend() && !path.piece(i + 1).isBlend()) continue;
            PathDerivatives a;
            PathDerivatives b;
            const double s = path.piece(i + 1).start;
            path.evaluate(i, s, a);
            path.evaluate(i + 1, s, b);
            const double size = std::min(path.piece(i).length, path.piece(i + 1).length);
            for (std::size_t k = 0; k < c.space.axes; ++k) {
                const double steep = 1.0 + std::fabs(a.d1[k]);
                EXPECT_NEAR(a.q[k], b.q[k], 1e-9) << "seed " << seed << " piece " << i;
                EXPECT_NEAR(a.d1[k], b.d1[k], 1e-7 * steep) << "seed " << seed << " piece " << i;
                EXPECT_NEAR(a.d2[k] * size, b.d2[k] * size, 1e-6 * steep)
                    << "seed " << seed << " piece " << i;
            }
        }
    }
}

}  // namespace
}  // namespace takt::planner
