#include "harness/view/captions.h"

#include <fmt/format.h>
#include <imgui.h>

#include "report/images/canvas.h"
#include "report/images/text.h"

namespace shadowbench::view {
namespace {

constexpr int kScaleSteps = 64;
constexpr ImU32 kCaptionBack = IM_COL32(20, 20, 22, 220);
constexpr ImU32 kCaptionInk = IM_COL32(240, 240, 240, 255);
constexpr ImU32 kHiddenInk = IM_COL32(150, 150, 150, 255);
constexpr images::Rgb kLabelBack{0.08f, 0.08f, 0.09f}, kLabelInk{0.94f, 0.94f, 0.94f};

}  // namespace

glm::vec2 text_size(const std::string& text, float room) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, room > 0.0f ? room : -1.0f);
  return {size.x, size.y};
}

void draw_caption(const glm::vec2& corner, const std::string& text, const glm::vec2& size, bool is_hidden) {
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const float edge = 0.3f * ImGui::GetFontSize();
  list->AddRectFilled({corner.x - edge, corner.y - edge}, {corner.x + size.x + edge, corner.y + size.y + edge},
                      kCaptionBack, 3.0f);
  list->AddText(nullptr, 0.0f, {corner.x, corner.y}, is_hidden ? kHiddenInk : kCaptionInk, text.c_str(), nullptr,
                size.x + 1.0f);
}

ScaleCaption::ScaleCaption(const Layer& layer, const render::DisplayedValues& values)
    : color(color_function(values.colors)) {
  const bool is_signed = values.colors == render::Colors::kDiverging, is_grey = values.colors == render::Colors::kGrey;
  low = fmt::format("{}: {:.3g}{}", layer.title, values.low, is_signed ? " darker" : is_grey ? " shadow" : "");
  high = is_signed ? fmt::format("{:+.3g} lighter", values.high)
                   : fmt::format("{:.3g} {}", values.high, is_grey ? "lit" : layer.unit);
}

glm::vec2 ScaleCaption::draw(const glm::vec2& corner) const {
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

void draw_captions(images::Image& picture, const std::array<std::string, kSides>& texts) {
  const images::Font font{.size = 14};
  const int edge = font.size / 2, line = images::line_height(font);
  int free = 0, top = edge;
  for (std::size_t side = 0; side < kSides; ++side) {
    if (texts[side].empty()) continue;
    const int width = images::measure_text(texts[side], font) + edge;
    const int x = side == 0 ? edge : picture.width - width - edge;
    if (x < free) top += line + edge;
    images::fill_rect(picture, {x, top, width, line}, kLabelBack);
    images::draw_text(picture, x + edge / 2, top, texts[side], font, kLabelInk);
    free = x + width + edge;
  }
}

}  // namespace shadowbench::view
