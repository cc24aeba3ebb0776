#include "picking/selection.h"

#include <algorithm>

namespace raypick {
namespace {

bool same_pick(const PixelPick& a, const PixelPick& b) {
    if (a.pixel != b.pixel || a.pick.has_value() != b.pick.has_value()) return false;
    return !a.pick || a.pick->hit == b.pick->hit;
}

}  // namespace

bool Selection::click(const PixelPick& pick, bool add) {
    if (!pick.pick) {
        if (add || empty()) return false;
        clear();
        return true;
    }
    const ObjectId object = pick.pick->hit.object;
    if (!add) {
        const bool changed = entries_.size() != 1 || entries_[0].object != object ||
                             !same_pick(entries_[0].pick, pick);
        entries_ = {Entry{object, pick}};
        return changed;
    }
    const auto selected = [object](const Entry& entry) { return entry.object == object; };
    if (std::erase_if(entries_, selected) == 0) entries_.push_back({object, pick});
    return true;
}

void Selection::clear() {
    entries_.clear();
}

bool Selection::contains(ObjectId object) const {
    return std::any_of(entries_.begin(), entries_.end(),
                       [object](const Entry& entry) { return entry.object == object; });
}

const Selection::Entry* Selection::primary() const {
    return entries_.empty() ? nullptr : &entries_.back();
}

}  // namespace raypick
