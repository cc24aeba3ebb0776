// Disk, rectangle, cone and torus against an independent method: whether a point is inside the
// solid, asked in long double along the ray, and bisected where the answer changes.
#include "tests/random.h"
#include "tests/tracer_scenes.h"
#include "tracer/geometry/shapes.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace raypick {
namespace {

using Long = long double;
constexpr std::array<double, 5> kScales{1e-4, 1e-2, 1.0, 1e2, 1e4};
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct LongPoint {
    Long x = 0;
    Long y = 0;
    Long z = 0;
};

LongPoint at(const ObjectRay& ray, Long t) {
    return {ray.origin.x + t * ray.direction.x, ray.origin.y + t * ray.direction.y,
            ray.origin.z + t * ray.direction.z};
}

Long dot(const LongPoint& p, const glm::dvec3& v) {
    return p.x * v.x + p.y * v.y + p.z * v.z;
}

LongPoint minus(const LongPoint& p, const glm::dvec3& v) {
    return {p.x - v.x, p.y - v.y, p.z - v.z};
}

// Distance along and from an axis through `point`.
struct AxisPlace {
    Long height = 0;
    Long distance = 0;
};

AxisPlace place_on_axis(const LongPoint& p, const glm::dvec3& point, const glm::dvec3& axis) {
    const LongPoint q = minus(p, point);
    const Long length =
        std::sqrt(Long{axis.x} * axis.x + Long{axis.y} * axis.y + Long{axis.z} * axis.z);
    const Long height = dot(q, axis) / length;
    const LongPoint across{q.x - height * axis.x / length, q.y - height * axis.y / length,
                           q.z - height * axis.z / length};
    return {height, std::sqrt(across.x * across.x + across.y * across.y + across.z * across.z)};
}

// How far beyond the surface of the solid, not exactly but with the right sign.
Long beyond(const Torus& torus, const LongPoint& p) {
    const AxisPlace place = place_on_axis(p, torus.centre, torus.axis);
    return std::hypot(place.distance - torus.major_radius, place.height) - torus.minor_radius;
}

Long beyond(const Cone& cone, const LongPoint& p) {
    const glm::dvec3 axis = cone.apex - cone.base;
    const AxisPlace place = place_on_axis(p, cone.base, axis);
    const Long length =
        std::sqrt(Long{axis.x} * axis.x + Long{axis.y} * axis.y + Long{axis.z} * axis.z);
    const Long radius =
        cone.base_radius + place.height / length * (Long{cone.apex_radius} - cone.base_radius);
    return std::max({place.distance - radius, -place.height, place.height - length});
}

// Where the ray crosses the solid's surface between two places. Crossings that lie within a sample
// step of each other may go unseen: callers then see their hits unmatched, not the other way round.
template <typename Solid>
std::vector<Long> crossings(const Solid& solid, const ObjectRay& ray, Long from, Long to) {
    constexpr int kSamples = 1500;
    std::vector<Long> found;
    Long last_t = from;
    bool last_inside = beyond(solid, at(ray, from)) <= 0;
    for (int i = 1; i <= kSamples; ++i) {
        const Long t = from + (to - from) * i / kSamples;
        const bool inside = beyond(solid, at(ray, t)) <= 0;
        if (inside != last_inside) {
            Long low = last_t;
            Long high = t;
            for (int step = 0; step < 70; ++step) {
                const Long middle = (low + high) / 2;
                ((beyond(solid, at(ray, middle)) <= 0) == last_inside ? low : high) = middle;
            }
            found.push_back((low + high) / 2);
        }
        last_t = t;
        last_inside = inside;
    }
    return found;
}

// Rays around a body of this size: from outside, inside, far away, and parallel to an axis.
ObjectRay ray_around(Random& random, const glm::dvec3& centre, double size, int kind) {
    const glm::dvec3 target = centre + size * random.unit() * random.direction();
    const double away = kind % 4 == 0 ? 0.5 : (kind % 4 == 1 ? 1e3 : 3.0);
    const glm::dvec3 origin = centre + away * size * random.direction();
    glm::dvec3 direction = random.between(0.2, 5.0) * glm::normalize(target - origin);
    if (kind % 4 == 3) {
        direction = glm::dvec3(0.0);
        direction[static_cast<int>(random.below(3))] = random.unit() < 0.5 ? 1.0 : -1.0;
    }
    return {glm::dvec3(glm::vec3(origin)), glm::dvec3(glm::vec3(direction))};
}

struct Tally {
    int rays = 0;
    int crossings = 0;
    int close_pairs = 0;  // two hits within a sample step that sampling can't tell apart
};

// Every crossing that sampling sees is a hit, at the same t; a hit that it doesn't see lies on the
// surface all the same, and is one of a pair.
template <typename Solid>
void compare(const Solid& solid, const glm::dvec3& centre, double size, const ObjectRay& ray,
             Tally& tally) {
    const double length = glm::length(ray.direction);
    const double middle = glm::dot(centre - ray.origin, ray.direction) / (length * length);
    const double half = 1.7 * size / length;
    const std::vector<Long> expected = crossings(solid, ray, middle - half, middle + half);
    const ShapeHits hits = intersect(solid, ray);
    const double distance = glm::length(ray.origin - centre) + glm::length(centre) + size;
    ++tally.rays;
    tally.crossings += static_cast<int>(expected.size());
    ASSERT_GE(hits.count, static_cast<int>(expected.size()));
    ASSERT_EQ((hits.count - static_cast<int>(expected.size())) % 2, 0);
    std::size_t next = 0;
    for (int i = 0; i < hits.count; ++i) {
        const ShapeHit& hit = hits.hit[static_cast<std::size_t>(i)];
        if (i > 0) {
            ASSERT_LE(hits.hit[static_cast<std::size_t>(i - 1)].t, hit.t);
        }
        const auto off = static_cast<double>(beyond(solid, at(ray, hit.t)));
        ASSERT_NEAR(off, 0.0, 4e-15 * distance + 1e-14 * size) << "hit " << i;
        const auto gap = next < expected.size()
                             ? std::abs(hit.t - static_cast<double>(expected[next])) * length
                             : std::numeric_limits<double>::infinity();
        // Grazing rays cross slowly: the place is uncertain by the root of the precision.
        const glm::dvec3 normal = glm::normalize(hit.normal);
        const double slope = std::abs(glm::dot(normal, ray.direction)) / length;
        if (gap <= 1e-14 * distance / std::max(slope * slope, 1e-7) + 1e-9 * size) ++next;
    }
    ASSERT_EQ(next, expected.size()) << "crossings without a hit";
    tally.close_pairs += (hits.count - static_cast<int>(expected.size())) / 2;
}

Torus random_torus(Random& random, double scale) {
    Torus torus;
    torus.centre = 3.0 * scale * random.direction();
    torus.axis = random.between(0.1, 4.0) * random.direction();
    torus.major_radius = scale * random.between(0.5, 2.0);
    torus.minor_radius = torus.major_radius * std::pow(10.0, random.between(-2.0, 0.0));
    return torus;
}

Cone random_cone(Random& random, double scale, int kind) {
    Cone cone;
    cone.base = 3.0 * scale * random.direction();
    cone.apex = cone.base + scale * std::pow(10.0, random.between(-1.5, 0.3)) * random.direction();
    cone.base_radius = scale * random.between(0.02, 1.0);
    cone.apex_radius = scale * random.between(0.02, 1.0);
    if (kind % 4 == 1) cone.apex_radius = cone.base_radius;
    if (kind % 4 == 2) cone.apex_radius = 0.0;
    if (kind % 4 == 3) cone.base_radius = 0.0;
    return cone;
}

TEST(TorusShape, EqualsDenseSamplingInLongDouble) {
    Tally tally;
    for (const double scale : kScales) {
        Random random(21);
        for (int i = 0; i < 400; ++i) {
            SCOPED_TRACE(testing::Message() << "scale " << scale << " case " << i);
            const Torus torus = random_torus(random, scale);
            const double size = torus.major_radius + torus.minor_radius;
            compare(torus, torus.centre, size, ray_around(random, torus.centre, size, i), tally);
            if (HasFatalFailure()) return;
        }
    }
    EXPECT_GT(tally.crossings, tally.rays / 2);
    EXPECT_LT(tally.close_pairs, tally.rays / 100);
}

TEST(ConeShape, EqualsDenseSamplingInLongDouble) {
    Tally tally;
    for (const double scale : kScales) {
        Random random(22);
        for (int i = 0; i < 400; ++i) {
            SCOPED_TRACE(testing::Message() << "scale " << scale << " case " << i);
            const Cone cone = random_cone(random, scale, i / 4);
            const glm::dvec3 centre = 0.5 * (cone.base + cone.apex);
            const double size = 0.5 * glm::length(cone.apex - cone.base) +
                                std::max(cone.base_radius, cone.apex_radius);
            compare(cone, centre, size, ray_around(random, centre, size, i), tally);
            if (HasFatalFailure()) return;
        }
    }
    EXPECT_GT(tally.crossings, tally.rays / 2);
    EXPECT_LT(tally.close_pairs, tally.rays / 50);
}

TEST(ConeShape, OpenConesHaveTheSideOnly) {
    Random random(23);
    int sides = 0;
    for (int i = 0; i < 4000; ++i) {
        SCOPED_TRACE(i);
        Cone cone = random_cone(random, 1.0, i);
        const ObjectRay ray = ray_around(random, 0.5 * (cone.base + cone.apex), 1.5, i);
        const ShapeHits capped = intersect(cone, ray);
        cone.capped = false;
        const ShapeHits open = intersect(cone, ray);
        int next = 0;
        for (int k = 0; k < capped.count; ++k) {
            const ShapeHit& hit = capped.hit[static_cast<std::size_t>(k)];
            if (hit.primitive != 0) continue;
            ASSERT_LT(next, open.count);
            EXPECT_EQ(open.hit[static_cast<std::size_t>(next++)].t, hit.t);
        }
        EXPECT_EQ(next, open.count);
        sides += next;
    }
    EXPECT_GT(sides, 1000);
}

TEST(ConeShape, CapsAreCounted) {
    const Cone cone{{0, 0, 0}, {0, 2, 0}, 1.0, 0.5};
    const ShapeHits down = intersect(cone, {{0.25, 5, 0}, {0, -1, 0}});
    ASSERT_EQ(down.count, 2);
    EXPECT_EQ(down.hit[0].primitive, 2u);
    EXPECT_DOUBLE_EQ(down.hit[0].t, 3.0);
    EXPECT_DOUBLE_EQ(down.hit[0].uv.x, 0.0);
    EXPECT_DOUBLE_EQ(down.hit[0].uv.y, 0.5);
    EXPECT_EQ(down.hit[1].primitive, 1u);
    EXPECT_DOUBLE_EQ(down.hit[1].t, 5.0);
    EXPECT_DOUBLE_EQ(down.hit[1].uv.y, 0.25);
    const ShapeHits across = intersect(cone, {{0, 1, 5}, {0, 0, -1}});
    ASSERT_EQ(across.count, 2);
    EXPECT_EQ(across.hit[0].primitive, 0u);
    EXPECT_DOUBLE_EQ(across.hit[0].t, 4.25);
    EXPECT_DOUBLE_EQ(across.hit[0].uv.x, 0.25);
    EXPECT_DOUBLE_EQ(across.hit[0].uv.y, 0.5);
    EXPECT_DOUBLE_EQ(across.hit[1].t, 5.75);
}

TEST(TorusShape, FourHitsByHand) {
    const Torus torus{{0, 0, 0}, {0, 1, 0}, 2.0, 0.5};
    const ShapeHits hits = intersect(torus, {{10, 0, 0}, {-1, 0, 0}});
    ASSERT_EQ(hits.count, 4);
    const std::array<double, 4> expected{7.5, 8.5, 11.5, 12.5};
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(hits.hit[i].t, expected[i], 1e-14);
    EXPECT_NEAR(hits.hit[0].uv.x, 0.0, 1e-15);
    EXPECT_NEAR(hits.hit[0].uv.y, 0.0, 1e-15);
    EXPECT_NEAR(hits.hit[1].uv.y, 0.5, 1e-15);
    EXPECT_EQ(intersect(torus, {{0, 5, 0}, {0, -1, 0}}).count, 0) << "through the hole";
}

TEST(TorusShape, GrazingRaysMeetItJustInside) {
    const Torus torus{{0, 0, 0}, {0, 1, 0}, 1.0, 0.25};
    for (const double depth : {1e-4, 1e-8, 1e-12}) {
        SCOPED_TRACE(depth);
        // Over the top of the ring, and along its outermost circle.
        EXPECT_EQ(intersect(torus, {{1, 0.25 - depth, 9}, {0, 0, -1}}).count, 2);
        EXPECT_EQ(intersect(torus, {{1, 0.25 + depth, 9}, {0, 0, -1}}).count, 0);
        EXPECT_EQ(intersect(torus, {{1.25 - depth, 0, 9}, {0, 0, -1}}).count, 2);
        EXPECT_EQ(intersect(torus, {{1.25 + depth, 0, 9}, {0, 0, -1}}).count, 0);
        // Between the walls of the hole.
        EXPECT_EQ(intersect(torus, {{0.75 - depth, -9, 0}, {0, 1, 0}}).count, 0);
        EXPECT_EQ(intersect(torus, {{0.75 + depth, -9, 0}, {0, 1, 0}}).count, 2);
    }
}

TEST(DiskShape, HasAHoleAndARim) {
    const Disk disk{{1, 2, 3}, {0, 5, 0}, 2.0, 0.5};
    const auto count = [&](double x) { return intersect(disk, {{1 + x, 7, 3}, {0, -1, 0}}).count; };
    EXPECT_EQ(count(0.0), 0);
    EXPECT_EQ(count(0.499), 0);
    EXPECT_EQ(count(0.501), 1);
    EXPECT_EQ(count(1.999), 1);
    EXPECT_EQ(count(2.001), 0);
    const ShapeHits hits = intersect(disk, {{1, 7, 4}, {0, -2, 0}});
    ASSERT_EQ(hits.count, 1);
    EXPECT_DOUBLE_EQ(hits.hit[0].t, 2.5);
    EXPECT_DOUBLE_EQ(hits.hit[0].uv.x, 0.25);
    EXPECT_DOUBLE_EQ(hits.hit[0].uv.y, 0.5);
    EXPECT_GT(hits.hit[0].normal.y, 0.0);
    EXPECT_EQ(intersect(disk, {{0, 2, 0}, {1, 0, 0}}).count, 0) << "within the plane";
}

TEST(RectangleShape, HitsHaveTheWeightsOfTheEdges) {
    for (const double scale : kScales) {
        Random random(24);
        for (int i = 0; i < 1000; ++i) {
            SCOPED_TRACE(testing::Message() << "scale " << scale << " case " << i);
            const Rectangle rectangle{scale * random.direction(), scale * random.direction(),
                                      scale * random.between(0.1, 3.0) * random.direction()};
            const glm::dvec2 weights{random.between(-0.5, 1.5), random.between(-0.5, 1.5)};
            const glm::dvec3 target =
                rectangle.corner + weights.x * rectangle.edge_u + weights.y * rectangle.edge_v;
            const glm::dvec3 origin = target + 3.0 * scale * random.direction();
            const ShapeHits hits = intersect(rectangle, {origin, target - origin});
            const bool inside =
                weights.x >= 0.0 && weights.x <= 1.0 && weights.y >= 0.0 && weights.y <= 1.0;
            ASSERT_EQ(hits.count, inside ? 1 : 0);
            if (!inside) continue;
            EXPECT_NEAR(hits.hit[0].t, 1.0, 1e-9);
            EXPECT_NEAR(hits.hit[0].uv.x, weights.x, 1e-9);
            EXPECT_NEAR(hits.hit[0].uv.y, weights.y, 1e-9);
        }
    }
}

TEST(RectangleShape, NoRaySlipsThroughASharedEdge) {
    Random random(25);
    for (int i = 0; i < 20000; ++i) {
        SCOPED_TRACE(i);
        const Rectangle left{{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        const Rectangle right{{0, 0, 0}, {1, 0, 0.5}, {0, 1, 0}};
        const glm::dvec3 on_edge{0, random.between(0.01, 0.99), 0};
        const Ray aimed = ray_towards(glm::vec3(on_edge + 3.0 * random.direction()), on_edge);
        const ObjectRay ray{glm::dvec3(aimed.origin), glm::dvec3(aimed.direction)};
        if (std::abs(ray.direction.z) < 0.6) continue;  // must cross both planes the same way
        EXPECT_GE(intersect(left, ray).count + intersect(right, ray).count, 1);
    }
}

// Rays that pass the edge by as little as rounding does, with corners that both have to the bit.
TEST(RectangleShape, NoRaySlipsBetweenItAndATriangle) {
    int tested = 0;
    for (std::uint64_t seed = 0; seed < 100000; ++seed) {
        Random random(seed);
        const auto on_grid = [&](int from, int to) {
            return from + static_cast<int>(random.below(static_cast<std::uint64_t>(to - from)));
        };
        const glm::dvec3 a(on_grid(-9, 9), on_grid(-9, 9), on_grid(-9, 0));
        const glm::dvec3 b = a + glm::dvec3(on_grid(1, 9), on_grid(-3, 4), on_grid(-3, 4));
        const glm::dvec3 down(on_grid(-3, 4), on_grid(-9, 0), on_grid(-3, 4));
        const glm::dvec3 up = a + glm::dvec3(on_grid(-3, 9), on_grid(1, 9), on_grid(-3, 4));
        const glm::dvec3 on_edge = a + random.between(0.01, 0.99) * (b - a);
        const glm::dvec3 from = on_edge + glm::dvec3(on_grid(-4, 5), on_grid(-4, 5), 9);
        const ObjectRay ray{from, on_edge - from};
        const auto height = [&](const glm::dvec3& p) {  // across what ray and edge lie in
            return glm::dot(glm::cross(b - a, ray.direction), p - a);
        };
        // Else both lie on one side of that.
        if (height(a + down) * height(up) > -1.0) continue;
        ++tested;
        EXPECT_GE(intersect(Rectangle{a, b - a, down}, ray).count +
                      intersect(Triangle{a, b, up}, ray).count,
                  1)
            << seed;
    }
    EXPECT_GT(tested, 50000);
}

template <typename AnyShape>
void expect_no_hit_of_nan(const AnyShape& shape) {
    for (int axis = 0; axis < 3; ++axis) {
        ObjectRay ray{{0, 0.1, 5}, {0, 0, -1}};
        ray.origin[axis] = kNaN;
        EXPECT_EQ(intersect(shape, ray).count, 0);
        ray = {{0, 0.1, 5}, {0, 0, -1}};
        ray.direction[axis] = kNaN;
        EXPECT_EQ(intersect(shape, ray).count, 0);
    }
    EXPECT_EQ(intersect(shape, ObjectRay{{0, 0.1, 5}, {0, 0, 0}}).count, 0) << "no direction";
}

TEST(CurvedShapes, NaNMisses) {
    expect_no_hit_of_nan(Disk{{0, 0, 0}, {0, 0, 1}});
    expect_no_hit_of_nan(Rectangle{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}});
    expect_no_hit_of_nan(Cone{});
    expect_no_hit_of_nan(Torus{});
}

}  // namespace
}  // namespace raypick
