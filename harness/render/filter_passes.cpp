#include "harness/render/filter_passes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <numeric>
#include <regex>

#include "base/error.h"
#include "filters/glsl_words.h"
#include "filters/random.h"
#include "harness/render/prefilter.h"

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
  for (const std::uint16_t rank : filters::blue_noise()) turns.push_back(filters::rank_to_turn(rank));
  gl::Texture texture("blue noise", GL_R32F, kSide, kSide);
  texture.upload_floats(turns, 1);
  return texture;
}

}  // namespace

FilterPasses::FilterPasses(ShaderLibrary& shaders, const filters::FilterRequest& request, const ShadowMap& map,
                           const LightLayers& light)
    : shaders_(&shaders),
      request_(request),
      layers_{{light.front()}},
      map_size_(map.size()),
      map_defines_(map_defines(request, map.settings())),
      lookup_(compile_lookup({})) {
  if (lookup_.has("blue_noise")) blue_noise_ = make_blue_noise();
  if (request.spec.has_encode) prefilter_.emplace(shaders, request, map, light.front(), map_defines_);
  if (!request.spec.passes.empty()) {
    own_.emplace(shaders, request, map_size_, light.front(), map_defines_);
    if (prefilter_) own_->check_encode(prefilter_->encode_program());
  }
  if (!filters::list_screens(request.spec, request.values).empty())
    screen_.emplace(shaders, request, light.front(), map_defines_);
  if (light.size() == 1) return;  // else every layer has maps of its own
  layers_.clear();
  for (const LightSetup& each : light)
    layers_.push_back({each,
                       prefilter_ ? std::make_shared<ImageTarget>(request.spec.id + " map", prefilter_->format(),
                                                                  map_size_, map_size_)
                                  : nullptr,
                       own_ ? own_->make_maps() : nullptr});
}

gl::Program FilterPasses::compile_lookup(Defines defines, const std::optional<std::string>& body) const {
  for (const Defines& more : {map_defines_, receiver_defines(layers_.front().light)})
    defines.insert(defines.end(), more.begin(), more.end());
  if (!filters::list_screens(request_.spec, request_.values).empty()) defines.emplace_back("SCREEN", "1");
  if (layers_.front().light.bias.receiver_plane) defines.emplace_back("RECEIVER_PLANE", "1");
  std::vector<gl::Piece> pieces = filter_pieces(request_);
  if (body) pieces.back().text = *body;
  gl::Program program = shaders_->compile_filter(request_.spec.id + " lookup", "lookup.frag", defines, pieces);
  set_uniforms(program, layers_.front().light);
  return program;
}

void FilterPasses::set_uniforms(gl::Program& lookup, const LightSetup& light) const {
  render::set_uniforms(lookup, request_, light);
  lookup.set("map_texel_uv", 1.0f / static_cast<float>(map_size_));
}

LightLayers FilterPasses::light() const {
  LightLayers light;
  for (const Layer& layer : layers_) light.push_back(layer.light);
  return light;
}

void FilterPasses::retune(const filters::ParamValues& values, const LightLayers& light) {
  request_.values = values;
  retune(light);
}

void FilterPasses::retune(const LightLayers& light) {
  assert(light.size() == layers_.size());
  set_uniforms(lookup_, light.front());
  if (prefilter_) prefilter_->retune(request_, light.front());
  if (own_) own_->retune(request_, light.front());
  if (screen_) screen_->retune(request_, light.front());
  for (std::size_t i = 0; i < light.size(); ++i) layers_[i].light = light[i];
}

/// The only layer is what the passes are turned to anyway.
void FilterPasses::select(int layer) {
  if (layers() == 1) return;
  const Layer& chosen = layers_[static_cast<std::size_t>(layer)];
  set_light(lookup_, chosen.light);
  if (prefilter_) prefilter_->turn_to(chosen.light, chosen.encoded);
  if (own_) own_->turn_to(chosen.light, chosen.maps);
}

Prefilter* FilterPasses::encoded_map(int layer) {
  if (!prefilter_) return nullptr;
  select(layer);
  return &*prefilter_;
}

void FilterPasses::prefilter(const ShadowMap& map) {
  assert(curve_defines(map.settings().curve) == map_defines_);
  for (int layer = 0; layer < layers(); ++layer) {
    select(layer);
    if (prefilter_) prefilter_->run(map, layer);
    if (own_) own_->run(map, layer, prefilter_ ? &*prefilter_ : nullptr);
  }
}

const ReceiverBuffer& FilterPasses::bind_lookup(gl::Program& program, const GBuffer& gbuffer, int layer,
                                                const ShadowMap& map) {
  assert(curve_defines(map.settings().curve) == map_defines_);
  const ReceiverBuffer& receivers = gbuffer.receivers(*shaders_, layers_[static_cast<std::size_t>(layer)].light);
  gbuffer.bind();
  receivers.bind();
  map.bind(program, layer);
  if (prefilter_) prefilter_->bind();
  if (own_) own_->bind();
  if (blue_noise_) blue_noise_->bind(kBlueNoiseUnit);
  program.use();
  return receivers;
}

void FilterPasses::lookup(const GBuffer& gbuffer, const ShadowMap& map, ImageTarget& target,
                          const std::optional<glm::ivec2>& columns) {
  look_up(gbuffer, map, target, columns);
  filter_screen(gbuffer, target, columns);
}

void FilterPasses::filter_screen(const GBuffer& gbuffer, ImageTarget& target,
                                 const std::optional<glm::ivec2>& columns) {
  if (screen_) screen_->run(gbuffer, target, columns);
}

/// Screen passes read beyond the columns that are asked for.
void FilterPasses::look_up(const GBuffer& gbuffer, const ShadowMap& map, ImageTarget& drawn,
                           const std::optional<glm::ivec2>& columns) {
  ImageTarget& target = screen_ ? screen_->input(gbuffer) : drawn;
  const auto narrow = [&] {
    if (columns && !screen_) glViewport(columns->x, 0, columns->y - columns->x, gbuffer.height());
  };
  if (layers() > 1) target.clear(glm::vec4(0.0f));
  for (int layer = 0; layer < layers(); ++layer) {
    select(layer);
    const ReceiverBuffer& receivers = bind_lookup(lookup_, gbuffer, layer, map);
    if (layers() == 1) {
      target.bind();
      narrow();
      triangle_.draw();
      continue;
    }
    gl::Framebuffer masked("visibility of a layer");
    masked.attach_color(0, target.texture());
    masked.attach_depth(receivers.mask());
    masked.bind();
    narrow();
    triangle_.draw_added();
  }
}

ReceiverReads FilterPasses::receiver_reads() const {
  static const std::regex kUsesPlace(
      "\\b(uv|depth|depth_unbiased|compare_nearest|compare_2x2|fetch_depth|gather_compare|"
      "gather_depth|fetch_\\w+|load_\\w+|texture)\\b");
  return {std::regex_search(request_.spec.body, kUsesPlace), lookup_.has("receiver_planes"),
          lookup_.has("gbuffer_position"), lookup_.has("gbuffer_normal")};
}

CountingSource FilterPasses::make_counting_source() const {
  const int stored_bytes = encoded_format() ? gl::pixel_format(*encoded_format()).bytes_per_texel : 0;
  filters::CountedLoops counted = filters::count_loops(request_.spec.body);
  return {{{"COUNT_FETCHES", "1"},
           {"LOOPS", fmt::format("{}", std::max(counted.loops, 1))},
           {"STORED_REACH_TEXELS", fmt::format("float({})", stored_reach(request_))},
           {"STORED_BITS", fmt::format("{}", 8 * stored_bytes)}},
          std::move(counted.body)};
}

std::vector<CountedReads> FilterPasses::count_reads(const GBuffer& gbuffer, const ShadowMap& map) {
  const CountingSource source = make_counting_source();
  gl::Program counting = compile_lookup(source.defines, source.body);
  const gl::Texture visibility("counted visibility", GL_R32F, gbuffer.width(), gbuffer.height());
  const gl::Texture reads("reads", GL_RGBA32F, gbuffer.width(), gbuffer.height());
  const gl::Texture wide_reads("wide reads", GL_RG32F, gbuffer.width(), gbuffer.height());
  std::vector<CountedReads> counted;
  for (int layer = 0; layer < layers(); ++layer) {
    select(layer);
    set_uniforms(counting, layers_[static_cast<std::size_t>(layer)].light);
    const ReceiverBuffer& receivers = bind_lookup(counting, gbuffer, layer, map);
    gl::Framebuffer framebuffer("fetch count");
    framebuffer.attach_color(0, visibility);
    framebuffer.attach_color(1, reads);
    framebuffer.attach_color(2, wide_reads);
    if (layers() > 1) framebuffer.attach_depth(receivers.mask());
    framebuffer.bind();
    framebuffer.clear_color(1, glm::vec4(-1.0f));
    if (layers() > 1)
      triangle_.draw_masked();
    else
      triangle_.draw();
    counted.push_back({reads.read_floats(4), wide_reads.read_floats(2)});
  }
  return counted;
}

double FilterPasses::blurred_reach() const { return filters::prefilter_radius_texels(request_.spec, request_.values); }

void FilterPasses::count_fetches(FilterCost& cost, const GBuffer& gbuffer, const ShadowMap& map) {
  std::vector<double> sums(static_cast<std::size_t>(gbuffer.width()) * static_cast<std::size_t>(gbuffer.height()),
                           -1.0);
  double reach = -1.0;
  for (const CountedReads& layer : count_reads(gbuffer, map)) {
    for (std::size_t i = 0; i < sums.size(); ++i) {
      if (layer.reads[4 * i] < 0.0f) continue;
      sums[i] = std::max(sums[i], 0.0) + static_cast<double>(layer.reads[4 * i]);
      reach = std::max(reach, static_cast<double>(layer.reads[4 * i + 1]));
      cost.fetches_64 += static_cast<double>(layer.wide[2 * i]);
      cost.fetches_128 += static_cast<double>(layer.wide[2 * i + 1]);
      cost.most_turns = std::max(cost.most_turns, static_cast<int>(layer.reads[4 * i + 2]));
    }
  }
  std::erase_if(sums, [](double sum) { return sum < 0.0; });
  const double receivers = std::max(static_cast<double>(sums.size()), 1.0);
  cost.fetches = std::accumulate(sums.begin(), sums.end(), 0.0) / receivers;
  cost.fetches_64 /= receivers;
  cost.fetches_128 /= receivers;
  if (reach >= 0.0) cost.reach_texels = reach;
}

std::vector<DrawnPass> FilterPasses::list_passes(int depth_bytes) const {
  std::vector<DrawnPass> passes = {
      {.name = "lookup", .fragment = lookup_.last_stage(), .target = gl::pixel_format(GL_R32F)}};
  const auto add = [&](std::vector<DrawnPass> more) { std::ranges::move(more, std::back_inserter(passes)); };
  if (prefilter_) add(prefilter_->list_passes(depth_bytes));
  if (own_) add(own_->list_passes());
  for (DrawnPass& pass : passes) {
    pass.draws *= layers();
    pass.texels *= layers();
  }
  if (screen_) add(screen_->list_passes());
  return passes;
}

/// Of a filter without passes of its own the map that it stores counts, or else the depth map; of others what the
/// lookup reads.
std::int64_t FilterPasses::count_map_bytes(const ShadowMap& map) const {
  if (!own_) return prefilter_ ? layers() * prefilter_->bytes() : map.bytes();
  const bool reads_depth = lookup_.has("map_depth") || lookup_.has("map_compare") || lookup_.has("map_compare_nearest");
  return layers() * (own_->bytes(lookup_) + (prefilter_ && lookup_.has("map_stored") ? prefilter_->bytes() : 0)) +
         (reads_depth ? map.bytes() : 0);
}

FilterCost FilterPasses::measure_cost(const GBuffer& gbuffer, const ShadowMap& map) {
  FilterCost cost;
  if (!request_.spec.uses_samplers) count_fetches(cost, gbuffer, map);
  cost.map_bytes = count_map_bytes(map);
  cost.bytes_per_texel = cost.map_bytes / (std::int64_t{layers()} * map_size_ * map_size_);
  if (screen_) {
    ImageTarget drawn("screen", GL_R32F, gbuffer.width(), gbuffer.height());
    look_up(gbuffer, map, drawn);
    cost.screen = screen_->count_reads(*shaders_, gbuffer, layers_.front().light, make_counting_source());
    cost.most_turns = std::max(cost.most_turns, cost.screen.most_turns);
  }
  cost.passes = 2 * layers() + prefilter_passes() + (screen_ ? screen_->passes() : 0);
  cost.prefilter_texels =
      layers() * ((prefilter_ ? prefilter_->texels_written() : 0) + (own_ ? own_->texels_written() : 0));
  return cost;
}

}  // namespace shadowbench::render
