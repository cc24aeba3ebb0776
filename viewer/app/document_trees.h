// The trees of the open document as they come: first ones, then better ones.
#pragma once

#include "tracer/accel/background_build.h"

#include <functional>
#include <memory>
#include <vector>

namespace raypick {

// No call waits for a builder but the destructor.
class DocumentTrees {
public:
    // `notify` is called from a working thread when there is news.
    explicit DocumentTrees(std::function<void()> notify, BackgroundBuild::Build build = {});

    // Another scene from now on; what is being built for the one before is given up. Its trees are
    // begun by the next update().
    void set_scene(std::shared_ptr<const Scene> scene);
    // Takes over what has been built, and begins what is missing. True if progress() is another one
    // now. `hold`: something else needs the machine, and the better trees can wait.
    bool update(bool hold);

    [[nodiscard]] const BuildProgress& progress() const { return progress_; }
    // update() would take something over.
    [[nodiscard]] bool news() const;
    [[nodiscard]] bool building() const { return build_ != nullptr; }

private:
    void take_over();
    void give_up();
    [[nodiscard]] bool lacks_trees() const;

    std::function<void()> notify_;
    BackgroundBuild::Build build_how_;
    std::shared_ptr<const Scene> scene_;
    BuildProgress progress_;
    std::unique_ptr<BackgroundBuild> build_;
    std::vector<std::unique_ptr<BackgroundBuild>> given_up_;  // their threads still ending
};

}  // namespace raypick
