#include "harness/view/stage.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "filters/front_matter.h"
#include "harness/measure/map_coverage.h"
#include "harness/measure/scene_truth.h"
#include "harness/measure/view_receivers.h"
#include "harness/render/picture_passes.h"

namespace shadowbench::view {
namespace {

/// A lookup whose visibility is -1 less the distance to what the map holds for a receiver: what is 0 or more stands for
/// pixels that no filter is asked about.
filters::FilterRequest make_blocker_lookup() {
  filters::FilterRequest request;
  request.spec = filters::parse_filter(
      "/*+++\ntitle = \"Distance to the blocker\"\nsource = \"none\"\nkind = \"other\"\n+++*/\n"
      "float visibility(Receiver r) {\n"
      "  return -1.0 - max(r.depth_unbiased - fetch_depth(r, vec2(0.0)), 0.0) * r.depth_range_ws;\n}\n",
      "blocker.glsl");
  return request;
}

/// Whether columns are not among those that are there; each from the first up to the second.
bool needs(const glm::ivec2& there, const glm::ivec2& columns) {
  return columns.x < columns.y && !(there.x <= columns.x && columns.y <= there.y);
}

}  // namespace

Changes& Changes::operator|=(const Changes& other) {
  camera |= other.camera;
  light |= other.light;
  map |= other.map;
  for (std::size_t side = 0; side < kSides; ++side) {
    filter[side] |= other.filter[side];
    values[side] |= other.values[side];
  }
  return *this;
}

Stage::Stage(measure::Renderer& renderer, const scene::Scene& scene) : renderer_(renderer), geometry_(scene) {}

void Stage::draw(const ViewState& state, const Changes& changes) {
  const bool resized =
      !gbuffer_ || gbuffer_->width() != state.options.width || gbuffer_->height() != state.options.height;
  if (resized || changes.camera) draw_gbuffer(state);
  const double pad = measure::padding_texels(state.options);
  const bool follows = (resized || changes.camera) && state.options.fit.follows_view();
  const bool refit = !light_ || changes.light || changes.map || follows || pad != pad_texels_;
  const bool other_map = refit && draw_map(state, changes.map);
  pad_texels_ = pad;
  if (other_map) blocker_passes_.reset();
  for (std::size_t side = 0; side < kSides; ++side)
    draw_side(state, side, other_map || changes.filter[side], refit || changes.values[side]);
  for (SideDrawing& side : sides_) side.looked_up = side.shaded = glm::ivec2(0);
}

void Stage::draw_gbuffer(const ViewState& state) {
  const int width = state.options.width, height = state.options.height;
  if (!gbuffer_ || gbuffer_->width() != width || gbuffer_->height() != height) {
    gbuffer_ = std::make_unique<render::GBuffer>(width, height);
    for (SideDrawing& side : sides_) {
      side.visibility.emplace("visibility", GL_R32F, width, height);
      side.picture.emplace("picture", GL_RGBA32F, width, height);
    }
    unseen_.emplace("timed visibility", GL_R32F, width, height);
    truth_.reset();
  }
  gbuffer_->draw(renderer_.shaders, geometry_, state.scene, state.active_camera());
}

/// Fits and draws the light's map. Whether filters must be compiled anew for it.
bool Stage::draw_map(const ViewState& state, bool map_changed) {
  const options::RunOptions& options = state.options;
  std::vector<scene::LightFrustum> layers = measure::fit_map_layers(
      options,
      {state.scene, state.scene.light, state.active_camera(), state.map_size(), measure::padding_texels(options),
       measure::list_phase_shifts(options.phases, options.seed).front()},
      [&]() -> const render::GBuffer& { return *gbuffer_; });
  const bool other_map = !light_ || map_changed || light_->map.size() != state.map_size() ||
                         light_->map.layers() != static_cast<int>(layers.size()) ||
                         render::shape_defines(light_->frustum()) != render::shape_defines(layers.front());
  if (other_map) {
    render::ShadowMap map(state.map_size(), options.map, static_cast<int>(layers.size()));
    map.set_border(options.range.border);
    light_ = std::make_unique<measure::LightMap>(std::move(layers), std::move(map));
  } else {
    light_->layers = std::move(layers);
  }
  redraw_map(state);
  return other_map;
}

void Stage::redraw_map(const ViewState& state) {
  for (const scene::LightFrustum& layer : light_->layers)
    light_->map.draw(renderer_.shaders, geometry_, layer, state.options.bias.map);
}

void Stage::draw_side(const ViewState& state, std::size_t side, bool compiles, bool retunes) {
  SideDrawing& drawing = sides_[side];
  if (state.sides[side].truth) {
    drawing.passes.reset();
    drawing.fault.clear();
    drawing.visibility->clear(glm::vec4(1.0f));  // seen until there is a truth
    return;
  }
  compiles = compiles || !drawing.passes;
  if (compiles) compile(state, side);
  if (!drawing.passes) return;
  if (retunes && !compiles) {
    // A filter whose newer code does not compile keeps the values that its older one knows.
    const filters::FilterRequest request = drawing.fault.empty() ? state.sides[side].filter : drawing.passes->request();
    retune(state, *drawing.passes, request);
    for (const auto& empty : drawing.empty.passes) retune(state, *empty, empty->request());
  }
  if (compiles || retunes) drawing.passes->prefilter(light_->map);
}

void Stage::retune(const ViewState& state, render::FilterPasses& passes, const filters::FilterRequest& request) {
  passes.retune(renderer_.shaders, request.values,
                measure::make_filter_light(state.options, state.scene.light, light_->layers, request));
}

void Stage::compile(const ViewState& state, std::size_t side) {
  SideDrawing& drawing = sides_[side];
  const auto make = [&](const filters::FilterRequest& request) {
    auto made = measure::make_filter_passes(renderer_, state.options, state.scene, *light_, request);
    drawing.empty = measure::make_empty_lookups(renderer_, state.options, state.scene, *light_, {made.get()});
    drawing.passes = std::move(made);
  };
  try {
    make(state.sides[side].filter);
    drawing.fault.clear();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kFilter) throw;
    drawing.fault = error.what();
    if (drawing.passes) make(filters::FilterRequest(drawing.passes->request()));
  }
}

std::optional<glm::vec4> Stage::find_surface(const glm::ivec2& pixel) const {
  const std::vector<float> place = gbuffer_->position().read_texel(pixel.x, gbuffer_->height() - 1 - pixel.y, 4);
  if (place[3] == 0.0f) return std::nullopt;
  return glm::vec4(place[0], place[1], place[2], place[3]);
}

void Stage::set_truth(const images::Image& visibility) {
  truth_.reset();
  if (!visibility.empty()) truth_.emplace(render::upload_image(visibility));
  for (SideDrawing& side : sides_)
    if (!side.passes) side.shaded = glm::ivec2(0);
}

const gl::Texture& Stage::visibility(std::size_t side, const glm::ivec2& columns) {
  SideDrawing& drawing = sides_[side];
  if (!drawing.passes) return truth_ ? *truth_ : drawing.visibility->texture();
  if (needs(drawing.looked_up, columns))
    drawing.passes->lookup(*gbuffer_, light_->map, *drawing.visibility, drawing.looked_up = columns);
  return drawing.visibility->texture();
}

const gl::Texture& Stage::picture(const ViewState& state, std::size_t side, const glm::ivec2& columns) {
  SideDrawing& drawing = sides_[side];
  if (needs(drawing.shaded, columns)) {
    drawing.shaded = columns;
    render::shade_into(*drawing.picture, renderer_.shaders,
                       {*gbuffer_, visibility(side, columns), state.scene, state.active_camera(), state.options.range},
                       columns);
  }
  return drawing.picture->texture();
}

void Stage::look_up(std::size_t side) { sides_[side].passes->lookup(*gbuffer_, light_->map, *unseen_); }

void Stage::look_up_nothing(std::size_t side) {
  sides_[side].empty.passes.front()->lookup(*gbuffer_, light_->map, *unseen_);
}

images::Image Stage::blocker_distance(const ViewState& state) {
  render::ImageTarget target("distance to the blocker", GL_R32F, gbuffer_->width(), gbuffer_->height());
  if (blocker_passes_)
    retune(state, *blocker_passes_, blocker_passes_->request());
  else
    blocker_passes_ =
        measure::make_filter_passes(renderer_, state.options, state.scene, *light_, make_blocker_lookup());
  blocker_passes_->lookup(*gbuffer_, light_->map, target);
  images::Image distance = render::read_image(target.texture(), 1);
  for (float& value : distance.texels) value = value < 0.0f ? -1.0f - value : 0.0f;
  return distance;
}

images::Image Stage::texels_per_pixel(const ViewState& state) {
  const render::LightLayers light = measure::make_unbiased_light(state.options, state.scene.light, light_->layers);
  images::Image density =
      measure::measure_coverage(measure::read_view_receivers(*gbuffer_, state.scene.light), state.active_camera(),
                                measure::list_traced_layers(renderer_.shaders, *gbuffer_, light),
                                measure::read_linear_depth(light_->map))
          .density;
  for (float& texels : density.texels) texels = std::max(texels, 0.0f);  // below 0 where there is no surface
  return density;
}

}  // namespace shadowbench::view
