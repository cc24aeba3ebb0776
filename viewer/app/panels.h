// The parts of the user interface. Each draws one thing between a frame's begin and end and says
// what was asked for; none of them changes anything but what it is given by reference.
#pragma once

#include "picking/selection.h"
#include "tracer/accel/background_build.h"
#include "viewer/app/document.h"
#include "viewer/app/layout.h"
#include "viewer/app/preview.h"

#include <optional>
#include <string>

namespace raypick {

// What is open: name, counts, times, its trees, warnings. `document` may be nullptr.
void draw_scene_panel(const Document* document, const BuildProgress& trees);

// What the last click found, or how to begin.
std::optional<Command> draw_selection_panel(const Selection& selection);

struct TracePanel {
    bool on = false;
    bool can_trace = false;  // a scene is open
    bool saving = false;
    PreviewStatus status;
};
enum class TraceRequest { toggle, cancel, save };
// The settings of a ray-traced frame; true if they were edited.
bool draw_trace_settings(RenderSettings& settings);
std::optional<TraceRequest> draw_trace_panel(const TracePanel& panel);

struct StatusBar {
    std::string left;   // what the cursor is on
    std::string right;  // the view
};
void draw_status_bar(const StatusBar& bar, const UiRegion& place);

// In the middle of the view as long as nothing is open.
void draw_empty_hint(const UiRegion& view);

struct LoadCard {
    UiRegion place;  // what it covered
    bool cancelled = false;
};
// What is being opened: in the view's middle if it is empty, else in its corner.
LoadCard draw_load_card(const OpenProgress& progress, const UiRegion& view, bool in_middle);

// Opens the side panel, whose parts are drawn next; end_side_panel closes it.
void begin_side_panel(const UiRegion& place);
void end_side_panel();

}  // namespace raypick
