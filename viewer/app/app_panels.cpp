// What the app draws: the view, the panels around it, the words in them.
#include "viewer/app/app.h"
#include "viewer/app/panels.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include <utility>

namespace raypick {

void App::draw() {
    const WindowMetrics& metrics = layout_.window;
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, metrics.framebuffer_cols, metrics.framebuffer_rows);
    glClearColor(0.10f, 0.11f, 0.12f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    // The status bar names what the cursor is on; an outline is for what is selected.
    view_.present(layout_.view, metrics.framebuffer_rows, selected_objects());
    ui_.begin_frame();
    draw_panels();
    ui_.end_frame();
    window_.swap();
}

void App::draw_panels() {
    if (panels_) {
        draw_side_panel();
        draw_status_bar({hover_text(), message_.empty() ? view_text() : message_},
                        layout_.status_bar);
    }
    draw_loading();
    if (!document_ && !load_card_) draw_empty_hint(view_region());
    draw_dialog();
}

void App::draw_side_panel() {
    begin_side_panel(layout_.side_panel);
    draw_scene_panel(document_ ? &*document_ : nullptr, trees_.progress());
    const std::optional<Command> command = draw_selection_panel(selection_);
    RenderSettings edited = settings_;
    const TracePanel panel{trace_, document_.has_value(), saver_.busy(), view_.trace_status()};
    const std::optional<TraceRequest> request = draw_trace_panel(panel);
    if (draw_trace_settings(edited)) settings_ = edited;
    end_side_panel();
    if (command) apply(*command);
    if (request == TraceRequest::toggle) apply(Command::toggle_trace);
    if (request == TraceRequest::cancel) view_.cancel_trace();
    if (request == TraceRequest::save) apply(Command::save);
}

void App::draw_loading() {
    load_card_.reset();
    const std::optional<OpenProgress> progress = opener_->progress();
    if (!progress) return;
    const LoadCard card = draw_load_card(*progress, view_region(), !document_);
    load_card_ = card.place;
    if (card.cancelled) opener_->cancel();
}

void App::draw_dialog() {
    // Confirmed only now, after what was typed before Enter has reached the text field.
    const OverlayAnswer answer = draw_overlay(overlay_, std::exchange(confirm_, false));
    if (answer.name) {
        const PathDialog dialog = std::get<PathDialog>(std::exchange(overlay_, std::monostate{}));
        if (dialog.purpose == PathDialog::Purpose::open) {
            open(*answer.name);
        } else {
            save_file(dialog, *answer.name);
        }
    } else if (answer.close) {
        overlay_ = std::monostate{};
    }
}

UiRegion App::view_region() const {
    const WindowMetrics& window = layout_.window;
    return {0.0, 0.0, window.window_width - layout_.side_panel.width,
            window.window_height - layout_.status_bar.height};
}

std::string App::hover_text() const {
    if (!clicks_.empty()) return "The click is answered as soon as the tree is there";
    if (!hover_.pick) return "";
    if (!hover_.pick->pick) return "background";
    const Pick& pick = *hover_.pick->pick;
    return pick.material.empty() ? pick.object
                                 : fmt::format("{}  ({})", pick.object, pick.material);
}

std::string App::view_text() const {
    if (!view_.shown()) return "F1 help";
    const ShownFrame& frame = *view_.shown();
    const bool parallel = frame.camera.projection == Projection::orthographic;
    return fmt::format("{}{}   {} x {}   F1 help", parallel ? "orthographic   " : "",
                       frame.traced ? "ray traced" : "OpenGL", frame.size.cols, frame.size.rows);
}

std::string App::title() const {
    std::string title = "raypick";
    if (document_) title += " - " + document_->file.filename().string();
    if (const std::optional<OpenProgress> progress = opener_->progress()) {
        return title + " - opening " + progress->file.filename().string();
    }
    if (std::holds_alternative<MessageBox>(overlay_)) return title + " - error";
    if (const auto* dialog = std::get_if<PathDialog>(&overlay_)) {
        const bool saving = dialog->purpose != PathDialog::Purpose::open;
        // Named once one can type.
        if (ui_.typing()) return title + (saving ? " - save" : " - open");
    }
    switch (view_.trace_status().state) {
        case PreviewStatus::State::off:
            return title;
        case PreviewStatus::State::tracing:
            return title + " - tracing";
        case PreviewStatus::State::finished:
            return title + " - traced";
        case PreviewStatus::State::cancelled:
            return title + " - stopped";
        case PreviewStatus::State::failed:
            return title + " - failed";
    }
    return title;
}

}  // namespace raypick
