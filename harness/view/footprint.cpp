#include "harness/view/footprint.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "filters/map_reader.h"
#include "harness/render/receivers.h"

namespace shadowbench::view {
namespace {

glm::ivec2 to_texel(std::size_t index, int size) {
  const auto side = static_cast<std::size_t>(size);
  return {static_cast<int>(index % side), static_cast<int>(index / side)};
}

void sort_unique(std::vector<glm::ivec2>& texels) {
  const auto less = [](const glm::ivec2& a, const glm::ivec2& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; };
  std::ranges::sort(texels, less);
  texels.erase(std::unique(texels.begin(), texels.end()), texels.end());
}

}  // namespace

std::optional<Footprint> FootprintFinder::find(std::size_t side, const glm::ivec2& pixel) {
  const render::FilterPasses* passes = bench_.stage().passes(side);
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
  add_reads(footprint, side);
  footprint.shape = footprint.half_width_texels > 0.0
                        ? fmt::format("{} of {:.3g} texels to each side", footprint.is_disk ? "a disk" : "a square",
                                      footprint.half_width_texels)
                        : "a point";
  return footprint;
}

/// One pixel's receiver, with the bits that the lookup pass has.
std::optional<filters::Receiver> FootprintFinder::find_receiver(const render::LightLayers& light,
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

FootprintFinder::Prepared* FootprintFinder::prepare(std::size_t side, int layer) {
  if (drawing_ != bench_.drawings()) {
    drawing_ = bench_.drawings();
    prepared_.clear();
    prepared_.resize(kSides);
  }
  const render::ShadowMap& map = bench_.stage().light_map().map;
  prepared_[side].resize(static_cast<std::size_t>(map.layers()));
  std::unique_ptr<Prepared>& prepared = prepared_[side][static_cast<std::size_t>(layer)];
  if (prepared) return prepared.get();
  const filters::FilterRequest& request = bench_.stage().passes(side)->request();
  const bool reads_depth = !request.spec.has_encode && request.spec.passes.empty();
  std::unique_ptr<filters::Model> model = reads_depth ? filters::make_model(request.spec) : nullptr;
  if (!model) return nullptr;
  prepared = std::make_unique<Prepared>(Prepared{request, map.read(layer), std::move(model), nullptr});
  const ViewState& state = bench_.state();
  prepared->lookup = prepared->model->prepare({prepared->request.spec,
                                               prepared->request.values,
                                               prepared->map,
                                               {},
                                               state.options.seed,
                                               state.options.bias.plane_max_tangent()},
                                              filters::Precision::kFloat);
  return prepared.get();
}

void FootprintFinder::add_reads(Footprint& footprint, std::size_t side) {
  const Prepared* prepared = prepare(side, footprint.receiver.layer);
  if (prepared == nullptr) return;
  filters::ReadLog log;
  const filters::ModelResult result = prepared->lookup->at(footprint.receiver);
  for (const filters::TexelRead& read : log.reads())
    footprint.reads.push_back(to_texel(read.texel, bench_.state().map_size()));
  sort_unique(footprint.reads);
  if (result.disk_radius_texels > 0.0) {
    footprint.half_width_texels = result.disk_radius_texels + 1.0;  // read through 2x2 texels
    footprint.is_disk = true;
  }
}

}  // namespace shadowbench::view
