#include "tracer/io/load.h"

#include "tracer/error.h"
#include "tracer/io/file_kind.h"
#include "tracer/io/formats.h"

#include <fmt/format.h>

#include <new>
#include <stdexcept>
#include <string>

namespace raypick {

namespace {

FileKind kind_or_fail(const std::filesystem::path& file) {
    if (const std::optional<FileKind> kind = file_kind(file, read_head(file))) return *kind;
    std::string known;
    for (const std::string& ending : readable_extensions())
        known += (known.empty() ? "" : ", ") + ending;
    throw FileError(file.string(), "has no format that we read (" + known + ")");
}

LoadedScene load_kind(const std::filesystem::path& file, FileKind kind,
                      const LoadOptions& options) {
    switch (kind) {
        case FileKind::scene:
            return load_scene_file(file, options);
        case FileKind::obj:
            return load_obj(file, options);
        case FileKind::gltf:
            return load_gltf(file, options);
        case FileKind::ply:
            return load_ply(file, options);
        case FileKind::nff:
            return load_nff(file, options);
        case FileKind::stl:
            break;
    }
    return load_stl(file, options);
}

// Whatever goes wrong names the file.
template <typename Load>
LoadedScene naming_file(const std::filesystem::path& file, const Load& load) {
    try {
        return load();
    } catch (const FileError&) {
        throw;
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        throw FileError(file.string(), error.what());
    } catch (const std::bad_alloc&) {
        throw FileError(file.string(), "needs more memory than there is");
    } catch (const std::length_error&) {
        throw FileError(file.string(), "needs more memory than there is");
    }
}

}  // namespace

LoadedScene load_model(const std::filesystem::path& file, const LoadOptions& options) {
    const FileKind kind = kind_or_fail(file);
    if (kind == FileKind::scene) throw FileError(file.string(), "is a scene file, not a model");
    return load_kind(file, kind, options);
}

LoadedScene load_scene(const std::filesystem::path& file, const LoadOptions& options) {
    return naming_file(file, [&] {
        LoadedScene loaded = load_kind(file, kind_or_fail(file), options);
        check_scene(loaded.scene);
        if (!loaded.keeps_origin) choose_origin(loaded.scene);
        if (options.progress != nullptr) options.progress->store(1.0f);
        return loaded;
    });
}

}  // namespace raypick
