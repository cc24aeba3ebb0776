// Finds out whether a window can be opened, without hanging on a display that does not answer.
#pragma once

#include <sys/types.h>

namespace raypick {

// A child process that opens a hidden window with an OpenGL 3.3 core context, because opening a
// display blocks for as long as its server is silent. The child keeps its window until the probe is
// destroyed: some X servers start over when their last client leaves, and drop whoever comes just
// then. Make it before there are threads; they may begin before it has its answer.
class DisplayProbe {
public:
    // Asks, if a display is named.
    DisplayProbe();
    ~DisplayProbe();
    DisplayProbe(const DisplayProbe&) = delete;
    DisplayProbe& operator=(const DisplayProbe&) = delete;

    [[nodiscard]] bool asks() const { return child_ > 0; }
    // Both wait for the answer. One that refuses may just be starting over.
    [[nodiscard]] bool answers() { return outcome() == Outcome::answers; }
    [[nodiscard]] bool refuses() { return asks() && outcome() == Outcome::refuses; }
    // Once more, after a moment. Like the constructor, while there are no other threads.
    void ask_again();

private:
    enum class Outcome { unknown, answers, refuses, silent };

    Outcome outcome();
    void start();
    [[nodiscard]] Outcome hear() const;
    void stop();

    pid_t child_ = -1;
    int from_child_ = -1;  // read end of a pipe
    Outcome outcome_ = Outcome::unknown;
};

}  // namespace raypick
