#include "harness/view/gui.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "report/images/picture_io.h"

namespace shadowbench::view {
namespace {

constexpr float kPanelWidth = 380.0f;
constexpr float kStatusHeight = 24.0f;
constexpr int kScaleSteps = 64;
constexpr ImU32 kDividerColor = IM_COL32(255, 200, 40, 255);
constexpr ImU32 kCaptionBack = IM_COL32(20, 20, 22, 220);
constexpr ImU32 kCaptionInk = IM_COL32(240, 240, 240, 255);
constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoTitleBar;

/// What the mouse does, for the help: gesture and effect.
constexpr std::pair<const char*, const char*> kGestures[] = {
    {"left drag", "orbit around what is under the pointer"},
    {"right drag", "look around"},
    {"middle drag", "move sideways"},
    {"wheel", "approach what is under the pointer"},
    {"Shift + left drag", "move the light across the sky"},
    {"drag the divider", "share the picture otherwise"},
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

/// Of a text, in lines of at most so many pixels; 0: of one line.
glm::vec2 text_size(const std::string& text, float room = 0.0f) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, room > 0.0f ? room : -1.0f);
  return {size.x, size.y};
}

/// A text on a dark ground of this size.
void draw_caption(const glm::vec2& corner, const std::string& text, const glm::vec2& size) {
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const float edge = 0.3f * ImGui::GetFontSize();
  list->AddRectFilled({corner.x - edge, corner.y - edge}, {corner.x + size.x + edge, corner.y + size.y + edge},
                      kCaptionBack, 3.0f);
  list->AddText(nullptr, 0.0f, {corner.x, corner.y}, kCaptionInk, text.c_str(), nullptr, size.x + 1.0f);
}

/// What a layer's colours mean: its name, and the colours between what their ends stand for.
struct ScaleCaption {
  std::string low, high;
  images::Colors color;

  ScaleCaption(const Layer& layer, const render::DisplayedValues& values) : color(color_function(values.colors)) {
    const bool is_signed = values.colors == render::Colors::kDiverging,
               is_grey = values.colors == render::Colors::kGrey;
    low = fmt::format("{}: {:.3g}{}", layer.title, values.low, is_signed ? " darker" : is_grey ? " shadow" : "");
    high = is_signed ? fmt::format("{:+.3g} lighter", values.high)
                     : fmt::format("{:.3g} {}", values.high, is_grey ? "lit" : layer.unit);
  }

  bool operator==(const ScaleCaption& other) const { return low == other.low && high == other.high; }

  /// Draws it from its upper left corner on; returns its size.
  glm::vec2 draw(const glm::vec2& corner) const {
    const float gap = 0.5f * ImGui::GetFontSize(), bar = 6.0f * ImGui::GetFontSize(), step = bar / kScaleSteps;
    const float before = text_size(low).x + gap;
    const glm::vec2 size = {before + bar + gap + text_size(high).x, ImGui::GetFontSize()};
    draw_caption(corner, low, size);
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    for (int i = 0; i < kScaleSteps; ++i) {
      const images::Rgb rgb = color((static_cast<float>(i) + 0.5f) / kScaleSteps);
      const float x = corner.x + before + static_cast<float>(i) * step;
      list->AddRectFilled({x, corner.y + 1.0f}, {x + step, corner.y + size.y - 1.0f},
                          ImGui::ColorConvertFloat4ToU32({rgb[0], rgb[1], rgb[2], 1.0f}));
    }
    list->AddText({corner.x + before + bar + gap, corner.y}, kCaptionInk, high.c_str());
    return size;
  }
};

}  // namespace

Gui::Gui(Window& window, Workbench& bench, ViewLog& log, std::filesystem::path out, bool keeps_size)
    : window_(window),
      bench_(bench),
      log_(log),
      out_(std::move(out)),
      keeps_size_(keeps_size),
      first_(bench.state()),
      layers_(bench),
      input_(bench, window),
      settings_(bench, Widgets(log)),
      meter_(bench),
      magnifier_(bench, display_, Widgets(log)),
      map_(bench, layers_, display_, Widgets(log)) {}

glm::ivec2 Gui::window_size(const glm::ivec2& picture, float scale) {
  return picture + glm::ivec2(glm::vec2(kPanelWidth, kStatusHeight) * scale);
}

glm::vec2 Gui::free_area() const {
  const glm::vec2 panels = look_.panels ? glm::vec2(kPanelWidth, kStatusHeight) * window_.scale() : glm::vec2(0.0f);
  return glm::max(glm::vec2(window_.size()) - panels, glm::vec2(16.0f));
}

PicturePlace Gui::place() const {
  const glm::ivec2 pixels(bench_.state().options.width, bench_.state().options.height);
  const glm::vec2 area = free_area(), room = area / glm::vec2(pixels);
  float magnified = std::min(room.x, room.y);
  if (magnified >= 1.0f) magnified = std::floor(magnified);  // whole pixels
  const glm::vec2 corner = glm::floor(0.5f * (area - magnified * glm::vec2(pixels)));
  return {glm::max(corner, glm::vec2(0.0f)), magnified, pixels};
}

/// The picture takes the size of the window where it may.
void Gui::fit_picture() {
  const glm::ivec2 area(free_area());
  if (keeps_size_ || (area.x == bench_.state().options.width && area.y == bench_.state().options.height)) return;
  bench_.change({.camera = true, .light = true}, [&](ViewSettings& settings) {
    settings.options.width = area.x;
    settings.options.height = area.y;
    settings.options.sizes = {{area.x, area.y}};
  });
}

void Gui::lay_out(double now_s) {
  const double seconds = std::exchange(last_s_, now_s) == 0.0 ? 0.0 : now_s - last_s_;
  for (const Window::KeyPress& press : window_.take_keys()) obey(press);
  fit_picture();
  input_.take(place(), look_, seconds);
  if (look_.panels) {
    lay_out_panels();
    lay_out_status();
  }
  if (look_.help) lay_out_help();
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
  settings_.lay_out(look_);
  show_times(bench_, meter_);
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
  // Half a column more than is seen: the divider may stand within one. The magnifier shows both sides anywhere.
  const int divider = static_cast<int>(at.divider_column(look_)), all = at.pixels.x;
  shown_[0] = layers_.show(layer, 0, look_.error_scale, {0, look_.magnifier ? all : std::min(divider + 1, all)});
  shown_[1] = layers_.show(layer, 1, look_.error_scale, {look_.magnifier ? 0 : std::max(divider - 1, 0), all});
  lay_out_inspection();
  const glm::ivec2 window = window_.size(), size(at.size());
  render::DisplayPass::clear_window(window, glm::vec3(0.08f));
  const glm::ivec2 corner(static_cast<int>(at.corner.x), window.y - static_cast<int>(at.corner.y) - size.y);
  display_.draw(bench_.renderer().shaders, {shown_[0].values, shown_[1].values},
                {.corner = corner, .size = size, .magnified = at.magnified, .divider = at.divider_column(look_)});
  draw_divider();
  lay_out_captions();
  lay_out_faults();
}

/// The windows that follow the pointer.
void Gui::lay_out_inspection() {
  const PicturePlace at = place();
  const ImGuiIO& io = ImGui::GetIO();
  const glm::vec2 pointer(io.MousePos.x, io.MousePos.y);
  std::optional<glm::ivec2> pixel;
  if (!io.WantCaptureMouse && at.holds(pointer)) pixel = glm::ivec2(at.to_picture(pointer));
  const bool is_left = !pixel || static_cast<float>(pixel->x) < at.divider_column(look_);
  if (look_.magnifier)
    magnifier_.lay_out(look_, Layers::list()[look_.layer], shown_, pixel,
                       at.corner + glm::vec2(at.size().x - 8.0f, 40.0f), window_.scale());
  if (look_.map) map_.lay_out(look_, pixel, is_left ? 0 : 1, window_.scale());
}

void Gui::draw_divider() {
  if (look_.sharing != Sharing::kDivider) return;
  const PicturePlace at = place();
  const float x = at.corner.x + at.magnified * at.divider_column(look_);
  ImGui::GetBackgroundDrawList()->AddLine({x, at.corner.y}, {x, at.corner.y + at.size().y}, kDividerColor,
                                          2.0f * window_.scale());
  log_.note_widget("divider", {x, at.corner.y}, {x, at.corner.y + at.size().y});
}

/// Says which side is which, and what keeps a layer from being shown; below that, what its colours mean.
void Gui::lay_out_captions() {
  const PicturePlace at = place();
  const float edge = 0.6f * ImGui::GetFontSize();
  float below = at.corner.y + edge;
  for (std::size_t side = 0; side < kSides; ++side) {
    if (look_.sharing == Sharing::kFlip && side != look_.flipped_to) continue;
    const Side& named = bench_.state().sides[side];
    std::string text = named.truth ? "ray-traced truth" : named.filter.spec.id;
    if (!shown_[side].absent.empty()) text += ": " + shown_[side].absent;
    const float room = 0.5f * at.size().x - 2.0f * edge;  // the other side has the rest
    const glm::vec2 size = text_size(text, room);
    const float x = side == 0 ? at.corner.x + edge : at.corner.x + at.size().x - size.x - edge;
    draw_caption({x, at.corner.y + edge}, text, size);
    below = std::max(below, at.corner.y + size.y + 2.0f * edge);
  }
  lay_out_scales({at.corner.x + edge, below + 0.3f * ImGui::GetFontSize()});
}

/// What colours mean, from a corner on: once where they mean the same on both sides.
void Gui::lay_out_scales(glm::vec2 corner) {
  std::vector<std::pair<std::size_t, ScaleCaption>> scales;
  for (std::size_t side = 0; side < kSides; ++side) {
    const render::DisplayedValues& values = shown_[side].values;
    const bool is_seen = look_.sharing != Sharing::kFlip || side == look_.flipped_to;
    if (!is_seen || values.colors == render::Colors::kPicture) continue;
    ScaleCaption scale(Layers::list()[look_.layer], values);
    if (scales.empty() || !(scales.front().second == scale)) scales.emplace_back(side, std::move(scale));
  }
  for (auto& [side, scale] : scales) {
    if (scales.size() > 1) scale.low = fmt::format("{}: {}", kSideNames[side], scale.low);
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
      text += (text.empty() ? "" : "\n") + fault;
  if (text.empty()) return;
  const PicturePlace at = place();
  ImGui::SetNextWindowPos({at.corner.x + 8.0f, at.corner.y + at.size().y - 8.0f}, ImGuiCond_Always, {0.0f, 1.0f});
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
    const std::filesystem::path stem = find_free_stem(out_, bench_.state().scene.name);
    write(stem);
    saved_ = fmt::format("saved {}: {}", what, stem.string());
    log_.note(last_s_, "saved " + what, stem.string());
  } catch (const Error& error) {
    bench_.say(error.what());
  }
}

void Gui::save_state(const std::string& what,
                     void (*write)(const ViewState& state, const std::filesystem::path& file)) {
  // By change(), since a file keeps directions as it reads them.
  bench_.change({.camera = true, .light = true}, [](ViewSettings&) {});
  bench_.draw();
  save(what, [&](const std::filesystem::path& stem) { write(bench_.state(), std::filesystem::path(stem) += ".toml"); });
}

/// Writes STEM.png, which is what the window shows of both sides, and STEM.exr with the float images behind it: for
/// each side, "left" and "right", its visibility and its picture, and the truth as far as it is traced.
/// Throws Error(kOutput).
void Gui::save_picture(const std::filesystem::path& stem) {
  std::array<render::DisplayedValues, kSides> shown;
  const ViewState& state = bench_.state();
  const glm::ivec2 size(state.options.width, state.options.height);
  for (std::size_t side = 0; side < kSides; ++side)
    shown[side] = layers_.show(Layers::list()[look_.layer], side, look_.error_scale, {0, size.x}).values;
  render::ImageTarget target("saved picture", GL_RGBA8, size.x, size.y);
  display_.draw(bench_.renderer().shaders, shown, {.size = size, .divider = place().divider_column(look_)}, &target);
  std::vector<images::Part> parts;
  for (std::size_t side = 0; side < kSides; ++side) {
    const std::string name = kSideNames[side];
    parts.push_back(
        {name + ".visibility", {"Y"}, render::read_image(bench_.stage().visibility(side, {0, size.x}), 1), false});
    const gl::Texture& picture = bench_.stage().picture(state, side, {0, size.x});
    parts.push_back({name + ".picture", {"R", "G", "B"}, render::read_image(picture, 3), true});
  }
  if (bench_.stage().truth() != nullptr)
    parts.push_back({"truth.area", {"Y"}, render::read_image(*bench_.stage().truth(), 1), false});
  images::Metadata metadata = {{"scene", state.scene.name}};
  for (std::size_t side = 0; side < kSides; ++side) metadata[kSideNames[side]] = state.sides[side].label();
  images::write_exr(std::filesystem::path(stem) += ".exr", parts, metadata);
  images::write_display_png(std::filesystem::path(stem) += ".png", render::read_image(target.texture(), 3));
}

}  // namespace shadowbench::view
