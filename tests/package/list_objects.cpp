// Lists the objects of a scene or model file.
#include <tracer/io/load.h>

#include <iostream>

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: list_objects FILE\n";
        return 2;
    }
    const raypick::LoadedScene loaded = raypick::load_scene(argv[1]);
    for (const raypick::Object& object : loaded.scene.objects) {
        std::cout << object.path << '\n';
    }
    return loaded.scene.objects.empty() ? 1 : 0;
}
