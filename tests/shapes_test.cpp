#include "tracer/geometry/shapes.h"

#include "tests/random.h"
#include "tests/tracer_scenes.h"
#include "tracer/error.h"
#include "tracer/geometry/triangle_test.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace raypick {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array<double, 5> kScales{1e-4, 1e-2, 1.0, 1e3, 1e6};

void expect_near(const glm::dvec3& got, const glm::dvec3& wanted, double tolerance) {
    EXPECT_NEAR(got.x, wanted.x, tolerance);
    EXPECT_NEAR(got.y, wanted.y, tolerance);
    EXPECT_NEAR(got.z, wanted.z, tolerance);
}

// The hits in front of the origin.
template <typename S>
std::vector<ShapeHit> ahead(const S& shape, const ObjectRay& ray) {
    const ShapeHits hits = intersect(shape, ray);
    EXPECT_GE(hits.count, 0);
    EXPECT_LE(hits.count, 2);
    if (hits.count == 2) {
        EXPECT_LE(hits.hit[0].t, hits.hit[1].t) << "nearest first";
    }
    std::vector<ShapeHit> found;
    for (int i = 0; i < hits.count; ++i) {
        EXPECT_FALSE(std::isnan(hits.hit[static_cast<std::size_t>(i)].t));
        if (hits.hit[static_cast<std::size_t>(i)].t > 0.0) found.push_back(hits.hit[i]);
    }
    return found;
}

bool front(const ShapeHit& hit, const ObjectRay& ray) {
    return glm::dot(hit.normal, ray.direction) < 0.0;
}

// --- sphere -------------------------------------------------------------------------------------

TEST(SphereShape, ThroughTheCentre) {
    for (const double s : kScales) {
        SCOPED_TRACE(s);
        const Sphere sphere{{s, 2 * s, 3 * s}, s};
        const ObjectRay ray{{s, 2 * s, 13 * s}, {0, 0, -1}};
        const auto hits = ahead(sphere, ray);
        ASSERT_EQ(hits.size(), 2u);
        EXPECT_NEAR(hits[0].t, 9 * s, 1e-14 * s);
        EXPECT_NEAR(hits[1].t, 11 * s, 1e-14 * s);
        expect_near(glm::normalize(hits[0].normal), {0, 0, 1}, 1e-12);
        expect_near(glm::normalize(hits[1].normal), {0, 0, -1}, 1e-12);
        EXPECT_TRUE(front(hits[0], ray));
        EXPECT_FALSE(front(hits[1], ray));
        EXPECT_EQ(hits[0].primitive, 0u);
    }
}

TEST(SphereShape, FromInsideThereIsOneHitOnTheInside) {
    const ObjectRay ray{{0.5, 0, 0}, {1, 0, 0}};
    const auto hits = ahead(Sphere{}, ray);
    ASSERT_EQ(hits.size(), 1u);
    EXPECT_NEAR(hits[0].t, 0.5, 1e-15);
    expect_near(glm::normalize(hits[0].normal), {1, 0, 0}, 1e-12);
    EXPECT_FALSE(front(hits[0], ray));
}

TEST(SphereShape, DirectionsNeedNoUnitLength) {
    const auto hits = ahead(Sphere{}, {{0, 0, 5}, {0, 0, -4}});
    ASSERT_EQ(hits.size(), 2u);
    EXPECT_NEAR(hits[0].t, 1.0, 1e-15);
    EXPECT_NEAR(hits[1].t, 1.5, 1e-15);
}

TEST(SphereShape, BesideAndBehindIsAMiss) {
    EXPECT_TRUE(ahead(Sphere{}, {{0, 1.0000001, 5}, {0, 0, -1}}).empty());
    EXPECT_TRUE(ahead(Sphere{}, {{0, 0, 5}, {0, 0, 1}}).empty());
    EXPECT_TRUE(ahead(Sphere{}, {{0, 0, 5}, {0, 0, 0}}).empty());
}

TEST(SphereShape, GrazingHitsJustInside) {
    const double depth = 1e-8;
    const auto hits = ahead(Sphere{}, {{0, 1.0 - depth, 5}, {0, 0, -1}});
    ASSERT_EQ(hits.size(), 2u);
    // Half the chord: sqrt(1 - (1 - depth)^2).
    const double half = std::sqrt(depth * (2.0 - depth));
    EXPECT_NEAR(hits[0].t, 5.0 - half, 1e-9);
    EXPECT_NEAR(hits[1].t, 5.0 + half, 1e-9);
}

TEST(SphereShape, FarAwayKeepsItsPrecision) {
    Random random(7);
    for (int i = 0; i < 1000; ++i) {
        SCOPED_TRACE(i);
        const glm::dvec3 away = random.direction();
        const glm::dvec3 side = glm::normalize(glm::cross(away, random.direction()));
        const double offset = random.between(-0.99, 0.99);
        const double distance = 1e6;
        const ObjectRay ray{distance * away + offset * side, -away};
        const auto hits = ahead(Sphere{}, ray);
        ASSERT_EQ(hits.size(), 2u);
        EXPECT_NEAR(hits[0].t, distance - std::sqrt(1.0 - offset * offset), 1e-8);
        EXPECT_NEAR(hits[1].t, distance + std::sqrt(1.0 - offset * offset), 1e-8);
    }
}

TEST(SphereShape, HitsLieOnTheSphere) {
    for (const double s : kScales) {
        Random random(11);
        for (int i = 0; i < 1000; ++i) {
            SCOPED_TRACE(i);
            const Sphere sphere{s * 5.0 * random.direction(), s * random.between(0.1, 2.0)};
            const glm::dvec3 target = sphere.centre + 0.99 * sphere.radius * random.direction();
            const glm::dvec3 origin = sphere.centre + 20.0 * s * random.direction();
            const ObjectRay ray{origin, random.between(0.1, 9.0) * (target - origin)};
            const auto hits = ahead(sphere, ray);
            ASSERT_EQ(hits.size(), 2u);
            for (const ShapeHit& hit : hits) {
                const glm::dvec3 p = ray.origin + hit.t * ray.direction;
                EXPECT_NEAR(glm::distance(p, sphere.centre), sphere.radius, 1e-12 * s);
                expect_near(glm::normalize(hit.normal), glm::normalize(p - sphere.centre), 1e-10);
                EXPECT_GE(hit.uv.x, 0.0);
                EXPECT_LE(hit.uv.x, 1.0);
                EXPECT_GE(hit.uv.y, 0.0);
                EXPECT_LE(hit.uv.y, 1.0);
            }
        }
    }
}

TEST(SphereShape, ColatitudeRunsFromPoleToPole) {
    // Whichever axis the poles are on: they stand at 0 and 1, the equator at a half.
    int poles = 0;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 up(0.0);
        up[axis] = 1.0;
        const double top = ahead(Sphere{}, {3.0 * up, -up}).at(0).uv.y;
        const double bottom = ahead(Sphere{}, {-3.0 * up, up}).at(0).uv.y;
        if (std::abs(top - 0.5) < 1e-9) {
            EXPECT_NEAR(bottom, 0.5, 1e-9);
        } else {
            ++poles;
            EXPECT_NEAR(top, 0.0, 1e-7);
            EXPECT_NEAR(bottom, 1.0, 1e-7);
        }
    }
    EXPECT_EQ(poles, 1);
}

// --- plane --------------------------------------------------------------------------------------

TEST(PlaneShape, TheConstantCounts) {
    // 2x + 3y + 6z + 14 = 0 from (1, 1, 1) along -z: 2 + 3 + 6(1 - t) + 14 = 0, t = 25/6. The
    // notes' formula without d would give 11/6.
    const ObjectRay ray{{1, 1, 1}, {0, 0, -1}};
    const auto hits = ahead(Plane{{2, 3, 6}, 14}, ray);
    ASSERT_EQ(hits.size(), 1u);
    EXPECT_NEAR(hits[0].t, 25.0 / 6.0, 1e-14);
    expect_near(glm::normalize(hits[0].normal), glm::dvec3(2, 3, 6) / 7.0, 1e-14);
    EXPECT_TRUE(front(hits[0], ray));
}

TEST(PlaneShape, FromBelowItIsTheInside) {
    const ObjectRay ray{{0, -2, 0}, {0.6, 0.8, 0}};
    const auto hits = ahead(Plane{{0, 1, 0}, -3}, ray);
    ASSERT_EQ(hits.size(), 1u);
    EXPECT_NEAR(hits[0].t, 5.0 / 0.8, 1e-14);
    EXPECT_FALSE(front(hits[0], ray));
}

TEST(PlaneShape, ParallelAndAwayIsAMiss) {
    EXPECT_TRUE(ahead(Plane{}, {{0, 1, 0}, {1, 0, 0}}).empty());
    EXPECT_TRUE(ahead(Plane{}, {{0, 0, 0}, {1, 0, 0}}).empty()) << "within the plane";
    EXPECT_TRUE(ahead(Plane{}, {{0, 1, 0}, {0, 1, 0}}).empty());
    EXPECT_TRUE(ahead(Plane{}, {{0, 1, 0}, {0, 0, 0}}).empty());
}

TEST(PlaneShape, UvAreTheFreeCoordinates) {
    const auto hits = ahead(Plane{{0, 1, 0}, 0}, {{3, 4, 7}, {0, -1, 0}});
    ASSERT_EQ(hits.size(), 1u);
    EXPECT_NEAR(hits[0].uv.x, 3.0, 1e-14);
    EXPECT_NEAR(hits[0].uv.y, 7.0, 1e-14);
}

TEST(PlaneShape, HugeAndTinyDistances) {
    for (const double s : kScales) {
        SCOPED_TRACE(s);
        const auto hits = ahead(Plane{{0, 0, 1}, s}, {{0, 0, 0}, {0, 0, -1}});
        ASSERT_EQ(hits.size(), 1u);
        EXPECT_DOUBLE_EQ(hits[0].t, s);
    }
}

// --- triangle -----------------------------------------------------------------------------------

TEST(TriangleShape, ByHand) {
    const ObjectRay ray{{0.25, 0.5, 3}, {0, 0, -1}};
    const auto hits = ahead(Triangle{}, ray);
    ASSERT_EQ(hits.size(), 1u);
    EXPECT_NEAR(hits[0].t, 3.0, 1e-15);
    EXPECT_NEAR(hits[0].uv.x, 0.25, 1e-15);  // weight of b
    EXPECT_NEAR(hits[0].uv.y, 0.5, 1e-15);   // weight of c
    expect_near(glm::normalize(hits[0].normal), {0, 0, 1}, 1e-15);
    EXPECT_TRUE(front(hits[0], ray));
    const ObjectRay behind{{0.25, 0.5, -3}, {0, 0, 1}};
    const auto back = ahead(Triangle{}, behind);
    ASSERT_EQ(back.size(), 1u);
    EXPECT_FALSE(front(back[0], behind));
    expect_near(glm::normalize(back[0].normal), {0, 0, 1}, 1e-15);
}

TEST(TriangleShape, MissesBesideParallelAndBehind) {
    EXPECT_TRUE(ahead(Triangle{}, {{0.6, 0.6, 3}, {0, 0, -1}}).empty());
    EXPECT_TRUE(ahead(Triangle{}, {{-0.1, 0.5, 3}, {0, 0, -1}}).empty());
    EXPECT_TRUE(ahead(Triangle{}, {{0.25, 0.25, 3}, {0, 0, 1}}).empty());
    EXPECT_TRUE(ahead(Triangle{}, {{-1, 0.25, 0}, {1, 0, 0}}).empty()) << "within its plane";
    EXPECT_TRUE(ahead(Triangle{}, {{-1, 0.25, 1}, {1, 0, 0}}).empty()) << "parallel above it";
    EXPECT_TRUE(ahead(Triangle{}, {{0.25, 0.25, 3}, {0, 0, 0}}).empty());
}

TEST(TriangleShape, DegenerateOnesAreNeverHit) {
    const ObjectRay ray{{0.5, 0.0, 3}, {0, 0, -1}};
    EXPECT_TRUE(ahead(Triangle{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}}, ray).empty());
    EXPECT_TRUE(ahead(Triangle{{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}}, ray).empty());
    EXPECT_TRUE(ahead(Triangle{{0.5, 0, 0}, {0.5, 0, 0}, {0.5, 0, 0}}, ray).empty());
    EXPECT_TRUE(ahead(Triangle{{0, 0, kNaN}, {1, 0, 0}, {0, 1, 0}}, ray).empty());
}

// Exactly collinear corners, in every direction and order, and rays aimed at the line they lie on.
TEST(TriangleShape, CollinearCornersAreNeverHit) {
    int hits = 0;
    for (std::uint64_t seed = 0; seed < 100000; ++seed) {
        Random random(seed);
        // Corners on a grid, so that the third lies on the line of the first two to the last bit.
        const auto on_grid = [&] {
            return glm::dvec3(random.below(1000), random.below(1000), random.below(1000)) / 64.0;
        };
        const glm::dvec3 a = on_grid();
        const glm::dvec3 step = on_grid() - a;
        const glm::dvec3 b = a + step;
        const glm::dvec3 c = a + (seed % 2 == 0 ? 2.0 : 0.5) * step;
        const glm::dvec3 target = a + random.unit() * (b - a);
        const Ray ray = ray_towards(glm::vec3(target + 20.0 * random.direction()), target);
        const ObjectRay object_ray{glm::dvec3(ray.origin), glm::dvec3(ray.direction)};
        hits += intersect(Triangle{a, b, c}, object_ray).count;
        hits += intersect(Triangle{c, a, b}, object_ray).count;
        const ObjectRay exact{target + 20.0 * random.direction(), glm::dvec3(0.0)};
        hits += intersect(Triangle{b, a, c}, {exact.origin, target - exact.origin}).count;
    }
    EXPECT_EQ(hits, 0);
}

TEST(TriangleShape, RandomHitsLieOnTheTriangle) {
    for (const double s : kScales) {
        Random random(23);
        for (int i = 0; i < 2000; ++i) {
            SCOPED_TRACE(i);
            const glm::dvec3 o = 4.0 * s * random.direction();
            const Triangle t{o, o + s * random.direction(), o + s * random.direction()};
            double u = random.unit();
            double v = random.unit();
            if (u + v > 1.0) {
                u = 1.0 - u;
                v = 1.0 - v;
            }
            if (u < 1e-3 || v < 1e-3 || u + v > 0.999) continue;
            const glm::dvec3 cross = glm::cross(t.b - t.a, t.c - t.a);
            const glm::dvec3 target = (1 - u - v) * t.a + u * t.b + v * t.c;
            const glm::dvec3 origin = target + 10.0 * s * random.direction();
            const glm::dvec3 direction = glm::normalize(target - origin);
            if (glm::length(cross) < 1e-2 * s * s) continue;
            if (std::abs(glm::dot(glm::normalize(cross), direction)) < 1e-2) continue;
            const auto hits = ahead(t, {origin, direction});
            ASSERT_EQ(hits.size(), 1u);
            EXPECT_NEAR(hits[0].t, 10.0 * s, 1e-9 * s);
            EXPECT_NEAR(hits[0].uv.x, u, 1e-9);
            EXPECT_NEAR(hits[0].uv.y, v, 1e-9);
            expect_near(glm::normalize(hits[0].normal), glm::normalize(cross), 1e-9);
        }
    }
}

// Where two terms are of one magnitude and the third is lost in either, too.
TEST(TriangleShape, SumsAreTheSameInAnyOrder) {
    for (const double small : {0x1p-54, 0x1.8p-54, 0x1p-53, 0.0, 1.0, 2.0}) {
        std::array<double, 3> terms{-1.0, small, 1.0};
        std::sort(terms.begin(), terms.end());
        const double sum = symmetric_sum(terms[0], terms[1], terms[2]);
        EXPECT_NEAR(sum, small, 0x1p-53);
        do {
            EXPECT_EQ(symmetric_sum(terms[0], terms[1], terms[2]), sum);
            EXPECT_EQ(symmetric_sum(-terms[0], -terms[1], -terms[2]), -sum);
        } while (std::next_permutation(terms.begin(), terms.end()));
    }
}

TEST(TriangleShape, VertexOrderAndWindingChangeNothing) {
    std::array<int, 3> order{0, 1, 2};
    int tested = 0;
    for (std::uint64_t seed = 0; seed < 20000; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        std::array<glm::dvec3, 3> p;
        for (glm::dvec3& corner : p)
            corner = glm::dvec3(glm::vec3(random.direction()));
        const glm::dvec3 origin(glm::vec3(3.0 * random.direction()));
        // Half of the rays run exactly through an edge or a corner.
        const double u = random.unit() < 0.5 ? random.unit() : 0.0;
        const double v = random.unit() < 0.5 ? random.unit() * (1 - u) : 0.0;
        const glm::dvec3 target = (1 - u - v) * p[0] + u * p[1] + v * p[2];
        const ObjectRay ray{origin, glm::dvec3(glm::vec3(glm::normalize(target - origin)))};
        const ShapeHits first = intersect(Triangle{p[0], p[1], p[2]}, ray);
        order = {0, 1, 2};
        while (std::next_permutation(order.begin(), order.end())) {
            const ShapeHits other = intersect(Triangle{p[static_cast<std::size_t>(order[0])],
                                                       p[static_cast<std::size_t>(order[1])],
                                                       p[static_cast<std::size_t>(order[2])]},
                                              ray);
            ASSERT_EQ(other.count, first.count);
            if (first.count == 0) continue;
            ASSERT_EQ(other.hit[0].t, first.hit[0].t) << "to the last bit";
            ++tested;
        }
    }
    EXPECT_GT(tested, 20000);
}

// Two triangles on either side of an edge, folded by any angle but flat away from the ray: a ray
// through the edge meets at least one of them.
TEST(TriangleShape, NoRaySlipsThroughASharedEdge) {
    int slipped = 0;
    int both = 0;
    for (std::uint64_t seed = 0; seed < 100000; ++seed) {
        Random random(seed);
        const double scale = kScales[seed % kScales.size()];
        const glm::dvec3 shift = 10.0 * scale * random.direction();
        const auto vertex = [&](const glm::dvec3& p) {
            return glm::dvec3(glm::vec3(shift + scale * p));
        };
        const glm::dvec3 a = vertex({0, random.between(-1, 0), random.between(-0.3, 0.3)});
        const glm::dvec3 b = vertex({0, random.between(0.1, 1), random.between(-0.3, 0.3)});
        const glm::dvec3 left =
            vertex({random.between(-1, -0.1), random.between(-1, 1), random.between(-0.3, 0.3)});
        const glm::dvec3 right =
            vertex({random.between(0.1, 1), random.between(-1, 1), random.between(-0.3, 0.3)});
        // Clearly in front, so that the edge is no silhouette.
        const glm::dvec3 origin = vertex({random.between(-0.2, 0.2), random.between(-1, 1), 8.0});
        const double along = seed % 10 == 0 ? 0.5 : random.unit();
        const glm::dvec3 target = a + along * (b - a);
        const ObjectRay ray{origin, target - origin};
        const int hits = intersect(Triangle{a, b, left}, ray).count +
                         intersect(Triangle{b, a, right}, ray).count;
        slipped += hits == 0 ? 1 : 0;
        both += hits == 2 ? 1 : 0;
    }
    EXPECT_EQ(slipped, 0);
    RecordProperty("met_both", both);
}

TEST(TriangleShape, NoRaySlipsThroughASharedVertex) {
    int slipped = 0;
    for (std::uint64_t seed = 0; seed < 20000; ++seed) {
        Random random(seed);
        const double scale = kScales[seed % kScales.size()];
        const glm::dvec3 shift = 10.0 * scale * random.direction();
        const auto vertex = [&](double x, double y, double z) {
            return glm::dvec3(glm::vec3(shift + scale * glm::dvec3(x, y, z)));
        };
        const glm::dvec3 hub = vertex(random.between(-0.1, 0.1), random.between(-0.1, 0.1), 0);
        const int count = 3 + static_cast<int>(random.below(6));
        std::vector<glm::dvec3> rim;
        for (int i = 0; i < count; ++i) {
            const double angle = 2.0 * 3.141592653589793 * (i + random.between(0, 0.4)) / count;
            rim.push_back(vertex(std::cos(angle), std::sin(angle), random.between(-0.2, 0.2)));
        }
        const glm::dvec3 origin = vertex(random.between(-0.3, 0.3), random.between(-0.3, 0.3), 9);
        const ObjectRay ray{origin, hub - origin};
        int hits = 0;
        for (std::size_t i = 0; i < rim.size(); ++i) {
            hits += intersect(Triangle{hub, rim[i], rim[(i + 1) % rim.size()]}, ray).count;
        }
        slipped += hits == 0 ? 1 : 0;
    }
    EXPECT_EQ(slipped, 0);
}

// A slanted sheet of unit squares over [0, cells]^2 of the two axes after `axis`, each cut into two
// triangles; every start and, if `turned`, both windings occur.
std::vector<Triangle> slanted_sheet(int axis, int cells, bool turned) {
    const auto corner = [&](int i, int j) {
        glm::dvec3 p(0.0);
        p[(axis + 1) % 3] = i;
        p[(axis + 2) % 3] = j;
        p[axis] = 0.5 * i;
        return p;
    };
    std::vector<Triangle> sheet;
    for (int i = 0; i < cells; ++i) {
        for (int j = 0; j < cells; ++j) {
            const glm::dvec3 a = corner(i, j);
            const glm::dvec3 b = corner(i + 1, j);
            const glm::dvec3 c = corner(i + 1, j + 1);
            const glm::dvec3 d = corner(i, j + 1);
            const bool even = (i + j) % 2 == 0;
            sheet.push_back(even ? Triangle{a, b, c} : Triangle{b, c, d});
            if (turned) {
                sheet.push_back(even ? Triangle{d, c, a} : Triangle{a, d, b});
            } else {
                sheet.push_back(even ? Triangle{a, c, d} : Triangle{d, a, b});
            }
        }
    }
    return sheet;
}

// Rays that meet edges and vertices exactly, to the last bit: parallel to an axis, over all half
// and whole coordinates within the sheet.
int slipped_through(const std::vector<Triangle>& sheet, int axis, int cells, double side) {
    int slipped = 0;
    for (int i = 1; i < 2 * cells; ++i) {
        for (int j = 1; j < 2 * cells; ++j) {
            ObjectRay ray;
            ray.origin[(axis + 1) % 3] = 0.5 * i;
            ray.origin[(axis + 2) % 3] = 0.5 * j;
            ray.origin[axis] = 8.0 * side;
            ray.direction[axis] = -side;
            const bool met = std::any_of(sheet.begin(), sheet.end(), [&](const Triangle& t) {
                return intersect(t, ray).count > 0;
            });
            slipped += met ? 0 : 1;
        }
    }
    return slipped;
}

TEST(TriangleShape, NoRaySlipsThroughExactEdges) {
    constexpr int kCells = 4;
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool turned : {false, true}) {
            const std::vector<Triangle> sheet = slanted_sheet(axis, kCells, turned);
            EXPECT_EQ(slipped_through(sheet, axis, kCells, 1.0), 0) << axis << turned;
            EXPECT_EQ(slipped_through(sheet, axis, kCells, -1.0), 0) << axis << turned;
        }
    }
}

// Rays from inside a closed mesh, aimed at its edges and vertices, never get out.
TEST(TriangleShape, ClosedMeshHoldsItsRays) {
    for (const double scale : kScales) {
        SCOPED_TRACE(scale);
        const MeshData ball = ball_data(2);
        Random random(5);
        const glm::dvec3 shift(glm::vec3(20.0 * scale * random.direction()));
        std::vector<Triangle> triangles;
        for (const glm::uvec3& t : ball.triangles) {
            const auto corner = [&](std::uint32_t i) {
                return glm::dvec3(glm::vec3(shift + scale * glm::dvec3(ball.positions[i])));
            };
            triangles.push_back({corner(t.x), corner(t.y), corner(t.z)});
        }
        int escaped = 0;
        for (int i = 0; i < 20000; ++i) {
            const Triangle& at = triangles[random.below(triangles.size())];
            const double along = i % 3 == 0 ? 0.0 : random.unit();
            const glm::dvec3 target = at.a + along * (at.b - at.a);
            const glm::dvec3 origin = shift + 0.5 * scale * random.unit() * random.direction();
            // As a ray comes: float origin and direction.
            const Ray ray = ray_towards(glm::vec3(origin), target);
            const ObjectRay object_ray{glm::dvec3(ray.origin), glm::dvec3(ray.direction)};
            bool met = false;
            for (const Triangle& t : triangles) {
                const ShapeHits hits = intersect(t, object_ray);
                if (hits.count > 0 && hits.hit[0].t > 0.0) {
                    met = true;
                    break;
                }
            }
            escaped += met ? 0 : 1;
        }
        EXPECT_EQ(escaped, 0);
    }
}

// --- box ----------------------------------------------------------------------------------------

TEST(BoxShape, EachFaceByHand) {
    const Box box{{-1, -2, -3}, {1, 2, 3}};
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            SCOPED_TRACE(axis);
            SCOPED_TRACE(side);
            glm::dvec3 out(0.0);
            out[axis] = side;
            glm::dvec3 origin(0.3, 0.4, 0.5);
            origin[axis] = 10.0 * side;
            const ObjectRay ray{origin, -out};
            const auto hits = ahead(box, ray);
            ASSERT_EQ(hits.size(), 2u);
            EXPECT_NEAR(hits[0].t, 10.0 - (axis + 1.0), 1e-14);
            EXPECT_NEAR(hits[1].t, 10.0 + (axis + 1.0), 1e-14);
            const auto near_face = static_cast<std::uint32_t>(2 * axis + (side > 0 ? 1 : 0));
            EXPECT_EQ(hits[0].primitive, near_face);
            EXPECT_EQ(hits[1].primitive, near_face ^ 1u);
            expect_near(glm::normalize(hits[0].normal), out, 1e-15);
            expect_near(glm::normalize(hits[1].normal), -out, 1e-15);
            EXPECT_TRUE(front(hits[0], ray));
            EXPECT_FALSE(front(hits[1], ray));
            for (const ShapeHit& hit : hits) {
                EXPECT_GE(hit.uv.x, 0.0);
                EXPECT_LE(hit.uv.x, 1.0);
                EXPECT_GE(hit.uv.y, 0.0);
                EXPECT_LE(hit.uv.y, 1.0);
            }
        }
    }
}

TEST(BoxShape, FromInside) {
    const ObjectRay ray{{0, 0, 0}, {0, 1, 0}};
    const auto hits = ahead(Box{}, ray);
    ASSERT_EQ(hits.size(), 1u);
    EXPECT_NEAR(hits[0].t, 0.5, 1e-15);
    EXPECT_EQ(hits[0].primitive, 3u);
    EXPECT_FALSE(front(hits[0], ray));
}

// Flat along one axis: a face seen straight on, and its rim seen from the side.
TEST(BoxShape, FlatAlongAnAxis) {
    for (int flat = 0; flat < 3; ++flat) {
        Box box{{-1, -2, -3}, {1, 2, 3}};
        box.min[flat] = box.max[flat] = 0.5;
        for (int axis = 0; axis < 3; ++axis) {
            SCOPED_TRACE(testing::Message() << "flat " << flat << " along " << axis);
            glm::dvec3 origin(0.5);
            origin[axis] = 10.0;
            glm::dvec3 direction(0.0);
            direction[axis] = -1.0;
            const auto hits = ahead(box, {origin, direction});
            ASSERT_EQ(hits.size(), 2u);
            EXPECT_NEAR(hits[0].t, 10.0 - box.max[axis], 1e-14);
            for (const ShapeHit& hit : hits) {
                const std::array<int, 2> across{(axis + 1) % 3, (axis + 2) % 3};
                for (int k = 0; k < 2; ++k) {
                    const int other = across[static_cast<std::size_t>(k)];
                    const double share = (0.5 - box.min[other]) / (box.max[other] - box.min[other]);
                    EXPECT_NEAR(hit.uv[k], other == flat ? 0.0 : share, 1e-14);
                }
            }
        }
    }
}

TEST(BoxShape, Misses) {
    EXPECT_TRUE(ahead(Box{}, {{0.6, 0, 5}, {0, 0, -1}}).empty());
    EXPECT_TRUE(ahead(Box{}, {{0, 0, 5}, {0, 0, 1}}).empty());
    EXPECT_TRUE(ahead(Box{}, {{0, 0, 5}, {0, 0, 0}}).empty());
    EXPECT_TRUE(ahead(Box{}, {{0, 0, 5}, {kNaN, 0, -1}}).empty());
    EXPECT_TRUE(ahead(Box{}, {{-2, 1, 0}, {1, -0.15, 0}}).empty()) << "past the edge";
}

TEST(BoxShape, RandomHitsLieOnItsFace) {
    for (const double s : kScales) {
        Random random(31);
        for (int i = 0; i < 2000; ++i) {
            SCOPED_TRACE(i);
            const glm::dvec3 corner = 3.0 * s * random.direction();
            const Box box{corner, corner + s * random.point(glm::dvec3(0.1), glm::dvec3(2.0))};
            const glm::dvec3 origin = corner + 20.0 * s * random.direction();
            const ObjectRay ray{origin, random.point(box.min, box.max) - origin};
            const auto hits = ahead(box, ray);
            ASSERT_EQ(hits.size(), 2u);
            for (const ShapeHit& hit : hits) {
                const int axis = static_cast<int>(hit.primitive / 2);
                const bool high = hit.primitive % 2 == 1;
                const glm::dvec3 p = ray.origin + hit.t * ray.direction;
                EXPECT_NEAR(p[axis], high ? box.max[axis] : box.min[axis], 1e-12 * s);
                glm::dvec3 normal(0.0);
                normal[axis] = high ? 1.0 : -1.0;
                expect_near(glm::normalize(hit.normal), normal, 1e-12);
                for (int other = 0; other < 3; ++other) {
                    EXPECT_GE(p[other], box.min[other] - 1e-12 * s);
                    EXPECT_LE(p[other], box.max[other] + 1e-12 * s);
                }
            }
            EXPECT_NE(hits[0].primitive, hits[1].primitive);
        }
    }
}

TEST(BoxShape, UvAreFaceCoordinates) {
    // The two coordinates of the point within the face, in some order and sense.
    const Box box{{0, 0, 0}, {10, 20, 40}};
    const auto hits = ahead(box, {{1, 5, 100}, {0, 0, -1}});
    ASSERT_EQ(hits.size(), 2u);
    const double x = hits[0].uv.x;
    const double y = hits[0].uv.y;
    const auto is = [](double got, double wanted) {
        return std::abs(got - wanted) < 1e-12 || std::abs(got - (1.0 - wanted)) < 1e-12;
    };
    EXPECT_TRUE((is(x, 0.1) && is(y, 0.25)) || (is(x, 0.25) && is(y, 0.1))) << x << ' ' << y;
}

// --- all ----------------------------------------------------------------------------------------

TEST(Shapes, NaNsAndInfinitiesAreMisses) {
    for (const double bad : {kNaN, kInfinity, -kInfinity}) {
        for (int axis = 0; axis < 3; ++axis) {
            ObjectRay origin{{0.2, 0.2, 3.0}, {0, 0, -1}};
            origin.origin[axis] = bad;
            EXPECT_TRUE(ahead(Sphere{}, origin).empty());
            EXPECT_TRUE(ahead(Triangle{}, origin).empty());
            EXPECT_TRUE(ahead(Box{}, origin).empty());
            if (std::isnan(bad)) {
                EXPECT_TRUE(ahead(Plane{{0, 0, 1}, 0}, origin).empty());
            }
        }
        ObjectRay direction{{0.2, 0.2, 3.0}, {0, 0, -1}};
        direction.direction[1] = kNaN;
        EXPECT_TRUE(ahead(Sphere{}, direction).empty());
        EXPECT_TRUE(ahead(Triangle{}, direction).empty());
        EXPECT_TRUE(ahead(Box{}, direction).empty());
        EXPECT_TRUE(ahead(Plane{{0, 0, 1}, 0}, direction).empty());
    }
}

// --- mesh ---------------------------------------------------------------------------------------

TEST(MeshShape, CopiesShareTheirVertices) {
    const Mesh mesh = make_mesh("ball", ball_data(1));
    const Mesh copy = mesh;
    EXPECT_EQ(copy.positions.data(), mesh.positions.data());
    EXPECT_EQ(copy.triangles.data(), mesh.triangles.data());
    EXPECT_EQ(mesh.triangles.size(), 32u);
    EXPECT_EQ(mesh.name, "ball");
    EXPECT_NO_THROW(check_mesh(mesh));
}

TEST(MeshShape, BorrowedArraysAreNotCopied) {
    const MeshData data = octahedron_data();
    const Mesh mesh = borrow_mesh("borrowed", data.positions, data.triangles);
    EXPECT_EQ(mesh.positions.data(), data.positions.data());
    EXPECT_EQ(mesh.triangles.data(), data.triangles.data());
    EXPECT_EQ(mesh.storage, nullptr);
    EXPECT_NO_THROW(check_mesh(mesh));
}

TEST(MeshShape, CheckNamesTheFirstOffender) {
    MeshData data = octahedron_data();
    data.triangles[5].y = 6;
    const Mesh mesh = make_mesh("broken", data);
    try {
        check_mesh(mesh);
        FAIL() << "index 6 of 6 vertices";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find('5'), std::string::npos) << error.what();
    }
    MeshData few_normals = octahedron_data();
    few_normals.normals.resize(3, glm::vec3(0, 1, 0));
    EXPECT_THROW(check_mesh(make_mesh("few", few_normals)), Error);
    MeshData few_uvs = octahedron_data();
    few_uvs.uvs.resize(7);
    EXPECT_THROW(check_mesh(make_mesh("few", few_uvs)), Error);
    EXPECT_THROW(check_mesh(make_mesh("gap", octahedron_data(), {{0, 3, 0}, {4, 4, 0}})), Error);
    EXPECT_THROW(check_mesh(make_mesh("short", octahedron_data(), {{0, 7, 0}})), Error);
    EXPECT_THROW(check_mesh(make_mesh("long", octahedron_data(), {{0, 9, 0}})), Error);
    EXPECT_THROW(check_mesh(make_mesh("wrap", octahedron_data(), {{0, 0xffffffffu, 0}, {7, 1, 0}})),
                 Error);
    EXPECT_NO_THROW(check_mesh(make_mesh("parts", octahedron_data(), {{0, 3, 0}, {3, 5, 1}})));
}

TEST(MeshShape, PartOfATriangle) {
    const Mesh whole = make_mesh("whole", octahedron_data());
    EXPECT_EQ(part_of(whole, 0), nullptr);
    const Mesh mesh = make_mesh("parts", octahedron_data(), {{0, 3, 10}, {3, 1, 11}, {4, 4, 12}});
    const std::array<MaterialId, 8> wanted{10, 10, 10, 11, 12, 12, 12, 12};
    for (std::uint32_t i = 0; i < 8; ++i) {
        ASSERT_NE(part_of(mesh, i), nullptr);
        EXPECT_EQ(part_of(mesh, i)->material, wanted[i]) << i;
    }
}

}  // namespace
}  // namespace raypick
