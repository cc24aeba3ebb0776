#include "tracer/io/texture_library.h"

#include "tracer/error.h"
#include "tracer/io/file_bytes.h"
#include "tracer/io/load_steps.h"
#include "tracer/io/texture_file.h"
#include "tracer/parallel/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <new>
#include <set>

namespace raypick {

namespace {

// Runs work(i) for each i in parallel and reports progress from begin to end.
void in_parallel(std::size_t count, const LoadOptions& options, float begin, float end,
                 const std::function<void(std::size_t)>& work) {
    std::atomic<std::size_t> done{0};
    parallel_for(count, 0, options.stop, [&](std::size_t i) {
        work(i);
        const std::size_t finished = done.fetch_add(1) + 1;
        load_step(options,
                  begin + (end - begin) * static_cast<float>(finished) / static_cast<float>(count));
    });
    load_step(options, end);
}

std::shared_ptr<ByteImage> placeholder_image() {
    const std::shared_ptr<const TexturePixels> pixels = placeholder_texture();
    const TextureLevel& level = pixels->levels.front();
    const auto count = static_cast<std::ptrdiff_t>(level.rows) * level.cols;
    return std::make_shared<ByteImage>(ByteImage{
        level.rows, level.cols, {pixels->texels.begin(), pixels->texels.begin() + count}});
}

}  // namespace

TextureLibrary::ImageNumber TextureLibrary::image(ImageSource source, TexelCoding coding) {
    const auto [known, is_new] =
        numbers_.try_emplace(std::pair(source.name, coding), entries_.size());
    if (is_new) entries_.push_back({std::move(source), coding, nullptr, "", false});
    return known->second;
}

void TextureLibrary::decode(Entry& entry) {
    try {
        if (!entry.source.problem.empty()) throw Error(entry.source.problem);
        FileBytes file;
        if (!entry.source.file.empty()) file = read_file(entry.source.file);
        entry.pixels = std::make_shared<ByteImage>(
            as_bytes(decode_image(entry.source.file.empty() ? entry.source.bytes : file.view()),
                     entry.coding));
    } catch (const FileError& error) {
        // Without the file's name, which the warning says itself.
        entry.complaint = std::string(error.what()).substr(error.file().size() + 2);
    } catch (const Error& error) {
        entry.complaint = error.what();
    } catch (const std::bad_alloc&) {
        entry.complaint = "needs more memory than there is";
    }
}

void TextureLibrary::decode(const LoadOptions& options, float progress_begin, float progress_end) {
    in_parallel(entries_.size(), options, progress_begin, progress_end,
                [&](std::size_t i) { decode(entries_[i]); });
    std::shared_ptr<ByteImage> placeholder;
    std::set<std::string> told;
    for (Entry& entry : entries_) {
        if (entry.pixels) continue;
        if (!placeholder) placeholder = placeholder_image();
        entry.broken = true;
        entry.pixels = placeholder;
        if (!told.insert(entry.source.name).second) continue;
        target_->warnings.push_back(
            fmt::format("{}: the texture \"{}\" {}: a magenta checker is "
                        "shown where it would give a colour",
                        entry.source.place, entry.source.name, entry.complaint));
    }
}

TextureId TextureLibrary::texture(ImageNumber image) {
    const Entry& entry = entries_[image];
    const char* const coding = entry.coding == TexelCoding::srgb ? "colour" : "data";
    const std::string key =
        entry.broken ? "placeholder" : fmt::format("{} {}", coding, entry.source.name);
    const TexelCoding shown = entry.broken ? TexelCoding::srgb : entry.coding;
    const TextureId id = texture_of(key, {kNoTexture, shown, nullptr, entry.pixels});
    Texture& texture = target_->scene.textures[id];
    texture.name = entry.broken ? "missing" : clean_name(entry.source.name);
    if (!entry.broken) std::get<ImageTexture>(texture.source).file = entry.source.file;
    return id;
}

TextureId TextureLibrary::baked(const std::string& key, TexelCoding coding,
                                std::function<ByteImage()> bake) {
    return texture_of(key, {kNoTexture, coding, std::move(bake)});
}

TextureId TextureLibrary::texture_of(const std::string& key, Job job) {
    const auto [known, is_new] = textures_.try_emplace(key, kNoTexture);
    if (is_new) {
        known->second = add_texture(target_->scene, Texture{clean_name(key), ImageTexture{}});
        job.texture = known->second;
        jobs_.push_back(std::move(job));
    }
    return known->second;
}

ByteImage TextureLibrary::image_of(Job& job) {
    if (job.as_it_is) return job.last ? std::move(*job.as_it_is) : *job.as_it_is;
    ByteImage image = job.bake();
    job.bake = nullptr;  // and with it the images that it looked at
    return image;
}

void TextureLibrary::make(const LoadOptions& options, float progress_begin, float progress_end) {
    entries_.clear();
    numbers_.clear();
    for (Job& job : jobs_)
        job.last = job.as_it_is.use_count() == 1;
    in_parallel(jobs_.size(), options, progress_begin, progress_end, [&](std::size_t i) {
        Job& job = jobs_[i];
        ByteImage image = image_of(job);
        job.as_it_is.reset();
        std::get<ImageTexture>(target_->scene.textures[job.texture].source).pixels =
            make_texture_pixels(image.rows, image.cols, std::move(image.texels), job.coding);
    });
    jobs_.clear();
}

bool is_uniform(const ByteImage& image, int channel) {
    std::uint8_t least = 255;
    std::uint8_t most = 0;
    for (const glm::u8vec4& c : image.texels) {
        least = std::min(least, c[channel]);
        most = std::max(most, c[channel]);
    }
    return most - least <= 1;
}

bool is_grey(const ByteImage& image) {
    return std::all_of(image.texels.begin(), image.texels.end(),
                       [](const glm::u8vec4& c) { return c.x == c.y && c.y == c.z; });
}

bool is_nearly_binary(const ByteImage& image, int channel) {
    constexpr int kClose = 25;  // a tenth
    const auto between = std::count_if(
        image.texels.begin(), image.texels.end(),
        [&](const glm::u8vec4& c) { return c[channel] > kClose && c[channel] < 255 - kClose; });
    // Smooth edges of leaves take up to a quarter of a small image.
    return static_cast<std::size_t>(between) * 4 <= image.texels.size();
}

ByteImage luminance(const ByteImage& image) {
    ByteImage grey{image.rows, image.cols, {}};
    grey.texels.reserve(image.texels.size());
    for (const glm::u8vec4& c : image.texels) {
        const double y = 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
        const auto byte = static_cast<std::uint8_t>(std::lround(y));
        grey.texels.emplace_back(byte, byte, byte, c.w);
    }
    return grey;
}

}  // namespace raypick
