#include "harness/view/workbench.h"

#include <system_error>
#include <utility>

#include "base/error.h"
#include "harness/measure/layer_truth.h"
#include "harness/scene/scene.h"
#include "harness/view/save.h"

namespace shadowbench::view {
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
      stage_(std::make_unique<Stage>(renderer, state_.scene)),
      cache_(state_.options.cache, [](const std::string&) {}) {  // one that cannot be written costs time alone
  start_tracer();
  watch_sides();
}

void Workbench::start_tracer() {
  truth_ = std::make_unique<BackgroundTruth>([this] { return scene::list_occluders(state_.scene); }, cache_,
                                             state_.options.seed);
}

void Workbench::show(ViewState state) {
  auto stage = std::make_unique<Stage>(renderer_, state.scene);
  stage->draw(state, Changes::all());
  say({});
  truth_.reset();  // its thread reads the scene
  state_ = std::move(state);
  first_ = drawn_ = state_;
  stage_ = std::move(stage);
  start_tracer();
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
}

/// The truth depends on what is seen and on the light; texels per pixel depend on the map as well.
void Workbench::age_truth(const Changes& changes) {
  if (changes.camera) surfaces_.reset();
  if (!changes.camera && !changes.light && !(changes.map && wants_coverage_)) return;
  truth_is_old_ = true;
  truth_->stop();
  shown_truth_ = {};
  stage_->set_truth({});
}

void Workbench::follow_truth(double now_s) {
  if (std::exchange(was_changed_, false)) last_change_s_ = now_s;
  if (truth_is_old_ && now_s - last_change_s_ >= kSecondsBeforeTruth) start_truth();
  std::optional<BackgroundTruth::Shown> more = truth_->take();
  if (!more) return;
  shown_truth_ = std::move(*more);
  if (!shown_truth_.error.empty()) say("the truth: " + shown_truth_.error);
  stage_->set_truth(shown_truth_.visibility);
  ++drawings_;
}

void Workbench::start_truth() {
  truth_is_old_ = false;
  if (!surfaces_) surfaces_ = std::make_shared<measure::ViewSurfaces>(measure::read_view_surfaces(stage_->gbuffer()));
  TruthJob job{surfaces_, state_.scene.light};
  if (wants_coverage_) {
    const measure::LightMap& light = stage_->light_map();
    job.map = {
        state_.active_camera(),
        measure::list_traced_layers(renderer_.shaders, stage_->gbuffer(),
                                    measure::make_unbiased_light(state_.options, state_.scene.light, light.layers)),
        measure::read_linear_depth(light.map)};
  }
  truth_->start(std::move(job));
}

std::string Workbench::explain_no_truth() const {
  if (stage_->truth() != nullptr) return {};
  if (!shown_truth_.error.empty()) return "the truth cannot be traced";
  return shown_truth_.truth ? shown_truth_.truth->absent : "the truth is being traced";
}

void Workbench::follow_measurement(double now_s) {
  using State = SideMeasurement::State;
  const bool wanted = std::exchange(wants_measurement_, false);
  if (!wanted && measured_ == State::kRunning) measurement_.cancel();
  const State before = std::exchange(measured_, measurement_.poll());
  if (measured_ == State::kFinished && before != State::kFinished) ++drawings_;
  // The truth comes first: the run takes it from the cache.
  const bool may_start = wanted && measured_ == State::kIdle && !truth_is_old_ && truth_part() == 1.0;
  if (!may_start || now_s - last_change_s_ < kSecondsBeforeMeasurement) return;
  try {
    measurement_.start(state_);
    measured_ = State::kRunning;
  } catch (const Error& error) {
    say(error.what());
    last_change_s_ = now_s + kSecondsAfterFailure;
  }
}

const measure::MeasuredCell* Workbench::find_measured(std::size_t side) const {
  return measured_ == SideMeasurement::State::kFinished ? measurement_.results().find_side(side) : nullptr;
}

std::string Workbench::explain_no_measurement(std::size_t side) const {
  if (state_.sides[side].truth) return "the truth is what is measured against";
  if (measured_ == SideMeasurement::State::kFailed) return "cannot be measured: " + measurement_.text();
  return measurement_.text().empty() ? "waits to be measured" : "is measured: " + measurement_.text();
}

void Workbench::want_coverage() {
  if (std::exchange(wants_coverage_, true)) return;
  truth_is_old_ = true;
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
    if (spec == shown.spec && stage_->fault(side).empty()) continue;
    Changes changes;
    changes.filter[side] = true;
    change(changes, [&](ViewSettings& settings) { settings.sides[side].filter = renew(shown, spec); });
  }
}

bool Workbench::draw() {
  if (!changes_.any()) return false;
  const Changes changes = std::exchange(changes_, {});
  was_changed_ = true;
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
