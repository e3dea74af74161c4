#include "harness/view/run_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "base/error.h"
#include "base/text.h"
#include "filters/kernel.h"
#include "harness/gl/survey.h"
#include "harness/view/gui.h"

namespace shadowbench::view {
namespace {

constexpr double kSecondsOfRest = 0.1;             ///< between frames in which nothing moves
constexpr int kLeastHeight = 560;                  ///< of a window: its panels need as much
constexpr glm::ivec2 kLargestPicture(1920, 1080);  ///< that a window opens with: a software rasteriser draws it

double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// The user's own filter, or the first that is wider than one fetch and not for teaching.
std::string choose_usual(const filters::Catalogue& catalogue, const ViewOptions& options) {
  if (!options.filter_files.empty()) return options.filter_files.front().stem().string();
  const auto is_usual = [](const filters::FilterSpec& spec) {
    const auto sigma = filters::find_kernel_sigma(spec, filters::default_values(spec));
    return !spec.teaching && sigma > filters::width_classes().front().widest_texels;
  };
  const auto usual = std::ranges::find_if(catalogue.filters(), is_usual);
  return usual != catalogue.filters().end() ? usual->id : catalogue.filters().front().id;
}

void require_lesson(const ViewOptions& options) {
  std::vector<std::string> names;
  for (const Lesson& lesson : read_lessons(options.run.resources.lessons)) names.push_back(lesson.name);
  if (!options.lesson.empty() && std::ranges::count(names, options.lesson) == 0)
    throw Error(ErrorKind::kUsage, fmt::format("--lesson: '{}' is no lesson{}", options.lesson,
                                               did_you_mean_or_known(options.lesson, names)));
}

/// As large as the screen allows, but for a picture that keeps its size: then no larger than it and the panels are.
glm::ivec2 choose_window_size(const ViewOptions& options, const glm::ivec2& picture) {
  const glm::ivec2 panels = Gui::panel_size(options.scale > 0.0 ? static_cast<float>(options.scale) : 1.0f),
                   room = Window::find_room();
  const glm::ivec2 wanted = options.keeps_size || room.x <= 0 ? glm::max(picture + panels, glm::ivec2(0, kLeastHeight))
                                                              : kLargestPicture + panels;
  return room.x > 0 ? glm::min(wanted, room) : wanted;
}

/// What tests want to know of a frame.
ViewLog::Frame describe_frame(const Gui& gui, Workbench& bench, double begun_s, bool drawn) {
  ViewLog::Frame frame{begun_s, 1e3 * (now_s() - begun_s), drawn, {}, {}};
  frame.numbers = {
      {"divider", gui.look().divider}, {"truth", bench.is_traced() ? 1.0 : 0.0}, {"busy", bench.is_busy() ? 1.0 : 0.0}};
  frame.texts["layer"] = Layers::list()[gui.look().layer].id;
  frame.texts["message"] = bench.message();
  frame.texts["scene"] = bench.state().scene.name;
  frame.texts["lesson"] = gui.lesson();
  frame.numbers["width"] = bench.state().options.width;
  for (std::size_t side = 0; side < kSides; ++side) {
    const std::string name = kSideNames[side];
    const Side& shown = bench.state().sides[side];
    frame.texts[name] = shown.truth ? kTruthName : shown.filter.spec.id;
    if (const auto rmse = bench.rmse(side)) frame.numbers[name + ".rmse"] = *rmse;
    frame.texts[name + ".fault"] = bench.stage().fault(side);
    for (const auto& [param, value] : shown.filter.values) frame.texts[name + "." + param] = filters::to_string(value);
  }
  return frame;
}

}  // namespace

void run_view(const ViewOptions& options) {
  filters::Catalogue catalogue = load_catalogue(options.run.resources.filters, options.filter_files);
  options::RunOptions run = options.run;
  run.reference = catalogue.parse_requests("none").front();
  const auto make = [&](const std::string& text) {
    return make_side(catalogue, text.empty() ? choose_usual(catalogue, options) : text);
  };
  require_lesson(options);
  ViewState state = make_view_state(std::move(run), options.scene, {make(options.sides[0]), make(options.sides[1])});
  if (!options.light_name.empty()) choose_light(state, options.light_name);
  check(state);
  const glm::ivec2 size = choose_window_size(options, {state.options.width, state.options.height});
  auto context =
      std::make_unique<gl::GlfwContext>(gl::WindowShape{size.x, size.y, "shadowbench: " + state.scene.name, true});
  gl::GlfwContext& shown = *context;
  const gl::TimerKind timer = gl::choose_timer(shown);
  measure::Renderer renderer{std::move(context), {}, timer, render::ShaderLibrary(options.run.resources.shaders)};
  Window window(shown, static_cast<float>(options.scale));
  ViewLog log = options.log.empty() ? ViewLog() : ViewLog(options.log);
  Workbench bench(renderer, std::move(state), std::move(catalogue), options.filter_files);
  bench.draw();
  Gui gui(window, bench, log, options.run.out, options.keeps_size);
  if (!options.lesson.empty()) gui.start(options.lesson);
  const double opened = now_s();
  while (!window.is_closing()) {
    window.wait(gui.is_moving() ? 0.0 : kSecondsOfRest);
    const double begun = now_s();
    bench.update(begun);
    window.begin_frame();
    gui.lay_out(begun);
    const bool drawn = bench.draw();
    gui.draw_picture();
    window.end_frame([&] { gui.save_wanted_picture(); });
    if (log.is_on()) log.end_frame(describe_frame(gui, bench, begun, drawn));
    shown.require_no_gl_errors();
    if (options.close_after_s > 0.0 && now_s() - opened > options.close_after_s) window.close();
  }
}

}  // namespace shadowbench::view
