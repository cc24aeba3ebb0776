#include "tracer/io/references.h"

#include "tracer/io/scene_numbers.h"

#include <fmt/format.h>

namespace raypick {

void References::add_listed(const std::string& name, std::uint32_t id) {
    listed_.push_back(id);
    if (!name.empty()) add_named(name, id);
}

void References::add_named(const std::string& name, std::uint32_t id) {
    named_[name].push_back(id);
}

std::uint32_t References::read(const JsonValue& value) const {
    if (value.is_string()) return by_name(value);
    const std::string name_words = fmt::format("the name of a {}", kind_);
    if (listed_.empty()) value.refuse(name_words);
    const std::size_t last = listed_.size() - 1;
    const std::string words = fmt::format("{} or its number, 0 to {}", name_words, last);
    const NumberRule rule{0.0, static_cast<double>(last), true, words};
    return listed_[static_cast<std::size_t>(value.whole_number(rule))];
}

std::uint32_t References::by_name(const JsonValue& value) const {
    const std::string& name = value.text();
    const auto found = named_.find(name);
    if (found == named_.end()) {
        Keys known;
        for (const auto& entry : named_)
            known.push_back(entry.first);
        value.fail(fmt::format("there is no {} \"{}\"{}", kind_, name, did_you_mean(name, known)));
    }
    if (found->second.size() > 1) {
        value.fail(fmt::format("there are {} {}s called \"{}\": say which by its number",
                               found->second.size(), kind_, name));
    }
    return found->second[0];
}

}  // namespace raypick
