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
constexpr images::Font kLabelFont{.size = 14};
constexpr int kLabelEdge = kLabelFont.size / 2;

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

int ScaleCaption::draw(images::Image& picture, int top) const {
  const int edge = kLabelEdge, bar = 6 * kLabelFont.size, line = images::line_height(kLabelFont);
  const int left = 2 * edge + images::measure_text(low, kLabelFont), after = left + bar + edge / 2;
  images::fill_rect(picture, {edge, top, after + images::measure_text(high, kLabelFont), line}, kLabelBack);
  images::draw_text(picture, edge + edge / 2, top, low, kLabelFont, kLabelInk);
  for (int x = 0; x < bar; ++x)
    images::fill_rect(picture, {left + x, top + 2, 1, line - 4}, color((static_cast<float>(x) + 0.5f) / bar));
  images::draw_text(picture, after, top, high, kLabelFont, kLabelInk);
  return top + line + edge;
}

int draw_captions(images::Image& picture, const std::array<std::string, kSides>& texts) {
  const int edge = kLabelEdge, line = images::line_height(kLabelFont);
  int free = 0, top = edge;
  for (std::size_t side = 0; side < kSides; ++side) {
    if (texts[side].empty()) continue;
    const int width = images::measure_text(texts[side], kLabelFont) + edge;
    const int x = side == 0 ? edge : picture.width - width - edge;
    if (x < free) top += line + edge;
    images::fill_rect(picture, {x, top, width, line}, kLabelBack);
    images::draw_text(picture, x + edge / 2, top, texts[side], kLabelFont, kLabelInk);
    free = x + width + edge;
  }
  return top + line + edge;
}

}  // namespace shadowbench::view
