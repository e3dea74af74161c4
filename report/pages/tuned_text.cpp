#include "report/pages/tuned_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "report/analysis/summary.h"
#include "report/page/markdown.h"
#include "report/page/markdown_table.h"
#include "report/pages/tables.h"
#include "report/pages/text_tables.h"
#include "report/records/format.h"
#include "report/records/text_table.h"

namespace shadowbench::pages {
namespace {

/// Writes a parameter as the command line takes it.
std::string format_value(double value) { return fmt::format("{:.5g}", value); }

std::string format_percent(double share) { return fmt::format("{:.3g} %", 100.0 * share); }

std::string format_gain(const records::TunedScore& score) {
  return score.at_default > 0.0 ? fmt::format("{:+.1f} %", 100.0 * score.gain() / score.at_default)
                                : std::string(records::kNothing);
}

std::string make_param_table(const records::TunedFilterRecord& filter, const std::string& metric) {
  records::TextTable table;
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
  return page::make_markdown_table(table);
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

std::string make_range_table(const records::TunedFilterRecord& filter, double tolerance) {
  records::TextTable table;
  table.header = {"parameter", "searched", "scale", fmt::format("within {:g} % of the best", 100.0 * tolerance),
                  "share of the scale"};
  for (const records::TunedParamRecord& param : filter.searched) {
    table.rows.push_back({param.name, fmt::format("{} .. {}", format_value(param.min), format_value(param.max)),
                          param.scale, format_intervals(param), format_percent(param.good_share)});
  }
  return page::make_markdown_table(table);
}

/// One row per scene: means over its unseen views; and a sentence about scenes that lose by the parameters found.
std::string make_scene_table(const records::TunedFilterRecord& filter, const records::TunedRecord& record) {
  records::TextTable table;
  std::vector<std::string> losers;
  table.header = {"scene, unseen views", record.metric + ", default", record.metric + ", found", "gain",
                  "better in",           "truth's standard error"};
  for (const std::string& scene : record.scenes) {
    records::TunedScore sum;
    double truth_se = 0.0;
    int views = 0, better = 0;
    for (const records::TunedViewRecord& view : filter.views) {
      if (view.scene != scene || view.training) continue;
      sum.at_default += view.score.at_default;
      sum.tuned += view.score.tuned;
      truth_se += view.truth_se;
      ++views;
      better += view.score.gain() > 0.0 ? 1 : 0;
    }
    const records::TunedScore mean{sum.at_default / views, sum.tuned / views};
    if (mean.gain() < 0.0) losers.push_back(page::escape_markdown(scene));
    table.rows.push_back(
        {page::escape_markdown(scene), records::format_number(mean.at_default), records::format_number(mean.tuned),
         format_gain(mean), fmt::format("{} of {} views", better, views),
         filter.unseen_truth_se ? records::format_number(truth_se / views) : std::string(records::kNothing)});
  }
  if (losers.empty()) return page::make_markdown_table(table);
  return page::make_markdown_table(table) +
         fmt::format("Worse by them: {}. Tune for such scenes apart (--scene).\n\n", fmt::join(losers, ", "));
}

std::string make_filter_text(const records::TunedFilterRecord& filter, const records::TunedRecord& record) {
  std::string text = fmt::format("## {}\n\n", filter.label);
  text += make_param_table(filter, record.metric);
  text += describe_verdict(filter, record.metric) + "\n\n";
  text += make_scene_table(filter, record);
  text += make_range_table(filter, record.tolerance);
  text += fmt::format("{} settings were drawn: {} by the search, the others for the good ranges.\n\n",
                      filter.evaluations, filter.search_evaluations);
  return text;
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

std::string make_tuned_text(const records::TunedRecord& record) {
  std::string text = fmt::format("# Parameters tuned for {}\n\n", record.metric);
  text += fmt::format(
      "Scenes: {}. Map {} texels, padded by {:g} (the widest kernel searched is {:g}); picture {}x{}; {}; program "
      "{}.\n",
      fmt::join(record.scenes, ", "), record.map_size, record.pad_texels, record.widest_kernel, record.width,
      record.height, record.renderer, record.commit);
  text +=
      fmt::format("Light: {}. Bias: {}. Seed: {}.\n", record.light.empty() ? "each scene's own" : record.light,
                  record.bias.empty() ? "the default" : fmt::format("{}", fmt::join(record.bias, " ")), record.seed);
  text += fmt::format("Training views of each scene, in degrees: {}. Unseen: {}. A score is the mean over views.\n\n",
                      record.training_views, record.unseen_views);
  for (const std::string& note : record.notes) text += fmt::format("Left out: {}.\n\n", page::escape_markdown(note));
  for (const records::TunedFilterRecord& filter : record.filters) text += make_filter_text(filter, record);
  return text;
}

}  // namespace shadowbench::pages
