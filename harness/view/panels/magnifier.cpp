#include "harness/view/panels/magnifier.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>

namespace shadowbench::view {
namespace {

constexpr int kPixels = 13;  ///< along a side, odd
constexpr int kPixelSide = 12;
constexpr int kGap = 8;  ///< between the two sides, in pixels of the window

std::string write(const std::vector<float>& values) { return fmt::format("{:.6g}", fmt::join(values, "  ")); }

}  // namespace

std::vector<float> Magnifier::read_value(const render::DisplayedValues& shown, const glm::ivec2& pixel) {
  const glm::ivec2 at(pixel.x, shown.values->height() - 1 - pixel.y);
  if (shown.colors == render::Colors::kPicture) return shown.values->read_texel(at.x, at.y, 3);
  float value = shown.values->read_texel(at.x, at.y, shown.channel + 1).back();
  if (shown.less) value -= shown.less->read_texel(at.x, at.y, 1).front();
  return {value};
}

void Magnifier::lay_out(Look& look, const Layer& layer, const std::array<ShownLayer, kSides>& shown,
                        const std::optional<glm::ivec2>& pixel, const glm::vec2& corner, float scale) {
  last_pixel_ = glm::clamp(pixel.value_or(last_pixel_), glm::ivec2(0),
                           glm::ivec2(bench_.state().options.width - 1, bench_.state().options.height - 1));
  ImGui::SetNextWindowPos({corner.x, corner.y}, ImGuiCond_Appearing, {1.0f, 0.0f});
  ImGui::Begin("Magnifier", &look.magnifier, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
  show_pixels(shown, static_cast<int>(static_cast<float>(kPixelSide) * scale));
  show_values(layer, shown);
  ImGui::End();
}

void Magnifier::show_pixels(const std::array<ShownLayer, kSides>& shown, int magnified) {
  const int side = kPixels * magnified, width = 2 * side + kGap;
  if (!target_ || target_->texture().width() != width) target_.emplace("magnified pixels", GL_RGBA8, width, side);
  const glm::vec2 first(static_cast<float>(last_pixel_.x - kPixels / 2),
                        static_cast<float>(bench_.state().options.height - 1 - last_pixel_.y - kPixels / 2));
  target_->clear(glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  for (std::size_t i = 0; i < kSides; ++i) {
    const glm::ivec2 corner(static_cast<int>(i) * (side + kGap), 0);
    display_.draw(
        bench_.renderer().shaders, {shown[i].values, shown[i].values},
        {.corner = corner, .size = glm::ivec2(side), .first_pixel = first, .magnified = static_cast<float>(magnified)},
        &*target_);
  }
  const ImVec2 at = ImGui::GetCursorScreenPos();
  widgets_.show("magnifier.image", target_->texture());
  for (std::size_t i = 0; i < kSides; ++i) {
    const auto x = at.x + static_cast<float>(static_cast<int>(i) * (side + kGap) + side / 2);
    const auto y = at.y + static_cast<float>(side / 2), half = 0.5f * static_cast<float>(magnified) + 1.0f;
    ImGui::GetWindowDrawList()->AddRect({x - half, y - half}, {x + half, y + half}, IM_COL32(255, 200, 40, 255), 0.0f,
                                        0, 2.0f);
  }
}

void Magnifier::show_values(const Layer& layer, const std::array<ShownLayer, kSides>& shown) const {
  ImGui::Text("pixel %d, %d", last_pixel_.x, last_pixel_.y);
  for (std::size_t side = 0; side < kSides; ++side) {
    const char* name = kSideNames[side];
    if (shown[side].absent.empty())
      ImGui::Text("%s: %s %s %s", name, layer.title.c_str(), write(read_value(shown[side].values, last_pixel_)).c_str(),
                  layer.unit.c_str());
    else
      ImGui::Text("%s: %s", name, shown[side].absent.c_str());
  }
  Stage& stage = bench_.stage();
  for (std::size_t side = 0; side < kSides; ++side) {
    const render::DisplayedValues visibility{.values = &stage.visibility(side, {0, bench_.state().options.width}),
                                             .colors = render::Colors::kGrey};
    const float value = read_value(visibility, last_pixel_).front();
    std::string line = fmt::format("{}: visibility {:.6g}", kSideNames[side], value);
    if (stage.truth()) {
      const render::DisplayedValues truth{.values = stage.truth(), .colors = render::Colors::kGrey};
      line += fmt::format(", less the truth {:+.6g}", value - read_value(truth, last_pixel_).front());
    }
    ImGui::TextUnformatted(line.c_str());
  }
  if (const auto place = stage.find_surface(last_pixel_))
    ImGui::Text("at %.4g %.4g %.4g m, %.4g m away", static_cast<double>(place->x), static_cast<double>(place->y),
                static_cast<double>(place->z), static_cast<double>(place->w));
  else
    ImGui::TextDisabled("no surface");
}

}  // namespace shadowbench::view
