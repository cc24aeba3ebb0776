// Benchmarks: ours against the best that others have, in one run.
#include "tests/bench/embree_scene.h"
#include "tests/bench/groups.h"
#include "tests/bench/instruction_sets.h"
#include "tests/bench/options.h"
#include "tests/bench/report.h"

#include <exception>
#include <filesystem>
#include <iostream>
#include <stdexcept>

namespace raypick::bench {

namespace {

void describe_peers(Report& report) {
    EmbreeSettings settings;
    settings.isa = report.options().isa;
    const std::string embree = describe_embree(settings);
    if (embree.empty()) {
        report.missing("Embree 3 (libembree-dev), when this was built");
    } else {
        report.note(embree);
    }
}

int run_all(const Options& options) {
    Report report(options);
    if (!options.isa.empty() && !limit_our_instructions(options.isa)) {
        report.note("ours knows no --isa: it runs as ever");
    }
    describe_peers(report);
    run_kernels(report);
    run_frames(report);
    run_builds(report);
    run_picks(report);
    run_memory(report);
    run_loads(report);
    run_reads(report);
    return report.finish();
}

// What is unpacked and written stays in the build folder, wherever a run was started.
void enter_folder(Options& options) {
    for (std::filesystem::path* file : {&options.json, &options.models, &options.program}) {
        if (!file->empty()) *file = std::filesystem::absolute(*file);
    }
    std::filesystem::create_directories(options.folder);
    std::filesystem::current_path(options.folder);
}

// --weigh=MODEL,BUILDER among the words; "" if it isn't.
std::string weighed(std::vector<std::string>& words) {
    const std::string start = "--weigh=";
    for (auto word = words.begin(); word != words.end(); ++word) {
        if (word->rfind(start, 0) != 0) continue;
        std::string value = word->substr(start.size());
        words.erase(word);
        return value;
    }
    return "";
}

int run_words(std::vector<std::string> words) {
    for (const std::string& word : words) {
        if (word == "--help") {
            std::cout << usage();
            return 0;
        }
    }
    const std::string what = weighed(words);
    Options options = parse_options(words);
    enter_folder(options);
    if (what.empty()) return run_all(options);
    const std::size_t comma = what.find(',');
    return build_and_weigh(what.substr(0, comma), what.substr(comma + 1), options);
}

}  // namespace

}  // namespace raypick::bench

int main(int count, char** words) {
    try {
        return raypick::bench::run_words({words + 1, words + count});
    } catch (const std::invalid_argument& error) {
        std::cerr << error.what();
        return 2;
    } catch (const std::exception& error) {
        std::cerr << "raypick_bench: " << error.what() << '\n';
        return 1;
    }
}
