#include "harness/view/inspection.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <functional>
#include <span>
#include <string>

#include "harness/gl/objects.h"
#include "harness/gl/survey.h"
#include "harness/measure/timing.h"
#include "harness/render/gbuffer.h"

namespace shadowbench::view {
namespace {

constexpr float kLargestSide = 400.0f, kShareOfWindow = 0.2f;  ///< the map's side is no larger
constexpr ImU32 kReceiverInk = IM_COL32(255, 60, 60, 255);
constexpr ImU32 kKernelInk = IM_COL32(255, 200, 40, 255);

}  // namespace

void MapPanel::lay_out(Look& look, const std::optional<glm::ivec2>& pixel, std::size_t side, float scale) {
  const glm::vec2 pixels(bench_.state().options.width, bench_.state().options.height);
  if (pixel) {
    last_place_ = (glm::vec2(*pixel) + 0.5f) / pixels;
    last_side_ = side;
  }
  ImGui::SetNextWindowPos({20.0f * scale, 60.0f * scale}, ImGuiCond_Appearing);
  ImGui::Begin("Shadow map", &look.map, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
  footprint_ = find_footprint(glm::clamp(last_place_ * pixels, glm::vec2(0.0f), pixels - 1.0f));
  const std::vector<std::string> contents = list_contents();
  auto chosen = static_cast<std::size_t>(std::ranges::find(contents, content_) - contents.begin()) % contents.size();
  widgets_.choose("map.content", "content", contents, chosen, "Linear depth, or what the side's filter stores.");
  content_ = contents[chosen];
  widgets_.slide("map.zoom", "zoom", {.min = 1.0, .max = 128.0, .logarithmic = true}, zoom_,
                 "Around the receiver under the pointer.");
  // What stands above and below the map takes ten lines.
  const float room = ImGui::GetIO().DisplaySize.y - 60.0f * scale - 10.0f * ImGui::GetTextLineHeightWithSpacing();
  const float largest = std::min(kLargestSide * scale, kShareOfWindow * ImGui::GetIO().DisplaySize.x);
  const float side_pixels = std::clamp(std::min(room, largest), 100.0f * scale, kLargestSide * scale);
  show_map(static_cast<int>(side_pixels), footprint_ ? footprint_->receiver.layer : 0);
  ImGui::End();
}

void MapPanel::look_at(const MapReading& reading) {
  last_place_ = find_place(bench_.state(), reading.place_ws);
  last_side_ = reading.side;
  zoom_ = reading.zoom;
  content_ = reading.content;
}

/// Variance only where the filter's own passes leave its moments as they were encoded.
std::vector<std::string> MapPanel::list_contents() const {
  std::vector<std::string> contents = {"depth"};
  const render::FilterPasses* passes = bench_.stage().passes(last_side_);
  if (!passes || !passes->encoded_format()) return contents;
  for (int channel = 1; channel <= gl::pixel_format(*passes->encoded_format()).channels; ++channel)
    contents.push_back(fmt::format("channel {}", channel));
  const filters::FilterSpec& spec = passes->request().spec;
  if (spec.holds_moments && spec.passes.empty()) contents.emplace_back("variance");
  return contents;
}

images::Image MapPanel::read_content(int layer) const {
  const render::ShadowMap& map = bench_.stage().light_map().map;
  const int size = map.size();
  images::Image image(size, size, 1);
  if (content_ == "depth") {
    const filters::DepthMap depth = map.read(layer);
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        *image.at(x, size - 1 - y) = depth.curve.linear(depth.stored[static_cast<std::size_t>(y * size + x)]);
    return image;
  }
  const render::Prefilter& encoded = *bench_.stage().passes(last_side_)->encoded_map(layer);
  const std::vector<float> stored = encoded.read();
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const auto* texel = &stored[static_cast<std::size_t>((y * size + x) * encoded.channels())];
      *image.at(x, size - 1 - y) =
          content_ == "variance" ? texel[1] - texel[0] * texel[0] : texel[content_.back() - '1'];
    }
  return image;
}

void MapPanel::show_map(int side_pixels, int layer) {
  const std::string id = fmt::format("map {} {} {}", content_, last_side_, layer);
  const render::DisplayedValues values = layers_.upload(id, bench_.drawings(), [&] { return read_content(layer); });
  if (!target_ || target_->texture().width() != side_pixels)
    target_.emplace("shadow map, shown", GL_RGBA8, side_pixels, side_pixels);
  const double texels = bench_.state().map_size(), shown = texels / zoom_;
  const glm::dvec2 centre = footprint_ ? footprint_->place_texels : glm::dvec2(0.5 * texels);
  const glm::dvec2 first = glm::clamp(centre - 0.5 * shown, glm::dvec2(0.0), glm::dvec2(texels - shown));
  const auto magnified = static_cast<float>(side_pixels / shown);
  display_.draw(bench_.renderer().shaders, {values, values},
                {.size = glm::ivec2(side_pixels), .first_pixel = glm::vec2(first), .magnified = magnified}, &*target_);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  widgets_.show("map.image", target_->texture());
  draw_footprint({corner.x, corner.y}, side_pixels, first);
  ImGui::Text("%.4g (dark) .. %.4g", static_cast<double>(values.low), static_cast<double>(values.high));
  if (values.infinite > 0) ImGui::Text("%zu texels hold infinity, shown white", values.infinite);
  if (!footprint_) return ImGui::TextDisabled("No receiver in the map under the pointer.");
  ImGui::Text("texel %.2f, %.2f of layer %d, depth %.6f", footprint_->place_texels.x, footprint_->place_texels.y,
              footprint_->receiver.layer, static_cast<double>(footprint_->receiver.depth));
  const double reach = footprint_->half_width_texels;
  std::string kernel = "kernel: a point";
  if (reach > 0.0)
    kernel = fmt::format("kernel: a {} of {:.3g} texels to each side", footprint_->is_disk ? "disk" : "square", reach);
  ImGui::TextUnformatted(kernel.c_str());
}

void MapPanel::draw_footprint(const glm::vec2& corner, int side_pixels, const glm::dvec2& first_texel) const {
  if (!footprint_) return;
  const double pixels = side_pixels / (bench_.state().map_size() / zoom_);
  const auto place = [&](const glm::dvec2& texel) {
    const glm::dvec2 at = (texel - first_texel) * pixels;
    return ImVec2(corner.x + static_cast<float>(at.x), corner.y + static_cast<float>(side_pixels - at.y));
  };
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->PushClipRect({corner.x, corner.y},
                     {corner.x + static_cast<float>(side_pixels), corner.y + static_cast<float>(side_pixels)}, true);
  const glm::dvec2 centre = footprint_->place_texels;
  const double reach = footprint_->half_width_texels;
  if (footprint_->is_disk)
    list->AddCircle(place(centre), static_cast<float>(reach * pixels), kKernelInk, 0, 2.0f);
  else
    list->AddRect(place(centre + glm::dvec2(-reach, reach)), place(centre + glm::dvec2(reach, -reach)), kKernelInk,
                  0.0f, 0, 2.0f);
  const ImVec2 middle = place(centre);
  for (const auto& [x, y] : {std::pair(6.0f, 0.0f), std::pair(0.0f, 6.0f)})
    list->AddLine({middle.x - x, middle.y - y}, {middle.x + x, middle.y + y}, kReceiverInk, 2.0f);
  list->PopClipRect();
}

std::optional<Footprint> MapPanel::find_footprint(const glm::ivec2& pixel) {
  const render::FilterPasses* passes = bench_.stage().passes(last_side_);
  if (passes == nullptr) return std::nullopt;
  const auto receiver = find_receiver(passes->light(), pixel);
  if (!receiver) return std::nullopt;
  const filters::FilterRequest& request = passes->request();
  Footprint footprint;
  footprint.receiver = *receiver;
  footprint.place_texels = glm::dvec2(receiver->uv) * static_cast<double>(bench_.state().map_size());
  if (const auto kernel = filters::find_kernel(request.spec, request.values)) {
    footprint.half_width_texels = kernel->half_width();
    footprint.is_disk = kernel->disk_radius() > 0.0;
  } else {
    footprint.half_width_texels = filters::radius_texels(request.spec, request.values);
  }
  return footprint;
}

/// One pixel's receiver, with the bits that the lookup pass has.
std::optional<filters::Receiver> MapPanel::find_receiver(const render::LightLayers& light,
                                                         const glm::ivec2& pixel) const {
  const render::GBuffer& seen = bench_.stage().gbuffer();
  const glm::ivec2 at(pixel.x, seen.height() - 1 - pixel.y);
  const auto place = bench_.stage().find_surface(pixel);
  if (!place) return std::nullopt;
  render::GBuffer one(1, 1);
  one.upload(std::span(&place->x, 4), seen.normal().read_texel(at.x, at.y, 4));
  std::optional<filters::Receiver> found;
  for (const render::LightSetup& layer : light) {
    for (filters::Receiver& receiver : render::read_receivers(bench_.renderer().shaders, one, layer))
      if (!found || receiver.layer_share > found->layer_share) found = receiver;
  }
  if (found) found->pixel = at;
  return found;
}

bool TimeMeter::step() {
  constexpr std::size_t kRounds = 10;
  if (drawing_ != bench_.drawings()) times_ms_.clear();
  drawing_ = bench_.drawings();
  if (bench_.is_busy() || times_ms_["map"].size() == kRounds) return false;
  Stage& stage = bench_.stage();
  const auto time = [&](const std::string& pass, const std::function<void()>& draw) {
    times_ms_[pass].push_back(gl::time_ms(bench_.renderer().timer, draw));
  };
  for (std::size_t side = 0; side < kSides; ++side) {
    render::FilterPasses* passes = stage.passes(side);
    if (passes == nullptr) continue;
    const std::string name = kSideNames[side];
    time(name + " lookup", [&] { stage.look_up(side); });  // first: right after a prefilter a CPU's are slower
    if (passes->has_prefilter()) time(name + " prefilter", [&] { passes->prefilter(stage.light_map().map); });
  }
  time("map", [&] { stage.redraw_map(bench_.state()); });
  return true;
}

void TimeMeter::lay_out() const {
  if (!ImGui::CollapsingHeader("Times", ImGuiTreeNodeFlags_DefaultOpen)) return;
  for (const auto& [pass, times_ms] : times_ms_)
    if (!times_ms.empty())
      ImGui::TextUnformatted(fmt::format("{}: {:.3f} ms", pass, measure::summarise(times_ms).median).c_str());
  ImGui::TextDisabled("%s",
                      bench_.is_busy() ? "Timing begins after the measurement." : "Medians, while nothing moves.");
}

}  // namespace shadowbench::view
