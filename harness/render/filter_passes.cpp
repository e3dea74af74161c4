#include "harness/render/filter_passes.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>

#include "filters/base/error.h"
#include "filters/noise/blue_noise.h"
#include "harness/render/filter_glsl.h"

namespace shadowbench::render {
namespace {

Defines map_defines(const filters::FilterRequest& request, const MapSettings& map) {
  Defines defines = curve_defines(map.curve);
  if (defines.empty() || !request.spec.uses_samplers) return defines;
  throw Error(ErrorKind::kUsage,
              fmt::format("{}: the filter '{}' reads the map's samplers itself, which do not hold "
                          "linear depth then; let it use compare_nearest, compare_2x2, fetch_depth or a gather",
                          map.curve.reversed ? "--reversed-depth" : "--perspective-depth", request.spec.id));
}

/// How far the centre of a texel of the depth map that a fetch of the encoded map holds can be from where it reads.
double stored_reach(const filters::FilterRequest& request) {
  const double reconstruction = filters::reads_nearest(request.values) ? 0.5 : 1.0;
  return filters::prefilter_radius_texels(request.spec, request.values) + reconstruction;
}

constexpr GLuint kBlueNoiseUnit = 7;  // of lib/random.glsl

gl::Texture make_blue_noise() {
  constexpr int kSide = static_cast<int>(filters::kBlueNoiseSide);
  std::vector<float> turns;
  for (const std::uint16_t rank : filters::kBlueNoise) turns.push_back(filters::rank_to_turn(rank));
  gl::Texture texture("blue noise", GL_R32F, kSide, kSide);
  texture.upload_floats(turns, 1);
  return texture;
}

}  // namespace

FilterPasses::FilterPasses(ShaderLibrary& shaders, const filters::FilterRequest& request, const ShadowMap& map,
                           const LightSetup& light)
    : shaders_(&shaders),
      request_(request),
      light_(light),
      map_size_(map.size()),
      map_defines_(map_defines(request, map.settings())),
      lookup_(compile_lookup(shaders, {})) {
  if (lookup_.has("blue_noise")) blue_noise_ = make_blue_noise();
  if (request.spec.has_encode) prefilter_.emplace(shaders, request, map, light, map_defines_);
  if (request.spec.passes.empty()) return;
  own_.emplace(shaders, request, map_size_, light, map_defines_);
  if (prefilter_) own_->check_encode(prefilter_->encode_program());
}

gl::Program FilterPasses::compile_lookup(ShaderLibrary& shaders, Defines defines) const {
  for (const Defines& more : {map_defines_, receiver_defines(light_)})
    defines.insert(defines.end(), more.begin(), more.end());
  if (light_.bias.receiver_plane) defines.emplace_back("RECEIVER_PLANE", "1");
  gl::Program program =
      shaders.compile_filter(request_.spec.id + " lookup", "lookup.frag", defines, filter_pieces(request_));
  set_uniforms(program);
  return program;
}

void FilterPasses::set_uniforms(gl::Program& lookup) const {
  render::set_uniforms(lookup, request_, light_);
  lookup.set("map_texel_uv", 1.0f / static_cast<float>(map_size_));
}

void FilterPasses::retune(ShaderLibrary& shaders, const filters::ParamValues& values, const LightSetup& light) {
  request_.values = values;
  light_ = light;
  set_uniforms(lookup_);
  if (prefilter_) prefilter_->retune(shaders, request_, light_);
  if (own_) own_->retune(request_, light_);
}

std::shared_ptr<ImageTarget> FilterPasses::make_encoded_target() const {
  if (!prefilter_) return nullptr;
  return std::make_shared<ImageTarget>(request_.spec.id + " map", prefilter_->format(), map_size_, map_size_);
}

PreparedLight FilterPasses::prepare(const LightSetup& light, std::shared_ptr<ImageTarget> encoded) {
  return {light, prefilter_ ? prefilter_->find_border(light) : glm::vec4(0.0f), std::move(encoded),
          own_ ? own_->make_maps() : nullptr};
}

void FilterPasses::turn_to(const PreparedLight& light) {
  light_ = light.light;
  set_light(lookup_, light_);
  if (prefilter_) prefilter_->turn_to(light_, light.border, light.encoded);
  if (own_) own_->turn_to(light_, light.maps);
}

void FilterPasses::prefilter(const ShadowMap& map) {
  if (prefilter_) prefilter_->run(map);
  if (own_) own_->run(map, encoded_map());
}

void FilterPasses::draw_lookup(gl::Program& program, const GBuffer& gbuffer, const ReceiverBuffer& receivers,
                               const ShadowMap& map) {
  gbuffer.bind();
  receivers.bind();
  map.bind();
  if (prefilter_) prefilter_->bind();
  if (own_) own_->bind();
  if (blue_noise_) {
    gl::Sampler::unbind(kBlueNoiseUnit);
    blue_noise_->bind(kBlueNoiseUnit);
  }
  program.use();
  triangle_.draw();
}

void FilterPasses::lookup(const GBuffer& gbuffer, const ShadowMap& map, ImageTarget& target) {
  const ReceiverBuffer& receivers = gbuffer.receivers(*shaders_, light_);
  target.bind();
  draw_lookup(lookup_, gbuffer, receivers, map);
}

ReceiverReads FilterPasses::receiver_reads() const {
  static const std::regex kUsesPlace(
      "\\b(uv|depth|depth_unbiased|compare_nearest|compare_2x2|fetch_depth|gather_compare|"
      "gather_depth|fetch_\\w+|load_\\w+|texture)\\b");
  return {std::regex_search(request_.spec.body, kUsesPlace), lookup_.has("receiver_planes"),
          lookup_.has("gbuffer_position"), lookup_.has("gbuffer_normal")};
}

void FilterPasses::count_fetches(FilterCost& cost, ShaderLibrary& shaders, const GBuffer& gbuffer,
                                 const ShadowMap& map) {
  gl::Program counting = compile_lookup(
      shaders, {{"COUNT_FETCHES", "1"}, {"STORED_REACH_TEXELS", fmt::format("float({})", stored_reach(request_))}});
  const gl::Texture visibility("counted visibility", GL_R32F, gbuffer.width(), gbuffer.height());
  const gl::Texture reads("reads", GL_RG32F, gbuffer.width(), gbuffer.height());
  gl::Framebuffer framebuffer("fetch count");
  framebuffer.attach_color(0, visibility);
  framebuffer.attach_color(1, reads);
  const ReceiverBuffer& prepared = gbuffer.receivers(shaders, light_);
  framebuffer.bind();
  draw_lookup(counting, gbuffer, prepared, map);
  double sum = 0.0, receivers = 0.0, reach = -1.0;
  const std::vector<float> counted = reads.read_floats(2);
  for (std::size_t i = 0; i < counted.size(); i += 2) {
    if (counted[i] < 0.0f) continue;
    sum += static_cast<double>(counted[i]);
    receivers += 1.0;
    reach = std::max(reach, static_cast<double>(counted[i + 1]));
  }
  cost.fetches = receivers > 0.0 ? sum / receivers : 0.0;
  if (reach >= 0.0) cost.reach_texels = reach;
}

/// Of a filter without passes of its own the map that it stores counts, or else the depth map; of others what the
/// lookup reads.
std::int64_t FilterPasses::count_map_bytes(const ShadowMap& map) const {
  if (!own_) return prefilter_ ? prefilter_->bytes() : map.bytes();
  const bool reads_depth = lookup_.has("map_depth") || lookup_.has("map_compare") || lookup_.has("map_compare_nearest");
  return own_->bytes(lookup_) + (prefilter_ && lookup_.has("map_stored") ? prefilter_->bytes() : 0) +
         (reads_depth ? map.bytes() : 0);
}

FilterCost FilterPasses::measure_cost(ShaderLibrary& shaders, const GBuffer& gbuffer, const ShadowMap& map) {
  FilterCost cost;
  if (!request_.spec.uses_samplers) count_fetches(cost, shaders, gbuffer, map);
  cost.map_bytes = count_map_bytes(map);
  cost.bytes_per_texel = cost.map_bytes / (static_cast<std::int64_t>(map_size_) * map_size_);
  cost.passes = 2 + prefilter_passes();
  cost.prefilter_texels = (prefilter_ ? prefilter_->texels_written() : 0) + (own_ ? own_->texels_written() : 0);
  return cost;
}

}  // namespace shadowbench::render
