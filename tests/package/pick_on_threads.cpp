// Many threads query one Accel over the caller's own arrays at once.
#include <picking/pick.h>
#include <tracer/accel/accel.h>

#include <atomic>
#include <cmath>
#include <iostream>
#include <memory>
#include <thread>
#include <vector>

namespace {

// A square grid of unit cells in the plane z = height(x, y).
struct Grid {
    std::vector<glm::vec3> points;
    std::vector<glm::uvec3> triangles;
};

float height(float x, float y) {
    return 0.25f * x - 0.5f * y;
}

Grid make_grid(unsigned cells) {
    Grid grid;
    for (unsigned y = 0; y <= cells; ++y) {
        for (unsigned x = 0; x <= cells; ++x) {
            const auto fx = static_cast<float>(x);
            const auto fy = static_cast<float>(y);
            grid.points.emplace_back(fx, fy, height(fx, fy));
        }
    }
    for (unsigned y = 0; y < cells; ++y) {
        for (unsigned x = 0; x < cells; ++x) {
            const unsigned a = y * (cells + 1) + x;
            const unsigned d = a + cells + 1;
            grid.triangles.emplace_back(a, a + 1, d);
            grid.triangles.emplace_back(a + 1, d + 1, d);
        }
    }
    return grid;
}

// A place inside the grid, away from its border, from ten bits.
float place(unsigned bits, unsigned cells) {
    return (static_cast<float>(bits & 0x3ffu) + 0.5f) / 1024.0f * static_cast<float>(cells);
}

// Shoots straight down at `count` places, other ones for each seed; returns how many answers were
// wrong.
int count_wrong(const raypick::Accel& accel, unsigned cells, unsigned seed, int count) {
    int wrong = 0;
    for (int i = 0; i < count; ++i) {
        seed = seed * 1664525u + 1013904223u;
        const float x = place(seed >> 16, cells);
        const float y = place(seed >> 6, cells);
        const raypick::Ray ray{{x, y, 100.0f}, {0.0f, 0.0f, -1.0f}};
        const auto pick = raypick::pick_ray(accel, ray);
        if (!pick || std::abs(pick->hit.t - (100.0f - height(x, y))) > 1e-3f) {
            ++wrong;
        }
    }
    return wrong;
}

}  // namespace

int main() {
    constexpr unsigned kCells = 64;
    const Grid grid = make_grid(kCells);

    raypick::Scene scene;
    const auto mesh =
        raypick::add_mesh(scene, raypick::borrow_mesh("ground", grid.points, grid.triangles));
    raypick::add_object(scene, {.name = "ground", .shape = raypick::MeshInstance{mesh}});
    const raypick::Accel accel(std::make_shared<raypick::Scene>(std::move(scene)));

    const raypick::Mesh& seen = accel.scene().meshes[mesh];
    if (seen.positions.data() != grid.points.data() ||
        seen.triangles.data() != grid.triangles.data()) {
        std::cerr << "the mesh's arrays were copied\n";
        return 1;
    }

    std::atomic<int> wrong = 0;
    {
        std::vector<std::jthread> threads;
        for (unsigned seed = 1; seed <= 8; ++seed) {
            threads.emplace_back([&, seed] { wrong += count_wrong(accel, kCells, seed, 10000); });
        }
    }
    std::cout << wrong << " of 80000 picks wrong\n";
    return wrong == 0 ? 0 : 1;
}
