// Shading normals by the crease angle.
#include "tracer/scene/normals.h"

#include "tests/random.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <set>

namespace raypick {
namespace {

glm::vec3 corner_normal(const MeshData& data, std::size_t triangle, int corner) {
    return data.normals[data.triangles[triangle][corner]];
}

// Two squares that share the edge x = 0 and meet at `degrees` (0: one plane).
MeshData folded(double degrees) {
    const double angle = degrees * 3.14159265358979 / 180.0;
    const auto c = static_cast<float>(std::cos(angle));
    const auto s = static_cast<float>(std::sin(angle));
    MeshData data;
    data.positions = {{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {c, 0, -s}, {c, 1, -s}};
    data.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
    return data;
}

MeshData cube() {
    MeshData data;
    for (int i = 0; i < 8; ++i)
        data.positions.emplace_back(i & 1, (i >> 1) & 1, i >> 2);
    data.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return data;
}

// A sphere of 2 * n * n triangles whose vertices are shared, or one vertex a corner.
MeshData sphere(int n, bool shared) {
    MeshData data;
    for (int row = 0; row <= n; ++row) {
        for (int col = 0; col < n; ++col) {
            const double theta = 3.14159265358979 * row / n;
            const double phi = 2 * 3.14159265358979 * col / n;
            data.positions.emplace_back(std::sin(theta) * std::cos(phi),
                                        std::sin(theta) * std::sin(phi), std::cos(theta));
        }
    }
    const auto at = [&](int row, int col) { return static_cast<std::uint32_t>(row * n + col % n); };
    for (int row = 0; row < n; ++row) {
        for (int col = 0; col < n; ++col) {
            data.triangles.emplace_back(at(row, col), at(row + 1, col), at(row + 1, col + 1));
            data.triangles.emplace_back(at(row, col), at(row + 1, col + 1), at(row, col + 1));
        }
    }
    if (shared) return data;
    MeshData soup;
    for (const glm::uvec3& t : data.triangles) {
        const auto first = static_cast<std::uint32_t>(soup.positions.size());
        for (int i = 0; i < 3; ++i)
            soup.positions.push_back(data.positions[t[i]]);
        soup.triangles.emplace_back(first, first + 1, first + 2);
    }
    return soup;
}

void expect_same_corners(const MeshData& a, const MeshData& b) {
    ASSERT_EQ(a.triangles.size(), b.triangles.size());
    for (std::size_t t = 0; t < a.triangles.size(); ++t) {
        for (int i = 0; i < 3; ++i)
            ASSERT_EQ(a.positions[a.triangles[t][i]], b.positions[b.triangles[t][i]]) << t;
    }
}

TEST(CreaseNormals, ZeroMeansFlat) {
    MeshData data = folded(10.0);
    data.normals.assign(6, glm::vec3(1, 0, 0));
    const MeshData flat = with_crease_normals(data, 0.0);
    EXPECT_TRUE(flat.normals.empty());
    EXPECT_EQ(flat.positions.size(), 6u);
}

TEST(CreaseNormals, SmoothBelowTheAngleSplitAbove) {
    const MeshData below = with_crease_normals(folded(29.0), 30.0);
    EXPECT_EQ(below.positions.size(), 6u);
    // The mean of two equal squares.
    const double half = 14.5 * 3.14159265358979 / 180.0;
    EXPECT_NEAR(corner_normal(below, 0, 1).x, std::sin(half), 1e-6);
    EXPECT_NEAR(corner_normal(below, 0, 1).z, std::cos(half), 1e-6);
    EXPECT_EQ(corner_normal(below, 0, 1), corner_normal(below, 2, 0));
    EXPECT_EQ(corner_normal(below, 0, 0), glm::vec3(0, 0, 1));

    const MeshData above = with_crease_normals(folded(31.0), 30.0);
    EXPECT_EQ(above.positions.size(), 8u);
    EXPECT_EQ(corner_normal(above, 0, 1), glm::vec3(0, 0, 1));
    expect_same_corners(folded(31.0), above);
}

TEST(CreaseNormals, ACubeKeepsItsEdgesAndAnOpenAngleRoundsThem) {
    const MeshData sharp = with_crease_normals(cube(), 30.0);
    EXPECT_EQ(sharp.positions.size(), 24u);
    for (std::size_t t = 0; t < 12; ++t) {
        for (int i = 0; i < 3; ++i) {
            const glm::vec3 n = glm::abs(corner_normal(sharp, t, i));
            EXPECT_FLOAT_EQ(std::max({n.x, n.y, n.z}), 1.0f);
        }
    }
    // Weighted by the angle, the three faces count the same however they are triangulated.
    const MeshData round = with_crease_normals(cube(), 180.0);
    EXPECT_EQ(round.positions.size(), 8u);
    for (std::size_t t = 0; t < 12; ++t) {
        for (int i = 0; i < 3; ++i) {
            const glm::vec3 p = round.positions[round.triangles[t][i]] - glm::vec3(0.5f);
            EXPECT_NEAR(glm::dot(corner_normal(round, t, i), glm::normalize(p)), 1.0f, 1e-6);
        }
    }
}

TEST(CreaseNormals, WeldsEqualPositions) {
    const MeshData shared = with_crease_normals(sphere(40, true), 30.0);
    const MeshData soup = with_crease_normals(sphere(40, false), 30.0);
    expect_same_corners(shared, soup);
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        for (int i = 0; i < 3; ++i) {
            const glm::vec3 n = corner_normal(soup, t, i);
            ASSERT_EQ(n, corner_normal(shared, t, i));
            ASSERT_NEAR(glm::length(n), 1.0f, 1e-6);
        }
    }
    EXPECT_EQ(shared.positions.size(), soup.positions.size());
}

TEST(CreaseNormals, MinusZeroIsZero) {
    MeshData data = folded(10.0);
    data.positions.emplace_back(-0.0f, 0.0f, -0.0f);
    data.triangles[2].x = 6;
    data.triangles[3].x = 6;
    EXPECT_EQ(with_crease_normals(data, 30.0).positions.size(), 6u);
}

TEST(CreaseNormals, NormalsOfASphereAreItsRadii) {
    const MeshData data = with_crease_normals(sphere(100, true), 30.0);
    for (std::size_t t = 0; t < data.triangles.size(); ++t) {
        const glm::vec3 p = data.positions[data.triangles[t].y];
        ASSERT_GT(glm::dot(corner_normal(data, t, 1), p), 0.999f) << t;
    }
}

TEST(CreaseNormals, KeepsTexturesApart) {
    MeshData data = folded(10.0);
    // A seam along the shared edge: the same positions with other uvs.
    data.positions.push_back(data.positions[1]);
    data.positions.push_back(data.positions[2]);
    data.triangles[2] = {6, 4, 5};
    data.triangles[3] = {6, 5, 7};
    for (std::uint32_t i = 0; i < 8; ++i)
        data.uvs.emplace_back(static_cast<float>(i), 0.5f);
    const MeshData smooth = with_crease_normals(data, 30.0);
    EXPECT_EQ(smooth.positions.size(), 8u);
    EXPECT_EQ(corner_normal(smooth, 0, 1), corner_normal(smooth, 2, 0));
    for (std::size_t t = 0; t < 4; ++t) {
        for (int i = 0; i < 3; ++i)
            EXPECT_EQ(smooth.uvs[smooth.triangles[t][i]], data.uvs[data.triangles[t][i]]);
    }
}

TEST(CreaseNormals, DegenerateTrianglesTakeNoPart) {
    const MeshData clean = with_crease_normals(folded(29.0), 30.0);
    MeshData dirty = folded(29.0);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    dirty.positions.emplace_back(7, 7, 7);
    dirty.positions.emplace_back(nan, 0, 0);
    dirty.triangles.insert(dirty.triangles.begin(), {1, 1, 2});
    dirty.triangles.emplace_back(0, 1, 7);
    dirty.triangles.emplace_back(6, 6, 6);
    const MeshData smooth = with_crease_normals(dirty, 30.0);
    ASSERT_EQ(smooth.triangles.size(), 7u);
    for (std::size_t t = 0; t < 4; ++t) {
        for (int i = 0; i < 3; ++i)
            EXPECT_EQ(corner_normal(smooth, t + 1, i), corner_normal(clean, t, i));
    }
    for (const glm::vec3& n : smooth.normals)
        EXPECT_NEAR(glm::length(n), 1.0f, 1e-6);
    EXPECT_EQ(smooth.positions[smooth.triangles[6].x], glm::vec3(7, 7, 7));
}

TEST(CreaseNormals, BackToBackFacesStayApart) {
    MeshData data;
    data.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    data.triangles = {{0, 1, 2}, {0, 2, 1}};
    const MeshData smooth = with_crease_normals(data, 60.0);
    EXPECT_EQ(corner_normal(smooth, 0, 0), glm::vec3(0, 0, 1));
    EXPECT_EQ(corner_normal(smooth, 1, 0), glm::vec3(0, 0, -1));
}

TEST(CreaseNormals, TinyAndHugeMeshesAreSmoothedAlike) {
    const MeshData unit = with_crease_normals(sphere(20, true), 30.0);
    for (const float factor : {0x1p-60f, 0x1p60f}) {
        MeshData scaled = sphere(20, true);
        for (glm::vec3& p : scaled.positions)
            p *= factor;
        const MeshData smooth = with_crease_normals(scaled, 30.0);
        ASSERT_EQ(smooth.normals.size(), unit.normals.size());
        for (std::size_t i = 0; i < unit.normals.size(); ++i)
            ASSERT_EQ(smooth.normals[i], unit.normals[i]);
    }
}

TEST(CreaseNormals, IsTheSameEveryTime) {
    const MeshData a = with_crease_normals(sphere(50, false), 5.0);
    const MeshData b = with_crease_normals(sphere(50, false), 5.0);
    ASSERT_EQ(a.normals.size(), b.normals.size());
    EXPECT_EQ(std::memcmp(a.normals.data(), b.normals.data(), a.normals.size() * sizeof(glm::vec3)),
              0);
    EXPECT_EQ(a.triangles, b.triangles);
}

TEST(CreaseNormals, CrowdedPointsAndEdgesTakeNoQuadraticTime) {
    // A cone whose apex has 200,000 faces, and 200,000 faces on one edge.
    constexpr std::uint32_t kFaces = 200000;
    MeshData data;
    data.positions = {{0, 0, 1}, {0, 0, 0}};
    for (std::uint32_t i = 0; i < kFaces; ++i) {
        const double angle = 2 * 3.14159265358979 * i / kFaces;
        data.positions.emplace_back(100 * std::cos(angle), 100 * std::sin(angle), 0);
        data.triangles.emplace_back(0, 2 + i, 2 + (i + 1) % kFaces);
        data.triangles.emplace_back(0, 1, 2 + i);
    }
    const auto begin = std::chrono::steady_clock::now();
    const MeshData smooth = with_crease_normals(data, 30.0);
    EXPECT_EQ(smooth.triangles.size(), 2u * kFaces);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

// Several blocks of points, with creases, uvs, points without triangles and degenerate triangles in
// all of them.
MeshData many_blocks() {
    MeshData data = sphere(120, true);
    Random random(3);
    for (const glm::vec3& p : data.positions)
        data.uvs.emplace_back(std::round(4.0f * p.x), std::round(4.0f * p.y));
    for (std::size_t i = 0; i < data.triangles.size(); i += 37) {
        const std::uint32_t corner = data.triangles[i].x;
        data.triangles[i].y = corner;  // degenerate
    }
    for (std::size_t i = 0; i < 50; ++i)  // at points of their own
        data.triangles.emplace_back(glm::uvec3(static_cast<std::uint32_t>(data.positions.size())));
    data.positions.emplace_back(9.0f, 9.0f, 9.0f);
    data.uvs.emplace_back(0.0f);
    for (std::size_t i = 0; i < data.positions.size(); i += 11)  // creases
        data.positions[i] *= static_cast<float>(random.between(0.97, 1.03));
    return data;
}

TEST(CreaseNormals, AnyNumberOfThreadsGivesTheSame) {
    const MeshData one = with_crease_normals(many_blocks(), 30.0, 1);
    EXPECT_GT(one.positions.size(), 3u * 4096u);
    for (const int threads : {2, 3, 8}) {
        const MeshData many = with_crease_normals(many_blocks(), 30.0, threads);
        EXPECT_EQ(many.positions, one.positions) << threads;
        EXPECT_EQ(many.normals, one.normals) << threads;
        EXPECT_EQ(many.uvs, one.uvs) << threads;
        EXPECT_EQ(many.triangles, one.triangles) << threads;
    }
}

}  // namespace
}  // namespace raypick
