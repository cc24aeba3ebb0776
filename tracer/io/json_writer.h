// JSON written piece by piece, so that large files need no copy of themselves in memory.
#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace raypick {

class JsonWriter {
public:
    // What is written goes to `out`, which must outlive this, in large pieces.
    explicit JsonWriter(std::ostream& out) : out_(out) {}

    // Objects and arrays: `on_one_line` for short ones.
    void open_object(bool on_one_line = false) { open('{', on_one_line); }
    void close_object() { close('}'); }
    void open_array(bool on_one_line = false) { open('[', on_one_line); }
    void close_array() { close(']'); }

    // In objects: before each value.
    void key(std::string_view name);

    void text(std::string_view value);
    // The shortest decimal that is read back as the same bits. Finite.
    void number(double value);
    void number(float value);
    void whole_number(std::uint64_t value);
    void truth(bool value);
    // A text: the base64 of bytes.
    void base64(std::string_view bytes);

    // Ends the text. Writes what is left.
    void finish();

private:
    struct Level {
        bool on_one_line = false;
        bool empty = true;
    };

    void open(char bracket, bool on_one_line);
    void close(char bracket);
    void begin_value();
    void begin_line();
    void flush_if_large();

    std::ostream& out_;
    std::string buffer_;
    std::vector<Level> levels_;
    bool after_key_ = false;
};

}  // namespace raypick
