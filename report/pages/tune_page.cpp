#include "report/pages/tune_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "report/pages/write_page.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

constexpr const char* kTuneNote =
    "\u2717: worse than the default; tune for such scenes apart (--scene). Green: gains more than the truth's standard "
    "error.";

/// Writes a parameter as the command line takes it.
std::string format_value(double value) { return fmt::format("{:.5g}", value); }

std::string format_gain(const records::TunedScore& score) {
  return score.at_default > 0.0 ? fmt::format("{:+.1f} %", 100.0 * score.gain() / score.at_default)
                                : std::string(records::kNothing);
}

document::Table make_param_table(const records::TunedFilterRecord& filter, const std::string& metric) {
  document::Table block{"Parameters and scores", {}};
  records::TextTable& table = block.table;
  table.header = {filter.id};
  std::vector<std::string> defaults = {"default"}, found = {"found"};
  for (const records::TunedParamRecord& param : filter.searched) {
    table.header.push_back(param.unit.empty() ? param.name : fmt::format("{}, {}", param.name, param.unit));
    defaults.push_back(format_value(param.default_value));
    found.push_back(format_value(param.found));
  }
  const auto add = [&](const std::string& name, const records::TunedScore& score) {
    table.header.push_back(fmt::format("{}, {}", metric, name));
    defaults.push_back(records::format_number(score.at_default));
    found.push_back(records::format_number(score.tuned));
  };
  add("training", filter.training);
  add("unseen", filter.unseen);
  table.rows = {defaults, found};
  return block;
}

std::string format_intervals(const records::TunedParamRecord& param) {
  if (param.no_effect) return "all of it: no effect";
  std::vector<std::string> texts;
  for (const records::Interval& interval : param.good) {
    texts.push_back(interval.low == interval.high
                        ? format_value(interval.low)
                        : fmt::format("{} .. {}", format_value(interval.low), format_value(interval.high)));
  }
  return fmt::format("{}", fmt::join(texts, ", and "));
}

document::Table make_range_table(const records::TunedFilterRecord& filter, double tolerance) {
  document::Table block{"How wide the good range of each parameter is, the others at theirs", {}};
  records::TextTable& table = block.table;
  table.header = {"parameter", "searched", "scale", fmt::format("within {:g} % of the best", 100.0 * tolerance),
                  "share of the scale"};
  for (const records::TunedParamRecord& param : filter.searched) {
    table.rows.push_back({param.name, fmt::format("{} .. {}", format_value(param.min), format_value(param.max)),
                          param.scale, format_intervals(param), records::format_rate(param.good_share)});
  }
  return block;
}

/// A filter's scores on a scene's unseen views.
struct SceneScore {
  std::string scene;
  records::TunedScore mean;
  double truth_se = 0.0;
  int views = 0;
};

std::vector<SceneScore> average_scenes(const records::TunedFilterRecord& filter, const records::TunedRecord& record) {
  std::vector<SceneScore> scores;
  for (const std::string& scene : record.scenes) {
    SceneScore& score = scores.emplace_back();
    score.scene = scene;
    for (const records::TunedViewRecord& view : filter.views) {
      if (view.scene != scene || view.training) continue;
      score.mean.at_default += view.score.at_default;
      score.mean.tuned += view.score.tuned;
      score.truth_se += view.truth_se;
      ++score.views;
    }
    score.mean.at_default /= score.views;
    score.mean.tuned /= score.views;
    score.truth_se /= score.views;
  }
  return scores;
}

document::Section make_filter_section(const records::TunedFilterRecord& filter, const records::TunedRecord& record) {
  return {filter.id,
          filter.label,
          {document::Paragraph{describe_verdict(filter, record.metric)}, make_param_table(filter, record.metric),
           make_range_table(filter, record.tolerance),
           document::Paragraph{fmt::format("{} settings were drawn: {} by the search, the others for the good ranges.",
                                           filter.evaluations, filter.search_evaluations),
                               true}}};
}

document::Grade grade_gain(const records::TunedScore& score, double truth_se) {
  if (score.gain() < 0.0) return document::Grade::kBad;
  return score.gain() > truth_se ? document::Grade::kGood : document::Grade::kNear;
}

/// Names what was found for a filter: "vsm radius 7, min_variance 1e-05: rmse 0.12 to 0.08 (+33.3 %)".
std::string describe_found(const records::TunedFilterRecord& filter, const records::TunedRecord& record) {
  std::vector<std::string> params;
  for (const records::TunedParamRecord& param : filter.searched)
    params.push_back(param.name + " " + format_value(param.found));
  return fmt::format("{} with {}{}: {} {} to {} ({})", filter.label, fmt::join(params, ", "),
                     filter.fit == record.fit ? "" : " (--fit " + filter.fit + ")", record.metric,
                     records::format_number(filter.unseen.at_default), records::format_number(filter.unseen.tuned),
                     format_gain(filter.unseen));
}

document::Section make_tune_answer(const records::TunedRecord& record) {
  document::Table table{fmt::format("Gain in {} on unseen views", record.metric), {{"scene"}, {}}};
  std::vector<std::string> kept, others;
  for (const records::TunedFilterRecord& filter : record.filters) {
    for (const SceneScore& score : average_scenes(filter, record))
      table.judge(score.scene, filter.label, format_gain(score.mean),
                  grade_gain(score.mean, filter.unseen_truth_se ? score.truth_se : 0.0));
    table.judge("all scenes", filter.label, format_gain(filter.unseen),
                grade_gain(filter.unseen, filter.unseen_truth_se.value_or(0.0)));
    const bool better = filter.verdict == records::TuneVerdict::kBetter;
    (better ? kept : others).push_back(better ? describe_found(filter, record) : filter.label);
  }
  std::string text = kept.empty() ? "Nothing found is better than the defaults on unseen views."
                                  : fmt::format("Better on unseen views: {}.", fmt::join(kept, "; "));
  if (!kept.empty() && !others.empty()) text += fmt::format(" The default stays for {}.", fmt::join(others, ", "));
  return {"answer", "", {document::Paragraph{std::move(text)}, std::move(table), document::Paragraph{kTuneNote, true}}};
}

std::vector<std::pair<std::string, std::string>> list_tune_facts(const records::TunedRecord& record) {
  return {{"scenes", fmt::format("{}", fmt::join(record.scenes, ", "))},
          {"training views", fmt::format("{} of each scene, in degrees", record.training_views)},
          {"unseen views", record.unseen_views},
          {"score", fmt::format("mean of {} over the views", record.metric)},
          {"shadow map", fmt::format("{} texels, fit {}, padded by {:g} (the widest kernel searched is {:g})",
                                     record.map_size, record.fit, record.pad_texels, record.widest_kernel)},
          {"picture", fmt::format("{} x {} pixels", record.width, record.height)},
          {"light", record.light.empty() ? "each scene's own" : record.light},
          {"bias", record.bias.empty() ? "the default" : fmt::format("{}", fmt::join(record.bias, " "))},
          {"seed", fmt::format("{}", record.seed)},
          {"drawn by", record.renderer},
          {"program", record.commit}};
}

}  // namespace

std::string describe_verdict(const records::TunedFilterRecord& filter, const std::string& metric) {
  const std::string numbers = fmt::format(
      "Gain on unseen views: {} ({} {} to {}{})", format_gain(filter.unseen), metric,
      records::format_number(filter.unseen.at_default), records::format_number(filter.unseen.tuned),
      filter.unseen_truth_se ? "; the truth's standard error is " + records::format_number(*filter.unseen_truth_se)
                             : std::string());
  switch (filter.verdict) {
    case records::TuneVerdict::kBetter: return numbers + ". Kept: the parameters found.";
    case records::TuneVerdict::kOverfitted:
      return numbers + ". Overfitted: better in training, but not on views it has not seen. Kept: the default.";
    case records::TuneVerdict::kNoGain: break;
  }
  return fmt::format("{}. No gain{}. Kept: the default.", numbers,
                     filter.unseen_truth_se
                         ? ": the difference, in training or on unseen views, is within the truth's standard error"
                         : "");
}

document::Page make_tune_page(const records::TunedRecord& record) {
  document::Page page{fmt::format("Parameters tuned for {}", record.metric), {make_tune_answer(record)}, {}};
  for (const records::TunedFilterRecord& filter : record.filters)
    page.sections.push_back(make_filter_section(filter, record));
  document::Details details{"Settings and data", {document::Facts{list_tune_facts(record)}}};
  if (!record.notes.empty()) details.blocks.emplace_back(document::Sentences{"Left out:", record.notes});
  details.blocks.emplace_back(link_data({"tuned.json", "evaluations.csv"}));
  page.sections.push_back({"data", "", {std::move(details)}});
  return page;
}

}  // namespace shadowbench::pages
