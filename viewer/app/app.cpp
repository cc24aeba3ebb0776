#include "viewer/app/app.h"

#include "viewer/app/view_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <numbers>
#include <utility>

namespace raypick {

namespace {

// ImGui needs a few frames to answer an event: hover, press, lay out, show.
constexpr int kSettlingFrames = 3;
// A person who drags something wants to see as much.
constexpr double kFrameSeconds = 1.0 / 30.0;
// Dragging over the view's whole height turns by half a turn.
constexpr double kOrbitRadians = std::numbers::pi;

double chosen_scale(double wanted, const Window& window) {
    return std::clamp(wanted > 0.0 ? wanted : window.content_scale(), 0.5, 6.0);
}

// Of a command that looks from one.
ViewSide side_of(Command command) {
    switch (command) {
        case Command::view_back:
            return ViewSide::back;
        case Command::view_right:
            return ViewSide::right;
        case Command::view_left:
            return ViewSide::left;
        case Command::view_top:
            return ViewSide::top;
        case Command::view_bottom:
            return ViewSide::bottom;
        default:
            return ViewSide::front;
    }
}

// True if there are some and all of them move the camera.
bool only_move(const std::vector<InputAction>& actions) {
    return !actions.empty() &&
           std::all_of(actions.begin(), actions.end(), [](const InputAction& action) {
               return std::holds_alternative<OrbitAction>(action) ||
                      std::holds_alternative<PanAction>(action) ||
                      std::holds_alternative<ZoomAction>(action);
           });
}

}  // namespace

App::App(const ViewOptions& options, Window& window, InputState& input,
         std::unique_ptr<DocumentOpener> opener)
    : options_(options),
      window_(window),
      input_(input),
      ui_scale_(chosen_scale(options.ui_scale, window)),
      ui_(window, ui_scale_),
      view_(Window::wake),
      opener_(std::move(opener)),
      trees_(Window::wake),
      saver_(Window::wake),
      trace_(options.trace) {
    settings_.depth = options.depth;
    layout_ = lay_out(window_.metrics(), ui_scale_, panels_);
    settle();
}

void App::run() {
    while (!quit_ && !window_.close_wanted()) {
        if (window_.wait(frames_due_ > 0 && !waits_for_picture_ ? 0.0 : patience())) settle();
        if (working() || trees_.news() || ui_.typing()) frames_due_ = std::max(frames_due_, 1);
        if (frames_due_ == 0) continue;
        --frames_due_;
        step();
    }
    // What still runs is given up; nobody should have to watch it end.
    window_.hide();
}

void App::settle() {
    frames_due_ = kSettlingFrames;
}

bool App::working() const {
    return opener_->progress().has_value() || saver_.busy() || view_.busy();
}

double App::patience() const {
    if (waits_for_picture_) return kFrameSeconds;
    if (working()) return 0.1;
    return ui_.typing() ? 0.3 : 60.0;  // a text cursor blinks
}

void App::step() {
    take_results();
    const std::vector<InputAction> actions = input_.take_actions();
    for (const InputAction& action : actions)
        std::visit([this](const auto& what) { apply(what); }, action);
    layout_ = lay_out(window_.metrics(), ui_scale_, panels_);
    view_.prepare(layout_.view.size, trace_ ? &settings_ : nullptr);
    // Drawing the old picture again would only take time from the one of the moved camera.
    waits_for_picture_ = only_move(actions) && view_.awaits_picture() && view_.shown() == drawn_;
    if (!waits_for_picture_) show_frame();
    update_trees();
}

void App::show_frame() {
    update_hover();
    draw();
    drawn_ = view_.shown();
    window_.set_title(title());
    remember_screen();
}

void App::remember_screen() {
    ScreenState screen;
    screen.view = layout_.view;
    screen.ui = {layout_.side_panel, layout_.status_bar};
    if (load_card_) screen.ui.push_back(*load_card_);
    screen.modal = !std::holds_alternative<std::monostate>(overlay_);
    screen.typing = ui_.typing();
    input_.set_screen(std::move(screen));
}

void App::open(const std::filesystem::path& file) {
    opener_->open(file, options_.crease_degrees, next_object_id_);
}

void App::take_results() {
    if (std::optional<OpenResult> result = opener_->take_result()) {
        settle();
        if (auto* document = std::get_if<Document>(&*result)) {
            take(std::move(*document));
        } else {
            complain("This file can't be opened", std::get<OpenFailure>(*result).message);
        }
    }
    if (const std::optional<SaveResult> result = saver_.take_result()) {
        settle();
        if (result->error.empty()) {
            message_ = fmt::format("Saved {}", std::filesystem::absolute(result->file).string());
        } else {
            message_.clear();
            complain(result->kind == SaveKind::scene ? "The scene can't be saved"
                                                     : "The picture can't be saved",
                     result->error);
        }
    }
}

void App::take(Document document) {
    try {
        view_.set_scene(document.scene, document.bounds, first_camera(*document.scene));
    } catch (const Error& error) {
        complain("This scene can't be shown", error.what());
        if (!document_) return;
        view_.set_scene(document_->scene, document_->bounds, view_.camera().camera());
        view_.set_accel(trees_.progress().accel);
        return;
    }
    trees_.set_scene(document.scene);
    next_object_id_ = std::max(next_object_id_, document.scene->next_object_id);
    selection_.clear();
    clicks_.clear();
    hover_ = {};
    message_.clear();
    document_ = std::move(document);
    std::vector<std::string> coarser = view_.warnings();
    std::move(coarser.begin(), coarser.end(), std::back_inserter(document_->warnings));
}

// After a frame, so that the first one of a scene is there before anything else is begun.
void App::update_trees() {
    if (!trees_.update(opener_->progress().has_value())) return;
    settle();
    const BuildProgress& trees = trees_.progress();
    view_.set_accel(trees.accel);
    answer_clicks();
    if (trees.error.empty()) return;
    if (trees.accel) {
        message_ = fmt::format("No better trees: {}. Picks and frames go on with the first ones",
                               trees.error);
    } else {
        clicks_.clear();
        complain("Nothing in this scene can be picked", trees.error);
    }
}

Camera App::first_camera(const Scene& scene) {
    const ImageSize view = layout_.view.size;
    const ImageSize size = view.rows > 0 && view.cols > 0 ? view : options_.size;
    // The camera that was asked for belongs to the file that was asked for.
    const CameraOverride wanted = std::exchange(options_.camera, {});
    try {
        return choose_camera(scene, size, wanted);
    } catch (const Error& error) {
        complain("This camera can't be used", error.what());
        return choose_camera(scene, size, {});
    }
}

void App::complain(const std::string& title, const std::string& text) {
    overlay_ = MessageBox{title, text};
}

void App::apply(const OrbitAction& action) {
    view_.camera().orbit(kOrbitRadians * action.right, kOrbitRadians * action.down);
}

void App::apply(const PanAction& action) {
    if (view_.shown()) view_.camera().pan(view_.shown()->size, action.from, action.to);
}

void App::apply(const ZoomAction& action) {
    view_.zoom(action.steps, action.at);
}

void App::apply(const ClickAction& action) {
    const std::optional<PickQuestion> question = view_.question(action.pixel);
    if (!question) return;
    message_.clear();
    clicks_.push_back({*question, action.add});
    answer_clicks();
}

void App::answer_clicks() {
    if (!trees_.progress().accel) return;
    for (const WaitingClick& click : std::exchange(clicks_, {})) {
        const std::optional<PixelPick> pick = view_.answer(click.question);
        if (!pick) continue;  // of another scene
        selection_.click(*pick, click.add);
        if (options_.print_picks) std::puts(to_json(*pick).c_str());
    }
    std::fflush(stdout);
}

void App::apply(const OpenAction& action) {
    open(action.file);
}

void App::apply(Command command) {
    switch (command) {
        case Command::frame_selected:
            frame_selected();
            break;
        case Command::frame_all:
            view_.frame_all();
            break;
        case Command::toggle_trace:
            trace_ = !trace_;
            break;
        case Command::toggle_projection:
            view_.camera().toggle_projection();
            break;
        case Command::view_front:
        case Command::view_back:
        case Command::view_right:
        case Command::view_left:
        case Command::view_top:
        case Command::view_bottom:
            view_.camera().look_from(side_of(command));
            break;
        case Command::copy_view:
            copy_view();
            break;
        case Command::escape:
            escape();
            break;
        case Command::confirm:
            confirm_ = true;
            break;
        case Command::toggle_help:
            toggle_help();
            break;
        case Command::toggle_panels:
            panels_ = !panels_;
            break;
        case Command::open:
            overlay_ = PathDialog{};
            break;
        case Command::save:
            ask_for_picture_name();
            break;
        case Command::save_scene:
            ask_for_scene_name();
            break;
        case Command::screenshot:
            save_picture(free_picture_name("", picture_stem()));
            break;
        case Command::quit:
            quit_ = true;
            break;
    }
}

void App::toggle_help() {
    if (std::holds_alternative<HelpSheet>(overlay_)) {
        overlay_ = std::monostate{};
    } else if (std::holds_alternative<std::monostate>(overlay_)) {
        overlay_ = HelpSheet{};
    }
}

void App::copy_view() {
    if (!view_.shown()) return;
    const ShownFrame& frame = *view_.shown();
    window_.set_clipboard(view_words(frame.camera, frame.scene->origin, frame.size));
    message_ = "Copied the view as command-line options";
}

void App::escape() {
    if (!std::holds_alternative<std::monostate>(overlay_)) {
        overlay_ = std::monostate{};
    } else if (view_.trace_status().state == PreviewStatus::State::tracing) {
        view_.cancel_trace();
    } else {
        selection_.clear();
        clicks_.clear();
    }
}

void App::frame_selected() {
    const Selection::Entry* primary = selection_.primary();
    if (primary == nullptr || !primary->pick.pick) {
        view_.frame_all();
        return;
    }
    view_.frame_objects(selected_objects(), primary->pick.pick->point);
}

std::string App::picture_stem() const {
    return document_ ? document_->file.stem().string() : std::string("raypick");
}

void App::ask_for_picture_name() {
    if (!view_.shown()) return;
    PathDialog dialog;
    dialog.purpose = PathDialog::Purpose::save_picture;
    dialog.name = picture_stem() + ".png";
    dialog.subject = picture_description();
    overlay_ = dialog;
}

void App::ask_for_scene_name() {
    if (!document_) return;
    PathDialog dialog;
    dialog.purpose = PathDialog::Purpose::save_scene;
    dialog.name = picture_stem() + ".json";
    dialog.subject = "The whole scene in one JSON file, with its meshes and textures.";
    overlay_ = dialog;
}

std::string App::picture_description() const {
    const ShownFrame& frame = *view_.shown();
    const PreviewStatus trace = view_.trace_status();
    std::string text =
        fmt::format("The {} picture, {} x {} pixels.", frame.traced ? "ray-traced" : "OpenGL",
                    frame.size.cols, frame.size.rows);
    if (frame.traced && trace.state != PreviewStatus::State::finished) {
        text += fmt::format(" It is unfinished: {} %.",
                            static_cast<int>(100 * trace.progress.fraction));
    }
    return text;
}

void App::save_file(const PathDialog& dialog, const std::filesystem::path& file) {
    if (dialog.purpose == PathDialog::Purpose::save_picture) {
        save_picture(file);
    } else if (document_ && !saver_.busy()) {
        message_ = fmt::format("Saving {} ...", file.string());
        saver_.save(document_->scene, file);
    }
}

void App::save_picture(const std::filesystem::path& file) {
    if (!view_.shown() || saver_.busy()) return;
    message_ = fmt::format("Saving {} ...", file.string());
    saver_.save(view_.picture(), file);
}

void App::update_hover() {
    const std::optional<Pixel> pixel = input_.hover();
    const std::optional<Pixel> sampled =
        pixel ? std::optional(view_.sampled_pixel(*pixel)) : std::nullopt;
    const bool can_ask = trees_.progress().accel != nullptr;
    if (sampled == hover_.sampled && view_.shown() == hover_.frame && can_ask == hover_.asked) {
        return;
    }
    hover_ = {sampled, view_.shown(), can_ask, pixel ? view_.pick(*pixel) : std::nullopt};
}

std::vector<ObjectId> App::selected_objects() const {
    std::vector<ObjectId> objects;
    for (const Selection::Entry& entry : selection_.entries())
        objects.push_back(entry.object);
    return objects;
}

}  // namespace raypick
