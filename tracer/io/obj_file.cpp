#include "tracer/io/obj_file.h"

#include "tracer/error.h"
#include "tracer/io/file_bytes.h"
#include "tracer/io/load_steps.h"
#include "tracer/io/obj_chunk.h"
#include "tracer/io/text_scanner.h"
#include "tracer/parallel/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <iterator>
#include <optional>
#include <utility>

namespace raypick {

namespace {

// Behind the first end of a line at or after `offset` that no backslash joins with the next line.
std::size_t line_begin_after(std::string_view text, std::size_t offset) {
    while (offset < text.size()) {
        const std::size_t newline = text.find('\n', offset);
        if (newline == std::string_view::npos) break;
        const std::string_view line = text.substr(0, newline);
        const bool joined = line.ends_with('\\') || line.ends_with("\\\r");
        offset = newline + 1;
        if (!joined) return offset;
    }
    return text.size();
}

// About chunk_bytes each.
std::vector<ObjRange> split_lines(std::string_view text, std::size_t chunk_bytes) {
    std::vector<ObjRange> ranges;
    std::size_t begin = 0;
    do {
        const bool last = text.size() - begin < 2 * chunk_bytes;
        const std::size_t end = last ? text.size() : line_begin_after(text, begin + chunk_bytes);
        ranges.push_back({begin, end, {}, {}});
        begin = end;
    } while (begin < text.size());
    return ranges;
}

// Lines that seem to be v, vt and vn lines. The parser has the last word.
std::array<std::size_t, 3> count_vertex_lines(std::string_view lines) {
    std::array<std::size_t, 3> counts{};
    while (!lines.empty()) {
        std::size_t at = 0;
        while (at < lines.size() && is_blank(lines[at]))
            ++at;
        const auto character = [&](std::size_t i) { return i < lines.size() ? lines[i] : '\n'; };
        if (character(at) == 'v') {
            const char second = character(at + 1);
            if (is_blank(second)) ++counts[0];
            if (second == 't' && is_blank(character(at + 2))) ++counts[1];
            if (second == 'n' && is_blank(character(at + 2))) ++counts[2];
        }
        const std::size_t newline = lines.find('\n', at);
        lines.remove_prefix(newline == std::string_view::npos ? lines.size() : newline + 1);
    }
    return counts;
}

void count_vertices(std::string_view text, std::vector<ObjRange>& ranges) {
    parallel_for(ranges.size(), 0, {}, [&](std::size_t i) {
        ObjRange& range = ranges[i];
        range.within = count_vertex_lines(text.substr(range.begin, range.end - range.begin));
    });
    for (std::size_t i = 1; i < ranges.size(); ++i) {
        for (std::size_t kind = 0; kind < 3; ++kind)
            ranges[i].before[kind] = ranges[i - 1].before[kind] + ranges[i - 1].within[kind];
    }
}

// Did every chunk begin with as many vertices as there were?
bool fit_together(const std::vector<ObjRange>& ranges, const std::vector<ObjChunk>& chunks) {
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        for (std::size_t kind = 0; kind < 3; ++kind) {
            if (count_of(chunks[i].obj, kind) != ranges[i].within[kind]) return false;
        }
    }
    return true;
}

template <typename T>
void append(std::vector<T>& target, std::vector<T>& added) {
    if (target.capacity() == 0) {
        target = std::move(added);  // there is one chunk only
        return;
    }
    target.insert(target.end(), added.begin(), added.end());
}

// Puts one chunk behind the other, so that nothing shows where they met.
class ChunkJoiner {
public:
    void add(ObjChunk chunk) {
        take_names(chunk.obj);
        add_runs(chunk.obj.runs);
        last_ = in_file(chunk.last);
        for (const std::uint64_t begin : chunk.obj.face_begin)
            joined_.obj.face_begin.push_back(joined_.obj.corners.size() + begin);
        append(joined_.obj.corners, chunk.obj.corners);
        append(joined_.obj.positions, chunk.obj.positions);
        append(joined_.obj.uvs, chunk.obj.uvs);
        append(joined_.obj.normals, chunk.obj.normals);
        append(joined_.obj.libraries, chunk.obj.libraries);
        joined_.notes.add(chunk.notes);
        for (std::size_t kind = 0; kind < 3; ++kind)
            joined_.forward[kind].add(chunk.forward[kind]);
    }

    void reserve(const std::vector<ObjChunk>& chunks) {
        std::size_t corners = 0;
        std::size_t faces = 0;
        std::array<std::size_t, 3> vertices{};
        for (const ObjChunk& chunk : chunks) {
            corners += chunk.obj.corners.size();
            faces += chunk.obj.face_begin.size();
            for (std::size_t kind = 0; kind < 3; ++kind)
                vertices[kind] += count_of(chunk.obj, kind);
        }
        joined_.obj.corners.reserve(corners);
        joined_.obj.face_begin.reserve(faces + 1);
        joined_.obj.positions.reserve(vertices[0]);
        joined_.obj.uvs.reserve(vertices[1]);
        joined_.obj.normals.reserve(vertices[2]);
    }

    ObjChunk take() { return std::move(joined_); }

private:
    void take_names(ObjFile& obj) {
        first_object_ = static_cast<int>(joined_.obj.objects.size());
        append(joined_.obj.objects, obj.objects);
        groups_.clear();
        for (const std::string& name : obj.groups)
            groups_.push_back(group_numbers_.number_of(name, joined_.obj.groups));
        materials_.clear();
        for (const std::string& name : obj.materials)
            materials_.push_back(material_numbers_.number_of(name, joined_.obj.materials));
    }

    void add_runs(const std::vector<ObjRun>& runs) {
        const auto first_face = static_cast<std::uint32_t>(joined_.obj.face_begin.size());
        for (const ObjRun& run : runs) {
            ObjRun added = in_file(run);
            added.first_face += first_face;
            if (!joined_.obj.runs.empty() && same_names(joined_.obj.runs.back(), added)) continue;
            joined_.obj.runs.push_back(added);
        }
    }

    // The chunk's names by their numbers in the file.
    [[nodiscard]] ObjRun in_file(ObjRun run) const {
        const auto number = [](int of_chunk, int before, const std::vector<int>& numbers) {
            return of_chunk == kAsBefore ? before : numbers[static_cast<std::size_t>(of_chunk)];
        };
        run.object = run.object == kAsBefore ? last_.object : first_object_ + run.object;
        run.group = number(run.group, last_.group, groups_);
        run.material = number(run.material, last_.material, materials_);
        return run;
    }

    ObjChunk joined_;
    ObjRun last_;
    NameNumbers group_numbers_;
    NameNumbers material_numbers_;
    // Of the chunk at hand.
    int first_object_ = 0;
    std::vector<int> groups_;
    std::vector<int> materials_;
};

class ObjReader {
public:
    ObjReader(const std::filesystem::path& file, const LoadOptions& options)
        : text_(file), file_(file.string()), options_(options) {}

    ObjFile read(std::size_t chunk_bytes, std::vector<std::string>& warnings) {
        chunk_ = parse(chunk_bytes);
        chunk_.obj.face_begin.push_back(chunk_.obj.corners.size());
        check_forward_references();
        warn_of_rest(warnings);
        if (chunk_.obj.face_count() == 0) fail_without_faces();
        return std::move(chunk_.obj);
    }

private:
    ObjChunk parse(std::size_t chunk_bytes) {
        std::vector<ObjRange> ranges = split_lines(text_.view(), chunk_bytes);
        std::optional<std::vector<ObjChunk>> chunks;
        if (ranges.size() > 1) chunks = parse_side_by_side(ranges);
        if (!chunks) {
            bytes_read_ = 0;
            chunks.emplace();
            chunks->push_back(parse_range({0, text_.view().size(), {}, {}}));
        }
        ChunkJoiner joiner;
        if (chunks->size() > 1) joiner.reserve(*chunks);
        for (ObjChunk& chunk : *chunks)
            joiner.add(std::move(chunk));
        return joiner.take();
    }

    // Nothing if something is wrong: who reads from the beginning finds out what is, and where.
    std::optional<std::vector<ObjChunk>> parse_side_by_side(std::vector<ObjRange>& ranges) {
        count_vertices(text_.view(), ranges);
        std::vector<ObjChunk> chunks(ranges.size());
        try {
            parallel_for(ranges.size(), 0, {},
                         [&](std::size_t i) { chunks[i] = parse_range(ranges[i]); });
        } catch (const FileError&) {
            return std::nullopt;
        }
        if (!fit_together(ranges, chunks)) return std::nullopt;
        return chunks;
    }

    ObjChunk parse_range(const ObjRange& range) {
        return parse_obj_chunk(file_, text_.view(), range, [this](std::size_t bytes) {
            const std::size_t read = bytes_read_.fetch_add(bytes) + bytes;
            load_step(options_,
                      0.6f * static_cast<float>(read) / static_cast<float>(text_.view().size()));
        });
    }

    [[nodiscard]] TextScanner scanner() const { return {file_, text_.view(), true}; }

    void check_forward_references() const {
        for (std::size_t kind = 0; kind < chunk_.forward.size(); ++kind) {
            const ForwardReference& furthest = chunk_.forward[kind];
            const std::size_t count = count_of(chunk_.obj, kind);
            if (furthest.word.empty() || furthest.index < count) continue;
            scanner().fail_at(furthest.offset, out_of_range(kind, furthest.word, count));
        }
    }

    void warn_of_rest(std::vector<std::string>& warnings) const {
        const auto warn = [&](const Note& what, const std::string& text) {
            if (what.count == 0) return;
            const std::string more = what.count > 1 ? fmt::format(" ({} times)", what.count) : "";
            warnings.push_back(scanner().place(what.first, text + more));
        };
        const ObjNotes& notes = chunk_.notes;
        warn(notes.lines_and_points, "lines and points are not shown");
        warn(notes.free_forms, "free-form curves and surfaces are not read");
        warn(notes.short_faces, "a face with fewer than 3 corners is left out");
        warn(notes.misplaced_signs,
             "the sign stands before the exponent's e: read as if behind it");
        warn(notes.unknown,
             fmt::format("{} is no OBJ keyword that we know: ignored", notes.unknown_word));
    }

    [[noreturn]] void fail_without_faces() const {
        const ObjNotes& notes = chunk_.notes;
        if (notes.unknown.count > 0) {
            scanner().fail_at(notes.unknown.first,
                              notes.unknown_word + " is no OBJ keyword, and no face follows");
        }
        if (notes.short_faces.count > 0) {
            scanner().fail_at(notes.short_faces.first,
                              "a face with fewer than 3 corners, and there is no other face");
        }
        throw FileError(file_, fmt::format("has {} vertices but no faces: nothing to show",
                                           chunk_.obj.positions.size()));
    }

    FileText text_;
    std::string file_;
    const LoadOptions& options_;
    std::atomic<std::size_t> bytes_read_{0};
    ObjChunk chunk_;
};

}  // namespace

ObjFile parse_obj(const std::filesystem::path& file, const LoadOptions& options,
                  std::vector<std::string>& warnings, std::size_t chunk_bytes) {
    return ObjReader(file, options).read(chunk_bytes, warnings);
}

}  // namespace raypick
