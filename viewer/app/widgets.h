// Small pieces that the panels are put together from.
#pragma once

#include <string>
#include <string_view>

namespace raypick {

// A heading over a part of a panel.
void draw_heading(const char* text);
// Text that breaks at the panel's edge.
void draw_text(std::string_view text);
void draw_dim_text(std::string_view text);
void draw_error_text(std::string_view text);

// A two-column table of names and values: begin, rows, end.
bool begin_values(const char* id);
void draw_value(const char* name, const std::string& value);
void end_values();

// A button as wide as the panel; `lit` shows that what it switches is on.
bool draw_wide_button(const char* label, bool lit = false);

// "1.23 M": a count with three digits.
std::string short_count(double count);
// "12.3 ms", "4.56 s".
std::string short_time(double seconds);

}  // namespace raypick
