// Trees in the making beside everything else: first those that picks work with, then better ones.
#pragma once

#include "tracer/accel/accel.h"

#include <functional>
#include <memory>
#include <string>

namespace raypick {

struct BuildProgress {
    // The best there is by now; nullptr: none yet.
    std::shared_ptr<const Accel> accel;
    TreeQuality quality = TreeQuality::first;  // of `accel`
    double first_seconds = 0.0;                // that each took; 0: not there, or not asked for
    double many_rays_seconds = 0.0;
    std::string error;  // why it ended before many_rays; "" if it did not, or was cancelled
    bool finished = false;
};

// Builds a scene's trees on a thread of its own, of quality `first`, then `many_rays`. Hits are the
// same on both, so that whoever has one may go on with it. Start, look, cancel; the destructor
// cancels and joins.
class BackgroundBuild {
public:
    // Throws what Accel's constructor throws.
    using Build = std::function<std::shared_ptr<const Accel>(std::shared_ptr<const Scene>,
                                                             const BuildOptions&)>;

    // `notify` is called from the working thread whenever progress() has changed. Begins after
    // `first` if it is there, the scene's tree of that quality.
    BackgroundBuild(std::shared_ptr<const Scene> scene, std::function<void()> notify,
                    std::shared_ptr<const Accel> first = nullptr, Build build = {});
    ~BackgroundBuild();
    BackgroundBuild(const BackgroundBuild&) = delete;
    BackgroundBuild& operator=(const BackgroundBuild&) = delete;

    // Asks to stop and returns at once; nothing new is built then.
    void cancel();
    // Returns when the thread has ended.
    void wait();
    // Never waits for the builders.
    [[nodiscard]] BuildProgress progress() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace raypick
