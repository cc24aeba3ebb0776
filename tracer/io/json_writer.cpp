#include "tracer/io/json_writer.h"

#include "tracer/io/base64.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

namespace raypick {

namespace {

constexpr std::size_t kFlushSize = 1u << 16u;
constexpr std::size_t kBase64Piece = std::size_t{3} << 14u;  // bytes: a multiple of three

bool is_negative_zero(double value) {
    return value == 0.0 && std::signbit(value);
}

// Is this decimal, read as a double and rounded to float, this float? Rounding twice might err.
bool reads_as(const std::string& decimal, float value) {
    double read = 0.0;
    std::from_chars(decimal.data(), decimal.data() + decimal.size(), read);
    return static_cast<float>(read) == value;
}

}  // namespace

void JsonWriter::key(std::string_view name) {
    begin_value();
    buffer_ += fmt::format("\"{}\": ", name);
    after_key_ = true;
}

void JsonWriter::text(std::string_view value) {
    begin_value();
    constexpr int kNoIndent = -1;
    constexpr bool kAscii = false;
    // Bytes that are no UTF-8 become U+FFFD.
    buffer_ += nlohmann::json(value).dump(kNoIndent, ' ', kAscii,
                                          nlohmann::json::error_handler_t::replace);
    flush_if_large();
}

void JsonWriter::number(double value) {
    begin_value();
    // A whole number would be read as an integer, which has no -0.
    buffer_ += is_negative_zero(value) ? "-0.0" : fmt::format("{}", value);
    flush_if_large();
}

void JsonWriter::number(float value) {
    const std::string shortest = fmt::format("{}", value);
    if (is_negative_zero(value) || !reads_as(shortest, value)) {
        number(static_cast<double>(value));
        return;
    }
    begin_value();
    buffer_ += shortest;
}

void JsonWriter::whole_number(std::uint64_t value) {
    begin_value();
    buffer_ += fmt::format("{}", value);
}

void JsonWriter::truth(bool value) {
    begin_value();
    buffer_ += value ? "true" : "false";
}

void JsonWriter::base64(std::string_view bytes) {
    begin_value();
    buffer_ += '"';
    for (std::size_t at = 0; at < bytes.size(); at += kBase64Piece) {
        append_base64(buffer_, bytes.substr(at, kBase64Piece));
        flush_if_large();
    }
    buffer_ += '"';
}

void JsonWriter::finish() {
    buffer_ += '\n';
    out_ << buffer_;
    buffer_.clear();
}

void JsonWriter::open(char bracket, bool on_one_line) {
    begin_value();
    buffer_ += bracket;
    const bool within_one = !levels_.empty() && levels_.back().on_one_line;
    levels_.push_back({on_one_line || within_one, true});
}

void JsonWriter::close(char bracket) {
    const Level level = levels_.back();
    levels_.pop_back();
    if (!level.on_one_line && !level.empty) begin_line();
    buffer_ += bracket;
    flush_if_large();
}

void JsonWriter::begin_value() {
    if (after_key_) {
        after_key_ = false;
        return;
    }
    if (levels_.empty()) return;
    Level& level = levels_.back();
    if (!level.empty) buffer_ += level.on_one_line ? ", " : ",";
    level.empty = false;
    if (!level.on_one_line) begin_line();
}

void JsonWriter::begin_line() {
    buffer_ += '\n';
    buffer_.append(4 * levels_.size(), ' ');
}

void JsonWriter::flush_if_large() {
    if (buffer_.size() < kFlushSize) return;
    out_ << buffer_;
    buffer_.clear();
}

}  // namespace raypick
