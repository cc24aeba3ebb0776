#include <picking/pick.h>
#include <tracer/accel/accel.h>

#include <iostream>

int main() {
    const std::vector<glm::vec3> corners{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    const std::vector<glm::uvec3> triangles{{0, 1, 2}, {0, 2, 3}};

    raypick::Scene scene;
    const auto mesh = raypick::add_mesh(scene, raypick::borrow_mesh("quad", corners, triangles));
    raypick::add_object(scene, {.name = "door", .shape = raypick::MeshInstance{mesh}});

    const raypick::Accel accel(std::make_shared<raypick::Scene>(std::move(scene)));
    const raypick::Camera camera{.eye = {0, 0, 5}, .at = {0, 0, 0}, .fovy = 45};
    const raypick::ImageSize size{.rows = 480, .cols = 640};
    const raypick::Pixel pixel{.row = 240, .col = 320};

    const auto pick = raypick::pick_pixel(accel, camera, size, pixel);
    std::cout << raypick::to_json({pixel, pick}) << '\n';
    return pick ? 0 : 1;
}
