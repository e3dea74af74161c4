#include "harness/view/workbench.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "harness/measure/scene_truth.h"
#include "harness/measure/view_receivers.h"
#include "harness/render/picture_passes.h"
#include "harness/scene/scene.h"
#include "harness/view/view_state.h"
#include "reference/metrics/error_stats.h"

namespace shadowbench::view {
namespace {

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

void Stage::look_up(std::size_t side) { sides_[side].passes->lookup(*gbuffer_, light_->map, *unseen_); }

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
    drawing.passes->retune(request.values,
                           measure::make_filter_light(state.options, state.scene.light, light_->layers, request));
  }
  if (compiles || retunes) drawing.passes->prefilter(light_->map);
}

void Stage::compile(const ViewState& state, std::size_t side) {
  SideDrawing& drawing = sides_[side];
  const auto make = [&](const filters::FilterRequest& request) {
    return measure::make_filter_passes(renderer_, state.options, state.scene, *light_, request);
  };
  try {
    drawing.passes = make(state.sides[side].filter);
    drawing.fault.clear();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kFilter) throw;
    drawing.fault = error.what();
    if (drawing.passes) drawing.passes = make(drawing.passes->request());
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

namespace {

constexpr double kSecondsAfterFailure = 5.0;  ///< before a measurement is tried again

/// A filter as it is now, with the values that it had as far as it still takes them.
filters::FilterRequest renew(const filters::FilterRequest& old, const filters::FilterSpec& spec) {
  filters::FilterRequest request = old;
  request.spec = spec;
  request.values = filters::default_values(spec);
  for (const auto& [name, value] : old.values) {
    if (spec.find_param(name) == nullptr) continue;
    try {
      request.values[name] = filters::parse_value(spec, name, filters::to_string(value));
    } catch (const Error&) {  // out of the new range: the default stays
    }
  }
  return request;
}

}  // namespace

filters::Catalogue load_catalogue(const std::filesystem::path& folder,
                                  const std::vector<std::filesystem::path>& filter_files) {
  filters::Catalogue catalogue(folder);
  for (const std::filesystem::path& file : filter_files) catalogue.add_user_file(file);
  return catalogue;
}

Workbench::Workbench(measure::Renderer& renderer, ViewState state, filters::Catalogue catalogue,
                     std::vector<std::filesystem::path> filter_files)
    : renderer_(renderer),
      filter_files_(std::move(filter_files)),
      catalogue_(std::move(catalogue)),
      state_(std::move(state)),
      first_(state_),
      drawn_(state_),
      stage_(std::make_unique<Stage>(renderer, state_.scene)) {
  watch_sides();
}

void Workbench::show(ViewState state) {
  auto stage = std::make_unique<Stage>(renderer_, state.scene);
  stage->draw(state, Changes::all());
  say({});
  state_ = std::move(state);
  first_ = drawn_ = state_;
  stage_ = std::move(stage);
  watch_sides();
  changes_ = {.camera = true, .light = true};  // the next draw() begins anew what follows from a drawing
}

void Workbench::watch_sides() {
  std::vector<std::filesystem::path> files = filter_files_;
  for (const Side& side : state_.sides) files.emplace_back(side.filter.spec.path);
  watch_.watch(files);
}

void Workbench::change(const Changes& what, const std::function<void(ViewSettings& settings)>& edit) {
  ViewSettings settings = state_;
  try {
    edit(settings);
    check(settings);
    if (what.camera || what.light) settle(settings);  // so that what is saved, or measured, is what is shown
  } catch (const Error& error) {
    return say(error.what());
  }
  say({});
  apply(state_, std::move(settings));
  changes_ |= what;
  if (what.filter[0] || what.filter[1]) watch_sides();
}

void Workbench::update(double now_s) {
  if (now_s >= next_look_s_) {
    next_look_s_ = now_s + kSecondsBetweenLooks;
    if (watch_.has_changed()) reload_filters();
  }
  follow_truth(now_s);
  follow_measurement(now_s);
  compare(now_s);
}

/// The truth depends on what is seen and on the light.
void Workbench::age_truth(const Changes& changes) {
  if (!changes.camera && !changes.light) return;
  truth_.cancel();
  traced_ = SideMeasurement::State::kIdle;
  stage_->set_truth({});
}

void Workbench::follow_truth(double now_s) {
  using State = SideMeasurement::State;
  if (std::exchange(was_changed_, false)) last_change_s_ = now_s;
  if (traced_ == State::kIdle && now_s - last_change_s_ >= kSecondsBeforeTruth)
    start(truth_, traced_, Measurand::kTruthAlone, now_s);
  if (traced_ != State::kRunning) return;
  traced_ = truth_.poll();
  if (traced_ == State::kRunning) return;
  if (traced_ == State::kFailed) say("the truth cannot be traced: " + truth_.text());
  if (truth()) stage_->set_truth(truth()->truth);
  ++drawings_;
}

std::string Workbench::explain_no_truth() const {
  if (stage_->truth() != nullptr) return {};
  if (truth()) return truth()->no_truth;
  return is_traced() ? "the truth cannot be traced" : "the truth is being traced";
}

void Workbench::follow_measurement(double now_s) {
  using State = SideMeasurement::State;
  const bool wanted = std::exchange(wants_measurement_, false);
  if (!wanted && measured_ == State::kRunning) measurement_.cancel();
  const State before = std::exchange(measured_, measurement_.poll());
  if (measured_ == State::kFinished && before != State::kFinished) ++drawings_;
  // The truth comes first: the run takes it from the cache.
  if (wanted && measured_ == State::kIdle && is_traced() && now_s - last_change_s_ >= kSecondsBeforeMeasurement)
    start(measurement_, measured_, Measurand::kEverything, now_s);
}

void Workbench::compare(double now_s) {
  if (is_compared_ || !truth() || truth()->truth.empty() || now_s - last_change_s_ < kSecondsBeforeError) return;
  is_compared_ = true;
  const std::vector<std::uint8_t> mask(truth()->truth_mask.texels.begin(), truth()->truth_mask.texels.end());
  for (std::size_t side = 0; side < kSides; ++side) {
    if (stage_->passes(side) == nullptr) continue;
    const images::Image shown = render::read_image(stage_->visibility(side, {0, state_.options.width}), 1);
    if (const auto error = metrics::measure_error(shown.texels, truth()->truth.texels, mask)) rmse_[side] = error->rmse;
  }
}

void Workbench::start(SideMeasurement& measurement, SideMeasurement::State& state, Measurand measurand, double now_s) {
  try {
    measurement.start(state_, measurand);
    state = SideMeasurement::State::kRunning;
  } catch (const Error& error) {
    say(error.what());
    last_change_s_ = now_s + kSecondsAfterFailure;
  }
}

std::string Workbench::explain_no_measurement() const {
  if (measured_ == SideMeasurement::State::kFailed) return "cannot be measured: " + measurement_.text();
  return measurement_.text().empty() ? "waits to be measured" : "being measured: " + measurement_.text();
}

void Workbench::reload_filters() {
  try {
    catalogue_ = load_catalogue(state_.options.resources.filters, filter_files_);
  } catch (const Error& error) {
    say(error.what());
    return;
  }
  say({});
  for (std::size_t side = 0; side < kSides; ++side) {
    const filters::FilterRequest& shown = state_.sides[side].filter;
    const filters::FilterSpec& spec = catalogue_.find(shown.spec.id);
    const bool is_same = spec.front_matter == shown.spec.front_matter && spec.body == shown.spec.body;
    if (is_same && stage_->fault(side).empty()) continue;
    Changes changes;
    changes.filter[side] = true;
    change(changes, [&](ViewSettings& settings) { settings.sides[side].filter = renew(shown, spec); });
  }
}

bool Workbench::draw() {
  if (!changes_.any()) return false;
  const Changes changes = std::exchange(changes_, {});
  was_changed_ = true;
  is_compared_ = false;
  rmse_ = {};
  age_truth(changes);
  measurement_.cancel();
  measured_ = SideMeasurement::State::kIdle;
  try {
    stage_->draw(state_, changes);
    drawn_ = state_;
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::kContext || drawings_ == 0) throw;
    say(error.what());
    apply(state_, ViewSettings(drawn_));
    stage_->draw(state_, Changes::all());
  }
  ++drawings_;
  return true;
}

FileWatch::Stamp FileWatch::read_stamp(const std::filesystem::path& file) {
  std::error_code missing;
  const auto written = std::filesystem::last_write_time(file, missing);
  const std::uintmax_t bytes = missing ? 0 : std::filesystem::file_size(file, missing);
  return missing ? std::nullopt : Stamp({written, bytes});
}

void FileWatch::watch(const std::vector<std::filesystem::path>& files) {
  std::map<std::filesystem::path, Stamp> watched;
  for (const std::filesystem::path& file : files) {
    const auto known = files_.find(file);
    watched[file] = known != files_.end() ? known->second : read_stamp(file);
  }
  files_ = std::move(watched);
}

bool FileWatch::has_changed() {
  bool changed = false;
  for (auto& [file, stamp] : files_) {
    const Stamp now = read_stamp(file);
    // An editor that replaces a file leaves none for a moment: what is not there yet is no change.
    if (!now || now == stamp) continue;
    stamp = now;
    changed = true;
  }
  return changed;
}

}  // namespace shadowbench::view
