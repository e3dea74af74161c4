#include "harness/view/gui.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "filters/kernel.h"
#include "harness/gl/survey.h"
#include "harness/view/view_state.h"
#include "report/images/picture_io.h"

// After the loader, see gl_api.h.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace shadowbench::view {
namespace {

constexpr float kPanelWidth = 380.0f;
constexpr float kStatusHeight = 24.0f;
constexpr double kSecondsBeforeFull = 0.12;  ///< before what was dragged is drawn in full again, while it is still held
constexpr int kLinesOfFault = 4;
constexpr const char* kHowToUseScene = ".toml, for 'shadowbench view' and 'run --scene'";
constexpr ImU32 kDividerColor = IM_COL32(255, 200, 40, 255);
constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoTitleBar;

/// What the mouse does, for the help: gesture and effect.
constexpr std::pair<const char*, const char*> kGestures[] = {
    {"left drag", "orbit around the point under the pointer"},
    {"right drag", "look around"},
    {"middle drag", "move sideways"},
    {"wheel", "approach the point under the pointer"},
    {"Shift + left drag", "move the light across the sky"},
    {"drag the divider", "show more of one side"},
    {"W A S D, E, Q", "fly ahead, left, back, right, up, down; Shift: faster"},
    {"Ctrl + click on a slider", "type a number"}};

/// A path in `folder` without an extension, which no file of any extension has yet: "cubes-1".
std::filesystem::path find_free_stem(const std::filesystem::path& folder, const std::string& name) {
  const auto is_taken = [&](const std::string& stem) {
    std::error_code missing;  // a folder that is not there yet has no files
    for (const auto& entry : std::filesystem::directory_iterator(folder, missing))
      if (entry.path().filename().string().starts_with(stem + ".")) return true;
    return false;
  };
  int number = 1;
  while (is_taken(fmt::format("{}-{}", name, number))) ++number;
  return folder / fmt::format("{}-{}", name, number);
}

/// A driver lists every overload of a function that is called wrongly: the mistake and a little of that are enough.
std::string first_lines(const std::string& text) {
  std::size_t end = 0;
  for (int line = 0; line < kLinesOfFault && end != std::string::npos; ++line) end = text.find('\n', end + (line > 0));
  if (end == std::string::npos) return text;
  return fmt::format("{}\n{} more", text.substr(0, end),
                     std::count(text.begin() + static_cast<std::ptrdiff_t>(end), text.end(), '\n'));
}

}  // namespace

Gui::Gui(Window& window, Workbench& bench, ViewLog& log, std::filesystem::path out, bool keeps_size)
    : window_(window),
      bench_(bench),
      log_(log),
      out_(std::move(out)),
      keeps_size_(keeps_size),
      layers_(bench),
      input_(bench, window),
      scenes_(bench, Widgets(log)),
      settings_(bench, Widgets(log), [this] { save_state("scene", save_scene); }),
      meter_(bench),
      map_(bench, layers_, display_, Widgets(log)),
      full_size_(bench.state().options.width, bench.state().options.height) {}

glm::ivec2 Gui::panel_size(float scale) { return glm::vec2(kPanelWidth, kStatusHeight) * scale; }

glm::vec2 Gui::free_area() const {
  const glm::ivec2 panels = look_.panels ? panel_size(window_.scale()) : glm::ivec2(0);
  return glm::max(window_.size() - panels, glm::ivec2(16));
}

PicturePlace Gui::place() const {
  const glm::ivec2 pixels(bench_.state().options.width, bench_.state().options.height);
  const glm::vec2 area = free_area(), full(full_size_), room = area / full;
  float magnified = std::min(room.x, room.y);
  if (magnified >= 1.0f) magnified = std::floor(magnified);  // whole pixels
  const glm::vec2 corner = glm::floor(0.5f * (area - magnified * full));
  return {glm::max(corner, glm::vec2(0.0f)), magnified * full.x / static_cast<float>(pixels.x), pixels};
}

/// The picture's lower left corner in the window's framebuffer.
glm::ivec2 Gui::gl_corner() const {
  const PicturePlace at = place();
  return {static_cast<int>(at.corner.x),
          window_.size().y - static_cast<int>(at.corner.y) - static_cast<int>(at.size().y)};
}

/// The picture takes the size of the window where it may, and half of it while something is dragged.
void Gui::fit_picture(double now_s) {
  const bool is_held = ImGui::IsAnyMouseDown() || input_.is_flying();
  if (is_held && (bench_.changes().camera || bench_.changes().light)) moved_s_ = now_s;
  if (!keeps_size_) full_size_ = free_area();
  resize(is_held && now_s - moved_s_ < kSecondsBeforeFull);
}

void Gui::resize(bool halves) {
  const glm::ivec2 size = halves ? glm::max(full_size_ / 2, glm::ivec2(1)) : full_size_;
  if (size == glm::ivec2(bench_.state().options.width, bench_.state().options.height)) return;
  bench_.change({.camera = true}, [&](ViewSettings& settings) {
    settings.options.width = size.x;
    settings.options.height = size.y;
    settings.options.sizes = {{size.x, size.y}};
  });
}

void Gui::lay_out(double now_s) {
  const double seconds = std::exchange(last_s_, now_s) == 0.0 ? 0.0 : now_s - last_s_;
  const std::vector<Window::KeyPress> keys = window_.take_keys();
  // What is chosen or saved is not the half that is drawn at present.
  if (!keys.empty() || ImGui::IsMouseClicked(ImGuiMouseButton_Left) || ImGui::IsMouseReleased(ImGuiMouseButton_Left))
    resize(false);
  for (const Window::KeyPress& press : keys) obey(press);
  input_.take(place(), look_, seconds);
  if (look_.panels) {
    lay_out_panels();
    lay_out_status();
  }
  if (look_.help) lay_out_help();
  fit_picture(now_s);
  window_.set_title("shadowbench: " + bench_.state().scene.name);
}

void Gui::start(const std::string& lesson) {
  if (const Lesson* started = scenes_.start(lesson)) start(*started);
}

/// Shows what a lesson is about; its state is there already.
void Gui::start(const Lesson& lesson) {
  const auto found = std::ranges::find(Layers::list(), lesson.layer, &Layer::id);
  look_ = {.divider = lesson.divider,
           .layer = static_cast<std::size_t>(found - Layers::list().begin()),
           .map = true,
           .help = look_.help};
  map_.look_at(lesson.reading);
}

void Gui::obey(const Window::KeyPress& press) {
  for (const Key& each : list_keys()) {
    if (each.key != press.key || each.control != press.control) continue;
    log_.note(last_s_, "key", each.name);
    each.press(*this);
  }
}

void Gui::lay_out_panels() {
  const glm::vec2 size(window_.size());
  const float width = kPanelWidth * window_.scale();
  ImGui::SetNextWindowPos({size.x - width, 0.0f});
  ImGui::SetNextWindowSize({width, size.y});
  ImGui::Begin("panels", nullptr, kFixed);
  if (const Lesson* lesson = scenes_.lay_out()) start(*lesson);
  settings_.lay_out(look_);
  meter_.lay_out();
  ImGui::End();
}

void Gui::lay_out_status() {
  const glm::vec2 size(window_.size());
  const float height = kStatusHeight * window_.scale();
  ImGui::SetNextWindowPos({0.0f, size.y - height});
  ImGui::SetNextWindowSize({size.x - kPanelWidth * window_.scale(), height});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {8.0f, 0.15f * height});
  ImGui::Begin("status", nullptr, kFixed | ImGuiWindowFlags_NoScrollbar);
  ImGui::PopStyleVar();
  if (!reading_.empty()) {
    ImGui::TextUnformatted(reading_.c_str());
    ImGui::SameLine(0.0f, 2.0f * ImGui::GetFontSize());
  }
  ImGui::TextUnformatted(saved_.empty() ? "F1: keys and mouse" : saved_.c_str());
  ImGui::End();
}

void Gui::lay_out_help() {
  const glm::vec2 area = free_area();
  ImGui::SetNextWindowPos({0.5f * area.x, 0.5f * area.y}, ImGuiCond_Appearing, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({std::min(36.0f * ImGui::GetFontSize(), area.x), 0.0f});
  ImGui::Begin("Keys and mouse", &look_.help, ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoCollapse);
  if (ImGui::BeginTable("keys", 2)) {
    ImGui::TableSetupColumn("key", ImGuiTableColumnFlags_WidthStretch, 1.0f);
    ImGui::TableSetupColumn("text", ImGuiTableColumnFlags_WidthStretch, 2.4f);
    const auto row = [](const std::string& name, const std::string& text) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(name.c_str());
      ImGui::TableNextColumn();
      ImGui::TextWrapped("%s", text.c_str());
    };
    for (const Key& each : list_keys()) row(each.name, each.text);
    for (const auto& [gesture, effect] : kGestures) row(gesture, effect);
    ImGui::EndTable();
  }
  ImGui::End();
}

void Gui::draw_picture() {
  is_timing_ = look_.panels && meter_.step();
  const Layer& layer = Layers::list()[look_.layer];
  const PicturePlace at = place();
  // Half a column more than is seen: the divider may stand within one.
  const int divider = static_cast<int>(at.divider_column(look_)), all = at.pixels.x;
  shown_[0] = layers_.show(layer, 0, look_.error_scale, {0, std::min(divider + 1, all)});
  shown_[1] = layers_.show(layer, 1, look_.error_scale, {std::max(divider - 1, 0), all});
  follow_pointer();
  render::DisplayPass::clear_window(window_.size(), glm::vec3(0.08f));
  display_.draw(bench_.renderer().shaders, {shown_[0].values, shown_[1].values},
                {.corner = gl_corner(),
                 .size = glm::ivec2(at.size()),
                 .magnified = at.magnified,
                 .divider = at.divider_column(look_)});
  draw_divider();
  lay_out_captions();
  lay_out_faults();
}

/// What the layer has at a pixel, row 0 on top, and how far away that is.
std::string Gui::read_value(const glm::ivec2& pixel, std::size_t side) const {
  const Layer& layer = Layers::list()[look_.layer];
  const ShownLayer& shown = shown_[side];
  const glm::ivec2 at(pixel.x, bench_.state().options.height - 1 - pixel.y);
  std::string text = fmt::format("pixel {}, {}", pixel.x, pixel.y);
  if (shown.absent.empty()) {
    const bool is_picture = shown.values.colors == render::Colors::kPicture;
    std::vector<float> values = shown.values.values->read_texel(at.x, at.y, is_picture ? 3 : shown.values.channel + 1);
    if (!is_picture) values = {values.back()};
    if (shown.values.less) values.front() -= shown.values.less->read_texel(at.x, at.y, 1).front();
    const std::string& unit = layer.unit;
    text += fmt::format(", {} {:.4g}{}", layer.title, fmt::join(values, " "), unit.empty() ? unit : " " + unit);
  }
  if (const auto place = bench_.stage().find_surface(pixel)) text += fmt::format(", {:.4g} m away", place->w);
  return text;
}

/// The status line reads the layer under the pointer, and the map's window the receiver.
void Gui::follow_pointer() {
  const PicturePlace at = place();
  const ImGuiIO& io = ImGui::GetIO();
  const glm::vec2 pointer(io.MousePos.x, io.MousePos.y);
  std::optional<glm::ivec2> pixel;
  if (!io.WantCaptureMouse && at.holds(pointer)) pixel = glm::ivec2(at.to_picture(pointer));
  const std::size_t side = !pixel || static_cast<float>(pixel->x) < at.divider_column(look_) ? 0 : 1;
  reading_ = pixel ? read_value(*pixel, side) : "";
  if (look_.map) map_.lay_out(look_, pixel, side, window_.scale());
}

void Gui::draw_divider() {
  const PicturePlace at = place();
  const float x = at.corner.x + at.magnified * at.divider_column(look_);
  ImGui::GetBackgroundDrawList()->AddLine({x, at.corner.y}, {x, at.corner.y + at.size().y}, kDividerColor,
                                          2.0f * window_.scale());
  log_.note_widget("divider", {x, at.corner.y}, {x, at.corner.y + at.size().y});
}

/// Says what a side is, and how far from the truth, or what keeps a layer from being shown.
std::string Gui::make_caption(std::size_t side) const {
  const Side& named = bench_.state().sides[side];
  const std::string &absent = shown_[side].absent, text = named.truth ? "ray-traced truth" : named.label();
  if (named.truth && bench_.stage().truth() == nullptr) return absent + "; all is shown lit";
  if (!absent.empty()) return text + ": " + absent;
  if (named.truth) return text;
  if (const auto rmse = bench_.rmse(side)) return fmt::format("{}, RMSE {:.4f}", text, *rmse);
  const std::string missing = bench_.explain_no_truth();
  return text + (missing.empty() ? ", RMSE ..." : ", no RMSE: " + missing);
}

/// The captions of both sides, a hidden side's in grey; below them what colours mean.
void Gui::lay_out_captions() {
  const PicturePlace at = place();
  const float edge = 0.6f * ImGui::GetFontSize();
  float below = at.corner.y + edge;
  for (std::size_t side = 0; side < kSides; ++side) {
    const std::string text = make_caption(side);
    const float room = 0.5f * at.size().x - 2.0f * edge;  // the other side has the rest
    const glm::vec2 size = text_size(text, room);
    const float x = side == 0 ? at.corner.x + edge : at.corner.x + at.size().x - size.x - edge;
    draw_caption({x, at.corner.y + edge}, text, size, look_.hides(side));
    below = std::max(below, at.corner.y + size.y + 2.0f * edge);
  }
  lay_out_scales({at.corner.x + edge, below + 0.3f * ImGui::GetFontSize()});
}

/// What colours mean, with the side: once where they mean the same on both sides.
std::vector<std::pair<std::size_t, ScaleCaption>> Gui::list_scales() const {
  std::vector<std::pair<std::size_t, ScaleCaption>> scales;
  for (std::size_t side = 0; side < kSides; ++side) {
    const render::DisplayedValues& values = shown_[side].values;
    if (look_.hides(side) || values.colors == render::Colors::kPicture) continue;
    ScaleCaption scale(Layers::list()[look_.layer], values);
    if (scales.empty() || !(scales.front().second == scale)) scales.emplace_back(side, std::move(scale));
  }
  if (scales.size() > 1)
    for (auto& [side, scale] : scales) scale.low = fmt::format("{}: {}", kSideNames[side], scale.low);
  return scales;
}

void Gui::lay_out_scales(glm::vec2 corner) {
  for (const auto& [side, scale] : list_scales()) {
    const glm::vec2 size = scale.draw(corner);
    log_.note_widget(fmt::format("scale.{}", kSideNames[side]), corner, corner + size);
    corner.y += 1.9f * ImGui::GetFontSize();
  }
}

/// Errors stand over the last good image.
void Gui::lay_out_faults() {
  std::string text = bench_.message();
  for (std::size_t side = 0; side < kSides; ++side)
    if (const std::string& fault = bench_.stage().fault(side); !fault.empty())
      text += (text.empty() ? "" : "\n") + first_lines(fault);
  if (text.empty()) return;
  const PicturePlace at = place();
  ImGui::SetNextWindowPos({at.corner.x + 8.0f, at.corner.y + at.size().y - 2.4f * ImGui::GetFontSize()},
                          ImGuiCond_Always, {0.0f, 1.0f});
  ImGui::SetNextWindowSize({std::max(0.9f * at.size().x, 200.0f), 0.0f});
  ImGui::Begin("fault", nullptr, kFixed | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::PushTextWrapPos();
  ImGui::TextColored({1.0f, 0.75f, 0.3f, 1.0f}, "%s", text.c_str());
  ImGui::PopTextWrapPos();
  Widgets(log_).note("fault");
  ImGui::End();
}

void Gui::save(const std::string& what, const std::function<void(const std::filesystem::path& stem)>& write) {
  try {
    bench_.draw();
    const std::filesystem::path stem = find_free_stem(out_, bench_.state().scene.name);
    write(stem);
    saved_ = fmt::format("saved {}: {}{}", what, stem.string(), what == "scene" ? kHowToUseScene : "");
    log_.note(last_s_, "saved " + what, stem.string());
  } catch (const Error& error) {
    bench_.say(error.what());
  }
}

void Gui::save_state(const std::string& what,
                     void (*write)(const ViewState& state, const std::filesystem::path& file)) {
  // By change(), since a file keeps directions as it reads them.
  bench_.change(
      {.camera = true, .light = true}, [](ViewSettings&) {});
  save(what, [&](const std::filesystem::path& stem) { write(bench_.state(), std::filesystem::path(stem) += ".toml"); });
}

/// Waits for what is still traced or measured of the picture: a truth without rays would look like one.
void Gui::save_wanted_picture() {
  if (!wants_picture_) return;
  const bool is_incomplete = std::ranges::any_of(shown_, [](const ShownLayer& each) { return !each.absent.empty(); });
  if (is_halved() || (is_incomplete && bench_.is_busy())) {
    saved_ = "the image is saved once the truth and the measurement are finished";
    return;
  }
  wants_picture_ = false;
  save("picture", [this](const std::filesystem::path& stem) { save_picture(stem); });
}

/// Writes STEM.png, the picture as the window shows it, and STEM.exr with the float images behind it: for each side,
/// "left" and "right", its visibility and its picture, and the truth. Without a truth the sides that show it are left
/// out, and captions say why. Throws Error(kOutput).
void Gui::save_picture(const std::filesystem::path& stem) {
  const ViewState& state = bench_.state();
  const glm::ivec2 all(0, state.options.width);
  std::vector<images::Part> parts;
  images::Metadata metadata = {{"scene", state.scene.name}};
  for (std::size_t side = 0; side < kSides; ++side) {
    const std::string name = kSideNames[side];
    metadata[name] = state.sides[side].label();
    if (state.sides[side].truth && bench_.stage().truth() == nullptr) continue;
    parts.push_back({name + ".visibility", {"Y"}, render::read_image(bench_.stage().visibility(side, all), 1), false});
    const gl::Texture& picture = bench_.stage().picture(state, side, all);
    parts.push_back({name + ".picture", {"R", "G", "B"}, render::read_image(picture, 3), true});
  }
  if (bench_.stage().truth() != nullptr)
    parts.push_back({"truth.area", {"Y"}, render::read_image(*bench_.stage().truth(), 1), false});
  images::write_exr(std::filesystem::path(stem) += ".exr", parts, metadata);
  images::write_display_png(std::filesystem::path(stem) += ".png",
                            render::DisplayPass::read_window(gl_corner(), glm::ivec2(place().size())));
}

const std::vector<Gui::Key>& Gui::list_keys() {
  static const std::vector<Key> keys = {
      {GLFW_KEY_F1, false, "F1", "show or hide this list", [](Gui& gui) { gui.look_.help = !gui.look_.help; }},
      {GLFW_KEY_T, false, "T", "both sides, the divider in the middle", [](Gui& gui) { gui.look_.divider = 0.5f; }},
      {GLFW_KEY_SPACE, false, "Space", "all of one side, then of the other",
       [](Gui& gui) { gui.look_.divider = gui.look_.divider == 1.0f ? 0.0f : 1.0f; }},
      {GLFW_KEY_X, false, "X", "exchange left and right",
       [](Gui& gui) { gui.bench_.change(Changes::all(), [](ViewSettings& s) { std::swap(s.sides[0], s.sides[1]); }); }},
      {GLFW_KEY_PAGE_DOWN, false, "Page Down", "next layer: picture, visibility, error, ...",
       [](Gui& gui) { gui.look_.layer = (gui.look_.layer + 1) % Layers::list().size(); }},
      {GLFW_KEY_PAGE_UP, false, "Page Up", "previous layer",
       [](Gui& gui) { gui.look_.layer = (gui.look_.layer + Layers::list().size() - 1) % Layers::list().size(); }},
      {GLFW_KEY_N, false, "N", "the depth map and the stored map", [](Gui& gui) { gui.look_.map = !gui.look_.map; }},
      {GLFW_KEY_H, false, "H", "show or hide the panels", [](Gui& gui) { gui.look_.panels = !gui.look_.panels; }},
      {GLFW_KEY_C, false, "C", "next camera of the scene",
       [](Gui& gui) {
         gui.bench_.change(Changes::all(), [](ViewSettings& s) { s.camera = (s.camera + 1) % s.cameras.size(); });
       }},
      {GLFW_KEY_L, false, "L", "next light of the scene",
       [](Gui& gui) {
         gui.bench_.change(Changes::all(), [](ViewSettings& s) { s.light = (s.light + 1) % s.lights.size(); });
       }},
      {GLFW_KEY_R, false, "R", "camera and light as the scene has them",
       [](Gui& gui) {
         gui.bench_.change(Changes::all(), [&](ViewSettings& s) {
           s.cameras = gui.bench_.first().cameras;
           s.lights = gui.bench_.first().lights;
         });
       }},
      {GLFW_KEY_P, true, "Ctrl+P", "save the picture with captions, and the float images of both sides",
       [](Gui& gui) { gui.wants_picture_ = true; }},
      {GLFW_KEY_S, true, "Ctrl+S", "save the scene with this camera and light",
       [](Gui& gui) { gui.save_state("scene", save_scene); }},
      {GLFW_KEY_E, true, "Ctrl+E", "save both sides as an experiment of 'shadowbench run'",
       [](Gui& gui) { gui.save_state("experiment", save_experiment); }},
      {GLFW_KEY_Q, true, "Ctrl+Q", "close the window", [](Gui& gui) { gui.window_.close(); }}};
  return keys;
}

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
  frame.texts["reading"] = gui.reading();
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
