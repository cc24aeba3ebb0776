// Finds out whether a window can be opened, without hanging on a display that does not answer.
#pragma once

#include <sys/types.h>

namespace raypick {

// A child process that opens a hidden window with an OpenGL 3.3 core context, because opening a
// display blocks for as long as its server is silent. The child keeps its window until the probe is
// destroyed: some X servers start over when their last client leaves, and drop whoever comes just
// then. Make it before there are threads.
class DisplayProbe {
public:
    DisplayProbe();
    ~DisplayProbe();
    DisplayProbe(const DisplayProbe&) = delete;
    DisplayProbe& operator=(const DisplayProbe&) = delete;

    [[nodiscard]] bool answers() const { return outcome_ == Outcome::answers; }

private:
    enum class Outcome { answers, refuses, silent };

    void start();
    [[nodiscard]] Outcome hear() const;
    void stop();

    pid_t child_ = -1;
    int from_child_ = -1;  // read end of a pipe
    Outcome outcome_ = Outcome::refuses;
};

}  // namespace raypick
