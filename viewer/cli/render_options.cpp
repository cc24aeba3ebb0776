#include "viewer/cli/command_options.h"
#include "viewer/cli/option_values.h"
#include "viewer/cli/shared_options.h"

namespace raypick {
namespace {

constexpr double kMostLength = 1e30;

void add_light_path(CLI::App& app, RenderSettings& settings) {
    add_depth(app, settings.depth);
    add_off_switch(app, "--no-shadows", "Leave out shadows", settings.shadows);
    add_off_switch(app, "--no-reflections", "Leave out mirror images", settings.reflections);
    add_off_switch(app, "--no-refractions", "Leave out what is seen through glass",
                   settings.refractions);
    add_choice<GlassShadows>(app, "--glass-shadows",
                             "Glass stops light like anything else, or lets through what it "
                             "transmits [opaque]",
                             {{"opaque", GlassShadows::opaque}, {"tinted", GlassShadows::tinted}},
                             settings.glass_shadows);
    add_value(
        app, "--cutoff", "N", "Leave out rays that add no more than this to a pixel [0.0009765625]",
        [&settings](const std::string& text) {
            settings.cutoff =
                static_cast<float>(number_in("--cutoff", text, 0.0, 1.0, "a number from 0 to 1"));
        });
    app.add_flag_callback(
        "--no-cutoff", [&settings] { settings.cutoff = 0.0f; },
        "Shoot every ray of a mirror or glass, also those that add nothing (for ray counts)");
}

void add_sampling(CLI::App& app, RenderSettings& settings) {
    add_choice<Sampling>(app, "--sampling",
                         "Where a pixel is sampled: its centre, its corners, N x N places, or "
                         "N x N where the centre's colour differs from a neighbour's [centre; "
                         "stratified if --samples, --filter or --aperture is given, adaptive if "
                         "--contrast is]",
                         {{"centre", Sampling::centre},
                          {"corners", Sampling::corners},
                          {"stratified", Sampling::stratified},
                          {"adaptive", Sampling::adaptive}},
                         settings.sampling);
    add_value(app, "--samples", "N", "Samples along each side of a pixel, 1 to 64 [4]",
              [&settings](const std::string& text) {
                  settings.samples = whole_number_in("--samples", text, 1, 64);
              });
    add_value(app, "--contrast", "N",
              "Of adaptive sampling: the difference in sRGB, 0 to 1, that is worth more samples "
              "[0.05]",
              [&settings](const std::string& text) {
                  settings.contrast = static_cast<float>(
                      number_in("--contrast", text, 0.0, 1.0, "a number from 0 to 1"));
              });
    add_choice<PixelFilter>(app, "--filter", "What the samples are averaged by [box]",
                            {{"box", PixelFilter::box},
                             {"tent", PixelFilter::tent},
                             {"gaussian", PixelFilter::gaussian},
                             {"mitchell", PixelFilter::mitchell}},
                            settings.filter);
    add_value(
        app, "--seed", "N", "Of everything random: the same seed, the same image [0]",
        [&settings](const std::string& text) { settings.seed = natural_number("--seed", text); });
}

void add_lens(CLI::App& app, RenderSettings& settings) {
    add_value(app, "--aperture", "N",
              "Diameter of the lens in the scene's units: what is not in focus is blurred [0]",
              [&settings](const std::string& text) {
                  settings.aperture =
                      number_in("--aperture", text, 0.0, kMostLength, "a number from 0 to 1e30");
              });
    add_value(app, "--focus-distance", "N",
              "What is so far away, along the view's axis, is sharp; 0: what is looked at [0]",
              [&settings](const std::string& text) {
                  settings.focus_distance = number_in("--focus-distance", text, 0.0, kMostLength,
                                                      "a number from 0 to 1e30");
              });
}

// What is asked for together must make sense together.
void finish_sampling(const CLI::App& app, RenderSettings& settings) {
    const auto given = [&](const char* name) { return app.count(name) > 0; };
    const bool wants_samples = given("--samples") || given("--filter") || given("--aperture");
    if (!given("--sampling")) {
        if (given("--contrast")) {
            settings.sampling = Sampling::adaptive;
        } else if (wants_samples) {
            settings.sampling = Sampling::stratified;
        }
    }
    const bool several =
        settings.sampling == Sampling::stratified || settings.sampling == Sampling::adaptive;
    for (const char* name : {"--samples", "--filter", "--aperture"}) {
        if (!given(name) || several) continue;
        throw CLI::ValidationError(name, "needs --sampling=stratified or --sampling=adaptive");
    }
    if (given("--contrast") && settings.sampling != Sampling::adaptive) {
        throw CLI::ValidationError("--contrast", "needs --sampling=adaptive");
    }
    if (given("--focus-distance") && !given("--aperture")) {
        throw CLI::ValidationError("--focus-distance", "needs --aperture; without it all is sharp");
    }
    if (given("--cutoff") && given("--no-cutoff")) {
        throw CLI::ValidationError("--cutoff and --no-cutoff exclude each other");
    }
}

// OpenGL draws one sample a pixel and no further rays.
void refuse_for_raster(const CLI::App& app) {
    for (const char* name :
         {"--depth", "--glass-shadows", "--cutoff", "--no-cutoff", "--sampling", "--samples",
          "--contrast", "--filter", "--seed", "--aperture", "--focus-distance"}) {
        if (app.count(name) == 0) continue;
        throw CLI::ValidationError(name, "is for traced images: leave out --raster");
    }
}

}  // namespace

void add_render_options(CLI::App& app, RenderCommand& command) {
    add_scene(app, command.scene);
    app.add_option(
           "--output", command.output,
           "Where to: .png (sRGB), .exr (linear colour, depth, normals, ids), or - for PNG on "
           "standard output")
        ->required()
        ->type_name("FILE");
    add_resolution(app, "Size of the image [1280,720]", command.size);
    app.add_flag("--raster", command.raster, "Draw by OpenGL, off screen, instead of tracing");
    add_light_path(app, command.settings);
    add_sampling(app, command.settings);
    add_lens(app, command.settings);
    add_value(app, "--threads", "N", "Threads to trace with; 0: one a core [0]",
              [&command](const std::string& text) {
                  command.settings.threads = whole_number_in("--threads", text, 0, 1024);
              });
    add_value(app, "--stats", "json", "Print times, counts of rays and memory on standard output",
              [&command](const std::string& text) {
                  if (text != "json") refuse("--stats", "json", text);
                  command.json_stats = true;
              });
    add_camera(app, command.camera);
}

void finish_render(const CLI::App& app, RenderCommand& command) {
    if (command.output == "-" && command.json_stats) {
        throw CLI::ValidationError("--stats=json and --output=- both want standard output");
    }
    if (command.raster) refuse_for_raster(app);
    finish_sampling(app, command.settings);
}

}  // namespace raypick
