#include "tracer/geometry/transform.h"

#include "tests/random.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <limits>

namespace raypick {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void expect_near(const glm::dvec3& got, const glm::dvec3& wanted, double tolerance) {
    EXPECT_NEAR(got.x, wanted.x, tolerance);
    EXPECT_NEAR(got.y, wanted.y, tolerance);
    EXPECT_NEAR(got.z, wanted.z, tolerance);
}

Transform random_transform(Random& random) {
    const Transform stretch = scale({random.between(0.1, 5.0), random.between(0.1, 5.0),
                                     random.between(0.1, 5.0) * (random.unit() < 0.5 ? -1 : 1)});
    const Transform turn = rotate(random.between(-360.0, 360.0), random.direction());
    const Transform skew = rotate(random.between(-360.0, 360.0), random.direction());
    return translate(10.0 * random.direction()) * turn * stretch * skew;
}

TEST(Transform, DefaultIsIdentity) {
    const Transform t;
    EXPECT_TRUE(t.is_identity());
    EXPECT_FALSE(t.mirrors());
    EXPECT_EQ(t.point({1.0, 2.0, 3.0}), glm::dvec3(1.0, 2.0, 3.0));
    EXPECT_FALSE(translate({0.0, 1e-9, 0.0}).is_identity());
    EXPECT_FALSE(scale({1.0, 1.0, 2.0}).is_identity());
}

TEST(Transform, TranslateMovesPointsNotVectors) {
    const Transform t = translate({1.0, -2.0, 3.0});
    EXPECT_EQ(t.point({10.0, 20.0, 30.0}), glm::dvec3(11.0, 18.0, 33.0));
    EXPECT_EQ(t.vector({10.0, 20.0, 30.0}), glm::dvec3(10.0, 20.0, 30.0));
}

TEST(Transform, RotatesRightHanded) {
    expect_near(rotate(90.0, {0.0, 0.0, 1.0}).point({1.0, 0.0, 0.0}), {0.0, 1.0, 0.0}, 1e-15);
    expect_near(rotate(90.0, {5.0, 0.0, 0.0}).point({0.0, 1.0, 0.0}), {0.0, 0.0, 1.0}, 1e-15);
    expect_near(rotate(-90.0, {0.0, 0.1, 0.0}).point({0.0, 0.0, 1.0}), {-1.0, 0.0, 0.0}, 1e-15);
    // A third of a turn about the diagonal carries x to y to z.
    expect_near(rotate(120.0, {1.0, 1.0, 1.0}).point({1.0, 2.0, 3.0}), {3.0, 1.0, 2.0}, 1e-14);
}

TEST(Transform, ProductAppliesTheInnerFirst) {
    const Transform move_then_stretch = scale({2.0, 2.0, 2.0}) * translate({1.0, 0.0, 0.0});
    EXPECT_EQ(move_then_stretch.point({1.0, 1.0, 1.0}), glm::dvec3(4.0, 2.0, 2.0));
    const Transform stretch_then_move = translate({1.0, 0.0, 0.0}) * scale({2.0, 2.0, 2.0});
    EXPECT_EQ(stretch_then_move.point({1.0, 1.0, 1.0}), glm::dvec3(3.0, 2.0, 2.0));
}

TEST(Transform, MatrixFormIsColumnVectors) {
    glm::dmat4 matrix(1.0);
    matrix[3] = glm::dvec4(7.0, 8.0, 9.0, 1.0);
    matrix[1] = glm::dvec4(4.0, 5.0, 6.0, 0.0);
    const Transform t = from_matrix(matrix);
    EXPECT_EQ(t.point({0.0, 0.0, 0.0}), glm::dvec3(7.0, 8.0, 9.0));
    EXPECT_EQ(t.vector({0.0, 1.0, 0.0}), glm::dvec3(4.0, 5.0, 6.0));
    EXPECT_EQ(to_matrix(t), matrix);
    Random random(1);
    const Transform any = random_transform(random);
    EXPECT_EQ(from_matrix(to_matrix(any)), any);
}

TEST(Transform, MirrorsIfAnOddNumberOfAxesIsTurned) {
    EXPECT_TRUE(scale({-1.0, 1.0, 1.0}).mirrors());
    EXPECT_FALSE(scale({-1.0, 1.0, -2.0}).mirrors());
    EXPECT_TRUE(scale({-1e-4, -1e-4, -1e-4}).mirrors());
    EXPECT_FALSE(rotate(180.0, {0.0, 1.0, 0.0}).mirrors());
}

TEST(Transform, InverseUndoes) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const Transform t = random_transform(random);
        const std::optional<Transform> back = inverse(t);
        ASSERT_TRUE(back.has_value());
        const glm::dvec3 p = 5.0 * random.direction();
        expect_near(back->point(t.point(p)), p, 1e-11);
        expect_near(t.vector(back->vector(p)), p, 1e-11);
    }
}

TEST(Transform, TinyAndHugeScalesHaveAnInverse) {
    for (const double s : {1e-30, 1e-6, 1e-4, 1e6, 1e30}) {
        SCOPED_TRACE(s);
        const std::optional<Transform> back =
            inverse(translate({3.0, 4.0, 5.0}) * scale({s, s, s}));
        ASSERT_TRUE(back.has_value());
        EXPECT_DOUBLE_EQ(back->vector({1.0, 0.0, 0.0}).x, 1.0 / s);
    }
}

TEST(Transform, SingularMapsHaveNoInverse) {
    EXPECT_FALSE(inverse(scale({1.0, 0.0, 1.0})).has_value());
    Transform flat;
    flat.linear = glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1));
    EXPECT_FALSE(inverse(flat).has_value());
    EXPECT_FALSE(inverse(scale({1.0, kNaN, 1.0})).has_value());
    EXPECT_FALSE(inverse(scale({1.0, kInfinity, 1.0})).has_value());
    EXPECT_FALSE(inverse(translate({kNaN, 0.0, 0.0})).has_value());
    EXPECT_FALSE(inverse(translate({0.0, 0.0, -kInfinity})).has_value());
}

TEST(Transform, NormalsStayPerpendicularAndOutward) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const Transform world_from_object = random_transform(random);
        const Transform object_from_world = inverse(world_from_object).value();
        // A tangent plane of the unit sphere, whose normal is the point itself.
        const glm::dvec3 n = random.direction();
        const glm::dvec3 u = glm::normalize(glm::cross(n, random.direction()));
        const glm::dvec3 v = glm::cross(n, u);
        const glm::dvec3 world = world_normal(object_from_world, n);
        EXPECT_NEAR(glm::length(world), 1.0, 1e-12);
        EXPECT_NEAR(glm::dot(world, glm::normalize(world_from_object.vector(u))), 0.0, 1e-12);
        EXPECT_NEAR(glm::dot(world, glm::normalize(world_from_object.vector(v))), 0.0, 1e-12);
        EXPECT_GT(glm::dot(world, world_from_object.vector(n)), 0.0);
    }
}

TEST(Transform, NormalByHand) {
    // The plane x + y = 0 stretched twofold in x becomes x / 2 + y = 0.
    const Transform object_from_world = inverse(scale({2.0, 1.0, 1.0})).value();
    const glm::dvec3 n = world_normal(object_from_world, {1.0, 1.0, 0.0});
    expect_near(n, {1.0 / std::sqrt(5.0), 2.0 / std::sqrt(5.0), 0.0}, 1e-15);
    // Mirrored in x, the outward normal of the face x = 1 points to -x.
    const Transform mirrored = inverse(scale({-3.0, 1.0, 1.0})).value();
    expect_near(world_normal(mirrored, {7.0, 0.0, 0.0}), {-1.0, 0.0, 0.0}, 1e-15);
}

TEST(Transform, WorldBoundsAreTightAndRoundedOutwards) {
    const Bounds turned = world_bounds(rotate(45.0, {0.0, 0.0, 1.0}), {-1, -1, -1}, {1, 1, 1});
    const double diagonal = std::sqrt(2.0);
    for (int axis = 0; axis < 2; ++axis) {
        EXPECT_LE(static_cast<double>(turned.min[axis]), -diagonal + 1e-15);
        EXPECT_GE(static_cast<double>(turned.max[axis]), diagonal - 1e-15);
        EXPECT_NEAR(static_cast<double>(turned.max[axis]), diagonal, 5e-7);
    }
    const glm::dvec3 low(0.1, 1.0 / 3.0, 1e7 + 0.3);
    const glm::dvec3 high(0.7, 2.0 / 3.0, 1e7 + 0.4);
    const Bounds b = world_bounds(Transform{}, low, high);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(static_cast<double>(b.min[axis]), low[axis]);
        EXPECT_GE(static_cast<double>(b.max[axis]), high[axis]);
        EXPECT_NEAR(static_cast<double>(b.min[axis]), low[axis], 2.5e-7 * std::abs(low[axis]));
        EXPECT_NEAR(static_cast<double>(b.max[axis]), high[axis], 2.5e-7 * std::abs(high[axis]));
    }
}

TEST(Transform, WorldBoundsHoldAllCorners) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const Transform t = random_transform(random);
        const glm::dvec3 low = random.point(glm::dvec3(-3.0), glm::dvec3(0.0));
        const glm::dvec3 high = random.point(glm::dvec3(0.0), glm::dvec3(3.0));
        const Bounds b = world_bounds(t, low, high);
        Bounds corners;
        for (unsigned corner = 0; corner < 8; ++corner) {
            const glm::dvec3 p =
                t.point({(corner & 1u) != 0 ? high.x : low.x, (corner & 2u) != 0 ? high.y : low.y,
                         (corner & 4u) != 0 ? high.z : low.z});
            corners.extend(glm::vec3(p));
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_LE(static_cast<double>(b.min[axis]), p[axis] + 1e-12);
                EXPECT_GE(static_cast<double>(b.max[axis]), p[axis] - 1e-12);
            }
        }
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(b.min[axis], corners.min[axis], 1e-5f);
            EXPECT_NEAR(b.max[axis], corners.max[axis], 1e-5f);
        }
    }
}

}  // namespace
}  // namespace raypick
