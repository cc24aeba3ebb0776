// The program behind the window: brings events, scene, tracer and panels together.
#pragma once

#include "picking/selection.h"
#include "viewer/app/document.h"
#include "viewer/app/document_trees.h"
#include "viewer/app/file_saver.h"
#include "viewer/app/layout.h"
#include "viewer/app/overlays.h"
#include "viewer/app/scene_view.h"
#include "viewer/app/ui_session.h"
#include "viewer/app/view.h"
#include "viewer/app/window.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace raypick {

class App {
public:
    // `window` feeds `input`; both must outlive the app. The opener may have begun with a file.
    App(const ViewOptions& options, Window& window, InputState& input,
        std::unique_ptr<DocumentOpener> opener);

    // Until the window is closed.
    void run();

private:
    // What the cursor rests on, and when that was found out.
    struct Hover {
        std::optional<Pixel> sampled;  // the pixel whose sample is shown under the cursor
        std::optional<ShownFrame> frame;
        bool asked = false;  // there was a tree to ask
        std::optional<PixelPick> pick;
    };

    // A click that no tree was there to answer.
    struct WaitingClick {
        PickQuestion question;
        bool add = false;
    };

    void step();
    void show_frame();
    // Draws a few frames, until everything that changed is on the screen.
    void settle();
    [[nodiscard]] bool working() const;
    [[nodiscard]] double patience() const;

    void open(const std::filesystem::path& file);
    void take_results();
    void take(Document document);
    void update_trees();
    void answer_clicks();
    [[nodiscard]] Camera first_camera(const Scene& scene);
    void complain(const std::string& title, const std::string& text);

    void apply(const OrbitAction& action);
    void apply(const PanAction& action);
    void apply(const ZoomAction& action);
    void apply(const ClickAction& action);
    void apply(const OpenAction& action);
    void apply(Command command);
    void escape();
    void copy_view();
    void toggle_help();
    void frame_selected();
    void ask_for_picture_name();
    void ask_for_scene_name();
    void save_file(const PathDialog& dialog, const std::filesystem::path& file);
    void save_picture(const std::filesystem::path& file);
    [[nodiscard]] std::string picture_stem() const;
    // Of the shown frame.
    [[nodiscard]] std::string picture_description() const;

    void update_hover();
    void draw();
    void draw_panels();
    void draw_side_panel();
    void draw_loading();
    void draw_dialog();
    [[nodiscard]] std::vector<ObjectId> selected_objects() const;
    [[nodiscard]] std::string hover_text() const;
    [[nodiscard]] std::string view_text() const;
    [[nodiscard]] std::string title() const;
    [[nodiscard]] UiRegion view_region() const;
    void remember_screen();

    ViewOptions options_;
    Window& window_;
    InputState& input_;
    double ui_scale_;
    UiSession ui_;
    SceneView view_;
    std::unique_ptr<DocumentOpener> opener_;
    DocumentTrees trees_;
    FileSaver saver_;

    std::optional<Document> document_;
    ObjectId next_object_id_ = 0;
    Selection selection_;
    std::vector<WaitingClick> clicks_;  // oldest first
    Hover hover_;
    RenderSettings settings_;
    bool trace_ = false;
    bool panels_ = true;
    Layout layout_;
    std::optional<UiRegion> load_card_;
    Overlay overlay_;
    bool confirm_ = false;  // Enter was pressed since the last frame
    std::string message_;   // of the last thing done, for the status bar
    bool quit_ = false;
    int frames_due_ = 0;
    std::optional<ShownFrame> drawn_;  // what the window shows
    bool waits_for_picture_ = false;   // nothing else has changed
};

}  // namespace raypick
