#include "harness/tune/tune_filters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "base/error.h"
#include "base/files.h"
#include "base/folder_lock.h"
#include "harness/measure/scene_measurement.h"
#include "harness/run/provenance.h"
#include "harness/run/run_plan.h"
#include "harness/tune/tune_scene.h"
#include "report/pages/tune_page.h"
#include "report/pages/write_page.h"
#include "report/records/csv_tables.h"
#include "report/records/tuned_record.h"

namespace shadowbench::tune {
namespace {

constexpr double kLargestPaddingShare = 1.0 / 64.0;
constexpr double kLeastPadding = 4.0;
constexpr double kWidestBlend = 0.5;  // of two neighbours, then all of a slice

using TuneSceneList = std::vector<std::unique_ptr<TuneScene>>;

/// What is known of one filter between its search and its scoring.
struct TunedFilter {
  filters::FilterRequest request;  ///< at its defaults
  Setting found;
  records::TunedFilterRecord record;
};

std::vector<TuneView> select_views(bool training) {
  std::vector<TuneView> views;
  std::ranges::copy_if(tune_views(), std::back_inserter(views),
                       [&](const TuneView& view) { return view.training == training; });
  return views;
}

/// Splits views by the light they need: each light has a map of its own.
std::vector<std::vector<TuneView>> group_by_light(const std::vector<TuneView>& views) {
  std::vector<std::vector<TuneView>> groups;
  for (const TuneView& view : views) {
    const auto same = std::ranges::find_if(
        groups, [&](const auto& group) { return group.front().light_turn_deg == view.light_turn_deg; });
    if (same != groups.end())
      same->push_back(view);
    else
      groups.push_back({view});
  }
  return groups;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

class Tuner {
 public:
  Tuner(const TuneOptions& options, options::Progress& progress)
      : options_(options),
        progress_(progress),
        metric_(find_tune_metric(options.metric)),
        filters_(list_filters(options.run.filters)),
        scenes_(run::load_scenes(options.run)),
        renderer_(measure::make_renderer(options.run.backend, options.run.resources)),
        cache_(options.run.cache, [&progress](const std::string& message) { progress.note("warning: " + message); }) {
    describe();
    settings_ = {&options_.run, &metric_, record_.pad_texels};
  }

  std::string run() {
    const FolderLock lock(options_.run.out,
                          options_.run.force);  // a folder that cannot be written is better found now
    progress_.begin(static_cast<int>(filters_.size()) * (options_.budget + fit_budget_), 0);
    search_all();
    score_unseen();
    renderer_.context->require_no_gl_errors();
    progress_.show(done_, "writing");
    lock.require_in_place();
    return write();
  }

 private:
  const TuneOptions& options_;
  options::Progress& progress_;
  const TuneMetric& metric_;
  const std::vector<SearchedParam> fit_params_ = list_searched_params(options_.run.fit, options_.fixed_keys);
  const int fit_budget_ = fit_params_.empty() ? 0 : (options_.budget + 1) / 2;
  std::vector<TunedFilter> filters_;
  std::vector<scene::Scene> scenes_;
  measure::Renderer renderer_;
  truth::TruthCache cache_;
  TuneSettings settings_;
  records::TunedRecord record_;
  std::string evaluations_;  ///< rows of evaluations.csv
  int done_ = 0;

  /// What is left of filters that have nothing to tune. Throws Error(kUsage) where none is left.
  std::vector<TunedFilter> list_filters(const std::vector<filters::FilterRequest>& requests) const {
    std::vector<std::string> untuned;
    std::vector<TunedFilter> tuned;
    for (const filters::FilterRequest& request : requests) {
      const auto is_same = [&](const TunedFilter& known) { return known.request.spec.id == request.spec.id; };
      if (std::ranges::any_of(tuned, is_same)) {
        throw Error(ErrorKind::kUsage, fmt::format("--filters names '{}' twice, and tuned.json holds one setting of "
                                                   "each: tune them apart, with another --out",
                                                   request.spec.id));
      }
      if (fit_params_.empty() && list_searched_params(request).empty()) {
        untuned.push_back(fmt::format(
            "there is nothing to tune of '{}': it has no numeric parameter with a range that is not const and not set "
            "already",
            request.label()));
        continue;
      }
      tuned.push_back({request, {request.values, options_.run.fit.cascades}, {}});
    }
    if (tuned.empty()) throw Error(ErrorKind::kUsage, untuned.back() + "; choose another filter (see 'list filters')");
    for (const std::string& each : untuned) progress_.note(each);
    return tuned;
  }

  void describe() {
    const options::RunOptions& run = options_.run;
    record_.commit = run::build_commit();
    const records::GlRecord gl = run::describe_gl(renderer_);
    record_.renderer = fmt::format("{} ({})", gl.renderer, gl.backend);
    record_.metric = metric_.name;
    record_.map_size = run.map_sizes.front();
    record_.fit = scene::describe_fit(run.fit);
    record_.width = run.width;
    record_.height = run.height;
    record_.widest_kernel = find_widest_kernel(run.filters);
    record_.pad_texels = choose_tune_padding(record_.widest_kernel, record_.map_size);
    record_.budget = options_.budget;
    record_.tolerance = SearchSettings().tolerance;
    record_.seed = run.seed;
    if (run.light) record_.light = measure::describe_light(*run.light);
    record_.bias = run.bias_texts;
    record_.training_views = describe_tune_views(true);
    record_.unseen_views = describe_tune_views(false);
  }

  std::unique_ptr<TuneScene> make_tune_scene(const scene::Scene& scene, const std::vector<TuneView>& views) {
    auto tune_scene = std::make_unique<TuneScene>(renderer_, settings_, cache_, scene, views,
                                                  [this](const std::string& what) { progress_.show(done_, what); });
    record_.notes.insert(record_.notes.end(), tune_scene->left_out().begin(), tune_scene->left_out().end());
    return tune_scene;
  }

  /// Throws where a scene cannot be scored in any view of one kind: a mean over the others would not be of all scenes.
  void require_views(const scene::Scene& scene, std::size_t views, const char* kind) const {
    if (views > 0) return;
    throw Error(ErrorKind::kInput, fmt::format("no {} view of the scene '{}' can be scored by {} ({}); leave it out "
                                               "with --scene, or choose a larger --size or "
                                               "another --metric",
                                               kind, scene.name, metric_.name, record_.notes.back()));
  }

  /// Makes the training views of all scenes, and forgets the scenes that have none and may be skipped.
  TuneSceneList make_training_scenes() {
    TuneSceneList tune_scenes;
    std::vector<scene::Scene> kept;
    for (const scene::Scene& scene : scenes_) {
      std::unique_ptr<TuneScene> tune_scene = make_tune_scene(scene, select_views(true));
      const bool last_hope = &scene == &scenes_.back() && kept.empty();
      if (!options_.skip_scenes || last_hope) require_views(scene, tune_scene->views().size(), "training");
      if (tune_scene->views().empty()) continue;
      tune_scenes.push_back(std::move(tune_scene));
      kept.push_back(scene);
      record_.scenes.push_back(scene.name);
    }
    scenes_ = std::move(kept);
    return tune_scenes;
  }

  void search_all() {
    const TuneSceneList tune_scenes = make_training_scenes();
    for (TunedFilter& filter : filters_) {
      note_filter(filter);
      render::FilterPasses passes = tune_scenes.front()->make_passes(filter.request);
      search(filter, fit_params_, fit_budget_, tune_scenes, passes);
      search(filter, list_searched_params(filter.request), options_.budget, tune_scenes, passes);
      for (const auto& tune_scene : tune_scenes) score(filter, *tune_scene, true);
    }
  }

  static Setting with_values(Setting setting, const std::vector<SearchedParam>& params,
                             const std::vector<double>& values) {
    for (std::size_t i = 0; i < params.size(); ++i)
      if (params[i].of_fit)
        setting.cascades.*params[i].of_fit = values[i];
      else
        setting.values[params[i].name] = values[i];
    return setting;
  }

  /// The mean over all training views.
  static double evaluate(const TuneSceneList& tune_scenes, render::FilterPasses& passes, const Setting& setting) {
    std::vector<double> all;
    for (const auto& tune_scene : tune_scenes) {
      const auto scores = tune_scene->score(passes, setting);
      if (!scores) return kWorstError;
      all.insert(all.end(), scores->begin(), scores->end());
    }
    return mean(all);
  }

  /// The truth's standard error, the mean over all training views; 0 where the metric is not in its unit.
  double find_truth_se(const TuneSceneList& tune_scenes) const {
    std::vector<double> all;
    for (const auto& tune_scene : tune_scenes)
      for (const TuneScene::View& view : tune_scene->views()) all.push_back(view.truth->standard_error);
    return metric_.kind == TuneMetricKind::kStatistic ? mean(all) : 0.0;
  }

  /// Searches some parameters, the others as they were found before.
  void search(TunedFilter& filter, const std::vector<SearchedParam>& params, int budget,
              const TuneSceneList& tune_scenes, render::FilterPasses& passes) {
    if (params.empty()) return;
    const std::vector<ParamScale> scales(params.begin(), params.end());
    const Setting start = filter.found;
    const int before = done_;
    std::vector<Evaluation> drawn;
    SearchSettings search;
    search.budget = budget;
    search.on_evaluation = [&](const Evaluation& evaluation) {
      done_ = before + std::min(evaluation.number, budget);
      progress_.show(done_, fmt::format("{} · {} · {} {:.4g}", filter.request.spec.id, evaluation.stage, metric_.name,
                                        evaluation.error));
      note_evaluation(filter.request.spec.id, params, evaluation);
      drawn.push_back(evaluation);
    };
    SearchResult result = search_parameters(scales, search, [&](const std::vector<double>& values) {
      return evaluate(tune_scenes, passes, with_values(start, params, values));
    });
    done_ = before + budget;
    const auto blend = std::ranges::find(params, &scene::CascadeRule::blend, &SearchedParam::of_fit) - params.begin();
    if (blend < std::ssize(params))
      take_widest(result, drawn, static_cast<std::size_t>(blend), find_truth_se(tune_scenes));
    filter.found = with_values(start, params, result.best);
    note_search(filter, scales, result);
  }

  /// Takes the largest value of a parameter whose error is tied with the best.
  static void take_widest(SearchResult& result, const std::vector<Evaluation>& drawn, std::size_t which, double tie) {
    for (const Evaluation& each : drawn)
      if (each.error <= result.best_error + tie && each.values[which] > result.best[which]) result.best = each.values;
  }

  void note_evaluation(const std::string& id, const std::vector<SearchedParam>& params, const Evaluation& evaluation) {
    std::string values;
    for (std::size_t i = 0; i < params.size(); ++i)
      values += fmt::format("{}{}={}", i > 0 ? " " : "", params[i].name, evaluation.values[i]);
    evaluations_ += records::make_csv_row(
        {id, fmt::format("{}", evaluation.number), evaluation.stage, values, fmt::format("{}", evaluation.error)});
  }

  static void note_filter(TunedFilter& filter) {
    filter.record.id = filter.request.spec.id;
    filter.record.label = filter.request.label();
    filter.record.defaults = filter.request.values;
  }

  static void note_search(TunedFilter& filter, const std::vector<ParamScale>& scales, const SearchResult& result) {
    records::TunedFilterRecord& record = filter.record;
    record.search_evaluations += result.search_evaluations;
    record.evaluations += result.evaluations;
    for (std::size_t i = 0; i < scales.size(); ++i) {
      const SearchedParam& param = scales[i].param();
      const GoodRange& range = result.ranges[i];
      record.searched.push_back({param.name, param.unit, scales[i].name(), param.min, param.max, param.default_value,
                                 result.best[i], range.intervals, range.share, range.no_effect});
    }
  }

  /// Notes what default and found parameters score in every view of a scene.
  void score(TunedFilter& filter, TuneScene& tune_scene, bool training) const {
    render::FilterPasses passes = tune_scene.make_passes(filter.request);
    const std::vector<double> worst(tune_scene.views().size(), kWorstError);
    const Setting asked{filter.request.values, options_.run.fit.cascades};
    const std::vector<double> at_default = tune_scene.score(passes, asked).value_or(worst);
    const std::vector<double> tuned = tune_scene.score(passes, filter.found).value_or(worst);
    for (std::size_t i = 0; i < worst.size(); ++i) {
      const TuneScene::View& view = tune_scene.views()[i];
      filter.record.views.push_back({tune_scene.scene().name,
                                     view.camera->name,
                                     training,
                                     {at_default[i], tuned[i]},
                                     view.truth->standard_error});
    }
  }

  /// One scene and light at a time: their truths need not stand in memory together.
  void score_unseen() {
    for (const scene::Scene& scene : scenes_) {
      std::size_t views = 0;
      for (const std::vector<TuneView>& group : group_by_light(select_views(false))) {
        const std::unique_ptr<TuneScene> tune_scene = make_tune_scene(scene, group);
        views += tune_scene->views().size();
        if (tune_scene->views().empty()) continue;
        for (TunedFilter& filter : filters_) score(filter, *tune_scene, false);
      }
      require_views(scene, views, "unseen");
    }
  }

  std::string write() {
    for (TunedFilter& filter : filters_) {
      records::judge_tuning(filter.record, filter.found.values, metric_.kind == TuneMetricKind::kStatistic);
      scene::FitRule fit = options_.run.fit;
      if (filter.record.verdict == records::TuneVerdict::kBetter) fit.cascades = filter.found.cascades;
      filter.record.fit = scene::describe_fit(fit);
      record_.filters.push_back(filter.record);
    }
    const document::Page page = pages::make_tune_page(record_);
    pages::write_page(options_.run.out, "tune", page);
    write_text_file(options_.run.out / "evaluations.csv",
                    records::make_csv_row({"filter", "evaluation", "stage", "parameters", std::string(metric_.name)}) +
                        evaluations_);
    write_text_file(options_.run.out / "tuned.json", records::make_tuned_json(record_));
    return document::write_markdown(page);
  }
};

/// Runs a check of the catalogue, whose complaints are then about a field of the file.
template <class Check>
decltype(auto) check_field(const std::filesystem::path& file, const std::string& field, const Check& check) {
  try {
    return check();
  } catch (const Error& error) {
    throw Error(ErrorKind::kInput, fmt::format("the field {}: {}", field, error.message()), file.string());
  }
}

filters::ParamValues read_values(const filters::FilterSpec& spec, const records::ParamMap& params,
                                 const std::filesystem::path& file, const std::string& field) {
  filters::ParamValues values;
  for (const auto& [name, param] : params) {
    filters::ParamValue value;
    std::visit([&value](const auto& held) { value = held; }, param);
    values[name] = check_field(file, field + "." + name, [&spec, &key = name, &value] {
      return filters::parse_value(spec, key, filters::to_string(value));
    });
  }
  return values;
}

void take_values(filters::FilterRequest& request, const filters::ParamValues& values) {
  const filters::ParamValues defaults = filters::default_values(request.spec);
  for (const auto& [name, value] : values) {
    const bool is_set = request.set_by_user.contains(name);
    // A radius that a width asked for is no wish for this very radius.
    const auto* radius = std::get_if<std::string>(&request.spec.radius_texels);
    const bool by_width = !request.width.empty() && radius && *radius == name;
    if (is_set && !by_width) continue;
    if (by_width) request.width.clear();
    request.values[name] = value;
    if (value != defaults.at(name)) request.set_by_user.insert(name);  // labels have it
  }
}

}  // namespace

std::vector<SearchedParam> list_searched_params(const filters::FilterRequest& request) {
  std::vector<SearchedParam> params;
  for (const filters::ParamSpec& param : request.spec.params) {
    const bool fixed = request.set_by_user.contains(param.name);
    if (fixed || param.is_const || !param.choices.empty() || !param.min || !param.max || !(*param.min < *param.max))
      continue;
    params.push_back(
        {param.name, *param.min, *param.max, std::get<double>(param.default_value), param.integer, param.unit});
  }
  return params;
}

std::vector<SearchedParam> list_searched_params(const scene::FitRule& fit, const std::set<std::string>& fixed) {
  if (fit.mode != scene::FitMode::kCascades) return {};
  const scene::CascadeRule& rule = fit.cascades;
  std::vector<SearchedParam> params = {{"split", 0.0, 1.0, rule.split, false, {}, &scene::CascadeRule::split},
                                       {"blend", 0.0, kWidestBlend, rule.blend, false, {}, &scene::CascadeRule::blend}};
  std::erase_if(params, [&](const SearchedParam& param) {
    return fixed.contains(param.name) || (param.name == "split" && !rule.splits.empty());
  });
  return params;
}

double find_widest_kernel(const std::vector<filters::FilterRequest>& requests) {
  double widest = 0.0;
  for (const filters::FilterRequest& request : requests) {
    filters::ParamValues values = request.values;
    for (const SearchedParam& param : list_searched_params(request)) values[param.name] = param.max;
    widest = std::max(
        {widest, filters::radius_texels(request.spec, request.values), filters::radius_texels(request.spec, values)});
  }
  return widest;
}

double choose_tune_padding(double widest_kernel_texels, int map_size) {
  const double largest = std::max(kLeastPadding, std::floor(kLargestPaddingShare * map_size));
  return std::min(std::ceil(widest_kernel_texels) + 1.0, largest);
}

std::string tune_filters(const TuneOptions& options, options::Progress& progress) {
  return Tuner(options, progress).run();
}

std::vector<std::string> apply_tuned(std::vector<filters::FilterRequest>& requests, const filters::Catalogue& catalogue,
                                     const std::filesystem::path& file, const std::vector<int>& map_sizes,
                                     const std::vector<scene::FitRule>& fits) {
  const records::TunedSettings tuned = records::read_tuned_settings(file);
  std::map<std::string, filters::ParamValues> found;
  std::map<std::string, std::string> fit_of;
  for (std::size_t i = 0; i < tuned.filters.size(); ++i) {
    const records::TunedSettings::Filter& filter = tuned.filters[i];
    const std::string field = fmt::format("filters[{}]", i);
    const filters::FilterSpec& spec =
        check_field(file, field + ".id", [&]() -> const filters::FilterSpec& { return catalogue.find(filter.id); });
    fit_of[filter.id] = filter.fit;
    found[filter.id] = read_values(spec, filter.params, file, field + ".params");
  }
  std::vector<std::string> notes;
  const std::set<std::string> drawn = scene::describe_fits(fits);
  for (filters::FilterRequest& request : requests) {
    if (!request.presets.empty()) continue;  // what an engine ships has the engine's parameters, those unsaid too
    const auto values = found.find(request.spec.id);
    if (values != found.end()) {
      take_values(request, values->second);
      if (const std::string& fit = fit_of[request.spec.id]; !drawn.contains(fit))
        notes.push_back(fmt::format("{} was tuned for {} under --fit {}, which this run does not draw", file.string(),
                                    request.label(), fit));
    } else if (!request.spec.params.empty())
      notes.push_back(fmt::format("{} has no parameters for {}, which keeps its own", file.string(), request.label()));
  }
  for (const int map_size : map_sizes) {
    if (map_size == tuned.map_size) continue;
    notes.push_back(
        fmt::format("{} was tuned on maps of {} texels, this run draws {}: a radius in texels is another one in metres",
                    file.string(), tuned.map_size, map_size));
  }
  return notes;
}

}  // namespace shadowbench::tune
