#include "tracer/parallel/parallel.h"
#include "viewer/cli/commands.h"
#include "viewer/cli/exit_code.h"
#include "viewer/cli/line_reader.h"
#include "viewer/cli/open_scene.h"
#include "viewer/cli/pick_answers.h"
#include "viewer/cli/standard_output.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <vector>

namespace raypick {
namespace {

// Lines that one thread answers at a time.
constexpr std::size_t kBlock = 512;

struct Answers {
    std::string text;
    std::uint64_t errors = 0;
};

Answers answer_lines(const PickAnswerer& answerer, StreamOf about,
                     std::span<const std::string_view> lines, std::uint64_t first_line) {
    std::vector<PickQuestion> questions;
    questions.reserve(lines.size());
    Answers answers;
    for (const std::string_view line : lines) {
        questions.push_back(answerer.question(about, line));
        if (!questions.back().error.empty()) ++answers.errors;
    }
    answers.text = answerer.answer(questions, first_line);
    return answers;
}

// Answers lines on all cores; the answers stand in the lines' order.
std::vector<Answers> answer_batch(const PickAnswerer& answerer, StreamOf about,
                                  std::span<const std::string_view> lines,
                                  std::uint64_t first_line) {
    std::vector<Answers> blocks((lines.size() + kBlock - 1) / kBlock);
    const auto answer_block = [&](std::size_t block) {
        const std::size_t first = block * kBlock;
        const std::size_t count = std::min(kBlock, lines.size() - first);
        blocks[block] =
            answer_lines(answerer, about, lines.subspan(first, count), first_line + first);
    };
    if (blocks.size() == 1) {
        answer_block(0);
    } else {
        parallel_for(blocks.size(), 0, {}, answer_block);
    }
    return blocks;
}

// Answers what is there and flushes before it waits for more, so that whoever writes one line and
// waits for its answer gets it. Returns the number of lines that could not be answered.
std::uint64_t answer_stream(const PickAnswerer& answerer, StreamOf about, StandardOutput& output) {
    LineReader reader(STDIN_FILENO);
    std::uint64_t line_number = 1;
    std::uint64_t errors = 0;
    for (auto lines = reader.read(); !lines.empty(); lines = reader.read()) {
        for (const Answers& block : answer_batch(answerer, about, lines, line_number)) {
            output.write(block.text);
            errors += block.errors;
        }
        output.flush();
        line_number += lines.size();
    }
    return errors;
}

std::vector<PickQuestion> questions_of(const PickCommand& command, const PickAnswerer& answerer) {
    std::vector<PickQuestion> questions;
    for (const Pixel& pixel : command.pixels)
        questions.push_back(answerer.question(pixel));
    for (const FileRay& ray : command.rays)
        questions.push_back(answerer.question(ray));
    return questions;
}

}  // namespace

int run_pick(const PickCommand& command) {
    const OpenedScene opened = open_scene(command.scene);
    // A few picks are sooner done than a tree for many.
    const BuiltAccel built = build_timed(
        opened, {.quality = command.stream ? TreeQuality::many_rays : TreeQuality::first});
    if (command.scene.verbose) print_report(built);
    const PickAnswerer answerer(built.accel, command.camera, command.size, command.all);
    StandardOutput output;
    output.write(answerer.answer(questions_of(command, answerer), 1));
    output.flush();
    if (!command.stream) return kExitOk;
    const std::uint64_t errors = answer_stream(answerer, *command.stream, output);
    if (errors == 0) return kExitOk;
    throw UsageError(
        fmt::format("{} lines of standard input could not be answered; each has an "
                    "\"error\" in the output",
                    errors));
}

}  // namespace raypick
