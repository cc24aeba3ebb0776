// How a reader keeps in touch with who waits for it.
#pragma once

#include "tracer/error.h"
#include "tracer/io/load.h"

#include <filesystem>
#include <string>

namespace raypick {

// Reports progress (0..1) and throws Cancelled if loading was stopped.
inline void load_step(const LoadOptions& options, float progress) {
    if (options.stop.stop_requested()) throw Cancelled();
    if (options.progress != nullptr) options.progress->store(progress, std::memory_order_relaxed);
}

// An empty scene whose ids go on where the session's stand.
inline LoadedScene begin_scene(const LoadOptions& options) {
    LoadedScene loaded;
    loaded.scene.next_object_id = options.first_object_id;
    return loaded;
}

// "FILE: text", as warnings begin.
inline std::string warning(const std::filesystem::path& file, const std::string& text) {
    return file.string() + ": " + text;
}

}  // namespace raypick
