// The open scene, and opening another one beside the running window.
#pragma once

#include "tracer/geometry/bounds.h"
#include "tracer/scene/scene.h"

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

namespace raypick {

// A scene that is ready to be looked at. What rays need is built while it is shown: DocumentTrees.
struct Document {
    std::filesystem::path file;
    std::shared_ptr<const Scene> scene;
    Bounds bounds;  // of its finite objects
    std::vector<std::string> warnings;
    double load_seconds = 0.0;
};

// Why a file could not be opened.
struct OpenFailure {
    std::filesystem::path file;
    std::string message;
};

using OpenResult = std::variant<Document, OpenFailure>;

struct OpenProgress {
    std::filesystem::path file;
    float fraction = 0.0f;
    double seconds = 0.0;
};

// Reads scenes on a thread of its own. No call waits for that thread but the destructor.
class DocumentOpener {
public:
    // `notify` is called from the working thread when a result is ready.
    explicit DocumentOpener(std::function<void()> notify);
    ~DocumentOpener();
    DocumentOpener(const DocumentOpener&) = delete;
    DocumentOpener& operator=(const DocumentOpener&) = delete;

    // Begins to open a file; one that is being opened is given up.
    void open(const std::filesystem::path& file, double crease_degrees, ObjectId first_object_id);
    // Gives up what is being opened.
    void cancel();

    // The result, once.
    std::optional<OpenResult> take_result();
    // Of what is being opened; nothing if nothing is.
    [[nodiscard]] std::optional<OpenProgress> progress() const;

private:
    struct Work;

    void join_ended();

    std::function<void()> notify_;
    std::shared_ptr<Work> work_;
    std::jthread thread_;
    std::vector<std::pair<std::shared_ptr<Work>, std::jthread>> given_up_;
};

}  // namespace raypick
