#include "harness/view/workbench.h"

#include <system_error>
#include <utility>

#include "base/error.h"
#include "harness/scene/scene.h"
#include "harness/view/view_state.h"

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
