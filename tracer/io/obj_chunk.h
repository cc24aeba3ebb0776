// Some consecutive lines of an OBJ file, so that several threads can read one file.
#pragma once

#include "tracer/io/obj_file.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raypick {

// Lines [begin, end) of the text, and how many v, vt and vn lines stand before them.
struct ObjRange {
    std::size_t begin = 0;
    std::size_t end = 0;
    std::array<std::size_t, 3> before{};
    std::array<std::size_t, 3> within{};  // a guess, to make room for them
};

// What is passed over, to be told once.
struct Note {
    std::size_t count = 0;
    std::size_t first = 0;  // offset

    void add(const Note& later) {
        if (count == 0) first = later.first;
        count += later.count;
    }
};

struct ObjNotes {
    Note lines_and_points;
    Note free_forms;
    Note short_faces;
    Note misplaced_signs;
    Note unknown;
    std::string unknown_word;

    void add(const ObjNotes& later) {
        if (unknown.count == 0) unknown_word = later.unknown_word;
        lines_and_points.add(later.lines_and_points);
        free_forms.add(later.free_forms);
        short_faces.add(later.short_faces);
        misplaced_signs.add(later.misplaced_signs);
        unknown.add(later.unknown);
    }
};

// A corner may name what stands further down in the file; the furthest one is checked at the end.
struct ForwardReference {
    std::uint32_t index = 0;
    std::size_t offset = 0;
    std::string_view word;

    void add(const ForwardReference& later) {
        if (word.empty() || (!later.word.empty() && later.index > index)) *this = later;
    }
};

// Numbers for names: each once, in order of appearance.
class NameNumbers {
public:
    int number_of(std::string name, std::vector<std::string>& names) {
        const auto [entry, is_new] = numbers_.try_emplace(name, static_cast<int>(names.size()));
        if (is_new) names.push_back(std::move(name));
        return entry->second;
    }

private:
    std::map<std::string, int, std::less<>> numbers_;
};

// The same `o`, `g` and `usemtl`?
bool same_names(const ObjRun& a, const ObjRun& b);

// In a run: what it was at the end of the lines before.
constexpr int kAsBefore = -2;

// What some consecutive lines of a file say. Names, faces and corners are numbered from 0, vertices
// as in the whole file.
struct ObjChunk {
    ObjFile obj;
    ObjRun last{0, kAsBefore, kAsBefore, kAsBefore};  // what the next face would belong to
    ObjNotes notes;
    std::array<ForwardReference, 3> forward;
};

// v, vt and vn lines read, by kind 0, 1 and 2.
std::size_t count_of(const ObjFile& obj, std::size_t kind);
// What to say of `word` of a face, which names what the file has `count` of only.
std::string out_of_range(std::size_t kind, std::string_view word, std::size_t count);

// Reads lines of the text; `step` is called now and then with the bytes read since the last time.
// Throws FileError, and what `step` throws.
ObjChunk parse_obj_chunk(const std::string& file, std::string_view text, const ObjRange& range,
                         const std::function<void(std::size_t)>& step);

}  // namespace raypick
