// Walks over a text file word by word; works out the line number only when it is asked for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace raypick {

// A number in the C locale, however it is spelled: leading '+', exponents, nan, inf (also as
// Microsoft prints them: 1.#INF, -1.#IND). Nothing if `word` is not just a number.
std::optional<double> parse_number(std::string_view word);

// Line ends are LF; CR counts as a blank. Words end at blanks.
class TextScanner {
public:
    // `continuation`: a backslash at a line's end joins it with the next one (OBJ). The text must
    // outlive the scanner and may be part of a file that begins `first_line` - 1 lines earlier.
    TextScanner(std::string file, std::string_view text, bool continuation = false,
                std::size_t first_line = 1);

    [[nodiscard]] bool at_end() const { return p_ == end_; }
    // After the blanks: is nothing left on this line?
    [[nodiscard]] bool at_line_end();
    // Bytes from the text's beginning.
    [[nodiscard]] std::size_t offset() const { return static_cast<std::size_t>(p_ - begin_); }

    [[nodiscard]] std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - p_); }

    // The next character after the blanks; LF at the line's or the text's end.
    [[nodiscard]] char peek();
    // Goes back to an offset.
    void return_to(std::size_t offset) { p_ = begin_ + offset; }

    // The next word of this line; empty at its end.
    std::string_view word();
    // The next word of this or a later line; empty at the text's end.
    std::string_view word_anywhere();
    // What is left of the line, without the blanks around it. Stays on the line. Joins no lines,
    // because names may end in a backslash.
    std::string_view rest();
    // Goes to the beginning of the next line. Joins none.
    void next_line();

    // The next word of this line as a number, NaN and infinities included.
    double number(std::string_view what);
    // The same, but nothing (and the scanner stays) if the word is no number or there is none.
    std::optional<double> try_number();

    // Throws FileError: "FILE: line N: complaint". The line is that of the last word read, or of
    // the byte given.
    [[noreturn]] void fail(const std::string& complaint) const;
    [[noreturn]] void fail_at(std::size_t offset, const std::string& complaint) const;
    // "FILE: line N: complaint", for a warning.
    [[nodiscard]] std::string place(std::size_t offset, const std::string& complaint) const;
    [[nodiscard]] std::string place(const std::string& complaint) const;
    [[nodiscard]] std::size_t line(std::size_t offset) const;
    [[nodiscard]] const std::string& file() const { return file_; }

private:
    void skip_blanks();
    // Byte length of a line continuation at p_; 0 if there is none.
    [[nodiscard]] std::size_t continuation_length() const;

    std::string file_;
    const char* begin_;
    const char* p_;
    const char* end_;
    const char* last_word_;  // for messages
    bool continuation_;
    std::size_t first_line_;
};

// A word of the file as a message shows it: in quotes, shortened, one line.
std::string in_quotes(std::string_view word);

inline bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

inline void TextScanner::skip_blanks() {
    while (p_ != end_) {
        if (is_blank(*p_)) {
            ++p_;
        } else if (*p_ == '\\' && continuation_ && continuation_length() > 0) {
            p_ += continuation_length();
        } else {
            return;
        }
    }
}

inline bool TextScanner::at_line_end() {
    skip_blanks();
    return p_ == end_ || *p_ == '\n';
}

inline char TextScanner::peek() {
    skip_blanks();
    return p_ == end_ ? '\n' : *p_;
}

inline std::string_view TextScanner::word() {
    skip_blanks();
    last_word_ = p_;
    while (p_ != end_ && *p_ != '\n' && !is_blank(*p_)) {
        if (*p_ == '\\' && continuation_ && continuation_length() > 0) break;
        ++p_;
    }
    return {last_word_, static_cast<std::size_t>(p_ - last_word_)};
}

}  // namespace raypick
