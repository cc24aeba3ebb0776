// What is selected.
#pragma once

#include "picking/pick.h"

#include <vector>

namespace raypick {

// Objects in the order they were selected, each with the pick that selected it.
class Selection {
public:
    struct Entry {
        ObjectId object = kNoObject;
        PixelPick pick;
    };

    // What a click does: a plain one selects just this object (none on background); with `add`
    // (Shift) it adds the object, removes it if it was selected already, and background changes
    // nothing. Returns true if anything changed.
    bool click(const PixelPick& pick, bool add);
    void clear();

    [[nodiscard]] bool contains(ObjectId object) const;
    [[nodiscard]] bool empty() const { return entries_.empty(); }
    [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
    // The one selected last; nullptr if empty.
    [[nodiscard]] const Entry* primary() const;

private:
    std::vector<Entry> entries_;
};

}  // namespace raypick
