#include <gtest/gtest.h>

#include <takt/core/random.hpp>

#include "scenes.hpp"

namespace takt::planner::roadmap::test {
namespace {

using core::Distance;
using core::Position;
using Values = std::vector<double>;

KeepOutParams box(std::vector<std::pair<double, double>> spans, double clearance = 0.0) {
    KeepOutParams keepOut;
    for (std::size_t i = 0; i < spans.size(); ++i)
        keepOut.spans.push_back({i, Position{spans[i].first}, Position{spans[i].second}});
    keepOut.clearance = Distance{clearance};
    return keepOut;
}

KeepOutParams cylinder(double x, double y, double radius, double clearance = 0.0) {
    KeepOutParams keepOut;
    keepOut.disc = KeepOutDisc{0, 1, Position{x}, Position{y}, Distance{radius}};
    keepOut.spans.push_back({2, Position{0.0}, Position{10.0}});
    keepOut.clearance = Distance{clearance};
    return keepOut;
}

bool free(const KeepOutParams& keepOut, const Values& a, const Values& b) {
    return Obstacles{std::span{&keepOut, 1}}.isFree(a, b);
}
bool free(const KeepOutParams& keepOut, const Values& a, const Values& b, const Values& c) {
    return Obstacles{std::span{&keepOut, 1}}.isFree(a, b, c);
}

TEST(Segment, IsBlockedByABoxItPasses) {
    const KeepOutParams keepOut = box({{10, 20}, {10, 20}});
    EXPECT_FALSE(free(keepOut, {0, 15}, {30, 15}));
    EXPECT_FALSE(free(keepOut, {30, 16}, {0, 14}));
    EXPECT_TRUE(free(keepOut, {0, 15}, {9.9, 15}));
    EXPECT_TRUE(free(keepOut, {0, 0}, {30, 9}));
}

TEST(Segment, MayTouchTheFaceOfABox) {
    const KeepOutParams keepOut = box({{10, 20}, {10, 20}});
    EXPECT_TRUE(free(keepOut, {0, 10}, {30, 10}));
    EXPECT_TRUE(free(keepOut, {0, 20}, {20, 0}));
    EXPECT_TRUE(free(keepOut, {0, 15}, {10, 15}));
    EXPECT_FALSE(free(keepOut, {0, 10.001}, {30, 10.001}));
}

TEST(Segment, StaysClearOfABoxByItsClearance) {
    const KeepOutParams keepOut = box({{10, 20}, {10, 20}}, 2.0);
    EXPECT_FALSE(free(keepOut, {0, 8.5}, {30, 8.5}));
    EXPECT_TRUE(free(keepOut, {0, 8.0}, {30, 8.0}));
}

TEST(Segment, IsBlockedByACylinderAndItsCaps) {
    const KeepOutParams keepOut = cylinder(0, 0, 5);
    EXPECT_FALSE(free(keepOut, {-10, 0, 5}, {10, 0, 5}));
    EXPECT_FALSE(free(keepOut, {1, 1, -5}, {1, 1, 15}));
    EXPECT_FALSE(free(keepOut, {1, 1, 15}, {1, 1, 9}));
    EXPECT_TRUE(free(keepOut, {-10, 0, 10}, {10, 0, 10}));
    EXPECT_TRUE(free(keepOut, {-10, 5, 5}, {10, 5, 5}));
    EXPECT_TRUE(free(keepOut, {6, 0, -5}, {6, 0, 15}));
    EXPECT_TRUE(free(keepOut, {-10, 0, 8}, {10, 0, 12.1 + 2 * 8}));
}

TEST(Segment, StaysClearOfACylinderByItsClearance) {
    const KeepOutParams keepOut = cylinder(0, 0, 5, 1.0);
    EXPECT_FALSE(free(keepOut, {-10, 5.9, 5}, {10, 5.9, 5}));
    EXPECT_FALSE(free(keepOut, {-10, 0, 10.9}, {10, 0, 10.9}));
    EXPECT_TRUE(free(keepOut, {-10, 6, 5}, {10, 6, 5}));
    EXPECT_TRUE(free(keepOut, {-10, 0, 11}, {10, 0, 11}));
}

TEST(Segment, OfNoLengthIsAPoint) {
    const KeepOutParams keepOut = cylinder(0, 0, 5);
    EXPECT_FALSE(free(keepOut, {3, 0, 5}, {3, 0, 5}));
    EXPECT_TRUE(free(keepOut, {5, 0, 5}, {5, 0, 5}));
}

TEST(Segment, CannotPassWhereASpanHasNoEnd) {
    KeepOutParams wall;
    wall.spans.push_back({0, Position{10.0}, Position{12.0}});
    EXPECT_FALSE(free(wall, {0, 1e9}, {20, 1e9}));
    wall.spans.push_back({1, Position{-std::numeric_limits<double>::infinity()}, Position{5.0}});
    EXPECT_FALSE(free(wall, {0, 4}, {20, 4}));
    EXPECT_TRUE(free(wall, {0, 6}, {20, 6}));
}

TEST(Triangle, IsBlockedByWhatLiesWithinIt) {
    EXPECT_FALSE(free(box({{4, 5}, {4, 5}}), {0, 0}, {20, 0}, {0, 20}));
    EXPECT_TRUE(free(box({{14, 15}, {14, 15}}), {0, 0}, {20, 0}, {0, 20}));
    const KeepOutParams disc = cylinder(5, 5, 1);
    EXPECT_FALSE(free(disc, {0, 0, 5}, {20, 0, 5}, {0, 20, 5}));
    EXPECT_TRUE(free(disc, {0, 0, 11}, {20, 0, 11}, {0, 20, 11}));
}

TEST(Triangle, IsBlockedWhenItLiesWithin) {
    EXPECT_FALSE(free(box({{0, 100}, {0, 100}}), {40, 40}, {60, 40}, {40, 60}));
    EXPECT_FALSE(free(cylinder(0, 0, 50), {1, 1, 5}, {2, 1, 5}, {1, 2, 5}));
}

TEST(Triangle, IsBlockedByAPoleThroughItsMiddle) {
    EXPECT_FALSE(free(box({{4, 5}, {4, 5}, {-100, 100}}), {0, 0, 0}, {20, 0, 9}, {0, 20, -9}));
    EXPECT_FALSE(free(cylinder(5, 5, 0.1), {0, 0, 5}, {20, 0, 5}, {0, 20, 6}));
}

TEST(Triangle, MayTouch) {
    EXPECT_TRUE(free(box({{10, 20}, {10, 20}}), {0, 0}, {20, 0}, {0, 20}));
    EXPECT_TRUE(free(box({{10, 20}, {10, 20}}), {0, 10}, {30, 10}, {15, 0}));
    EXPECT_TRUE(free(cylinder(0, 0, 5), {-10, 5, 5}, {10, 5, 5}, {0, 12, 5}));
}

TEST(Triangle, MayBeFlat) {
    EXPECT_FALSE(free(box({{10, 20}, {10, 20}}), {0, 15}, {15, 15}, {30, 15}));
    EXPECT_FALSE(free(cylinder(0, 0, 5), {-10, 0, 5}, {0, 0, 5}, {10, 0, 5}));
    EXPECT_TRUE(free(cylinder(0, 0, 5), {-10, 6, 5}, {0, 6, 5}, {10, 6, 5}));
    EXPECT_FALSE(free(cylinder(0, 0, 5), {1, 1, 5}, {1, 1, 5}, {1, 1, 5}));
}

/// Samples of a triangle: how deep the deepest of them lies.
double deepest(const Scene& scene, const Values& a, const Values& b, const Values& c, int steps) {
    double most = -std::numeric_limits<double>::infinity();
    Values point(a.size());
    for (int i = 0; i <= steps; ++i) {
        for (int k = 0; i + k <= steps; ++k) {
            const double u = static_cast<double>(i) / steps;
            const double v = static_cast<double>(k) / steps;
            for (std::size_t axis = 0; axis < a.size(); ++axis)
                point[axis] = a[axis] + u * (b[axis] - a[axis]) + v * (c[axis] - a[axis]);
            most = std::max(most, depth(scene, point));
        }
    }
    return most;
}

/// Samples lie at most this far from any point of a triangle of this size, in any one axis.
constexpr double Gap = 400.0 / 100;

TEST(Obstacles, AgreeWithSamples) {
    core::Random random{7};
    int freeSegments = 0;
    int blockedSegments = 0;
    int freeTriangles = 0;
    int blockedTriangles = 0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        const Scene scene = randomScene(seed, 2 + seed % 2);
        const Obstacles obstacles{scene.keepOuts};
        Values corners[3];
        for (Values& corner : corners) {
            corner.resize(scene.axes.size());
            for (double& value : corner) value = random.uniform(0.0, 400.0);
        }
        // A small one now and then: large ones are hardly ever free.
        if (seed % 4 != 0) {
            for (int i = 1; i < 3; ++i)
                for (std::size_t axis = 0; axis < corners[i].size(); ++axis)
                    corners[i][axis] = corners[0][axis] + 0.1 * (corners[i][axis] - 200.0);
        }
        const auto& [a, b, c] = corners;
        EXPECT_EQ(obstacles.around(a).has_value(), depth(scene, a) > 0.0) << seed;
        const double onSegment = deepest(scene, a, b, a, 400);
        const double onTriangle = deepest(scene, a, b, c, 100);
        if (obstacles.isFree(a, b)) {
            ++freeSegments;
            EXPECT_LE(onSegment, 1e-9) << seed;
        } else {
            ++blockedSegments;
            EXPECT_GT(onSegment, -Gap) << seed;
        }
        if (obstacles.isFree(a, b, c)) {
            ++freeTriangles;
            EXPECT_LE(onTriangle, 1e-9) << seed;
        } else {
            ++blockedTriangles;
            EXPECT_GT(onTriangle, -Gap) << seed;
        }
    }
    EXPECT_GT(std::min(freeSegments, blockedSegments), 50);
    EXPECT_GT(std::min(freeTriangles, blockedTriangles), 50);
}

}  // namespace
}  // namespace takt::planner::roadmap::test
