#include "report/pages/stress_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "report/page/markdown.h"
#include "report/pages/write_page.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

std::string format_value(const std::optional<double>& value, const char* nothing) {
  return value ? fmt::format("{:.4g}", *value) : std::string(nothing);
}

std::string format_onset(const std::optional<records::StressOnset>& onset) {
  if (!onset) return records::kNothing;
  return onset->last_before ? fmt::format("{:.4g}", onset->value)
                            : fmt::format("{:.4g} (where the range begins)", onset->value);
}

/// The last value before the filter degrades.
std::string format_last_ok(const records::StressCase& item) {
  if (!item.not_available.empty()) return records::kNothing;
  const records::StressOnset* onset = records::find_onset(item, records::StressVerdict::kDegraded);
  if (!onset) return "all of the range";
  return onset->last_before ? fmt::format("{:.4g}", *onset->last_before) : "nowhere";
}

std::string format_reason(const records::StressCase& item) {
  if (!item.not_available.empty()) return "not available: " + item.not_available;
  const records::StressOnset* onset = records::find_onset(item, records::StressVerdict::kBroken);
  if (!onset) onset = records::find_onset(item, records::StressVerdict::kDegraded);
  return onset ? onset->why : std::string();
}

std::vector<std::string> make_limit_row(const records::StressAxis& axis, const records::StressCase& item,
                                        const records::StressLimit& limit) {
  return {axis.id,
          records::label_of(item),
          records::name_of(limit.predicts),
          limit.formula,
          limit.onset ? fmt::format("{:.4g}", *limit.onset) : "none",
          format_value(limit.measured, "not in the range"),
          limit.ratio ? fmt::format("{:.3f}", *limit.ratio) : std::string(records::kNothing),
          limit.kind == records::StressTheoryKind::kRounding ? "rounding, factor 8"
                                                             : fmt::format("{}, 10 %", records::name_of(limit.kind)),
          records::name_of(limit.agreement)};
}

/// Whether a limit was not met, as theory says: the range ends before it, or theory says that there is none.
bool is_out_of_sight(const records::StressLimit& limit) {
  return !limit.measured && limit.agreement == records::StressAgreement::kAgrees;
}

std::vector<std::string> list_limits(const records::StressAxis& axis, records::StressAgreement agreement) {
  std::vector<std::string> sentences;
  for (const records::StressCase& item : axis.cases) {
    for (const records::StressLimit& limit : item.limits) {
      if (limit.agreement != agreement) continue;
      sentences.push_back(
          fmt::format("{}: {} at {}, where theory says {} ({}){}{}.", records::label_of(item),
                      records::name_of(limit.predicts), format_value(limit.measured, "no value of the range"),
                      limit.onset ? fmt::format("{:.4g}", *limit.onset) : "none", limit.formula,
                      limit.explanation.empty() ? ", and nothing explains it" : ": ", limit.explanation));
    }
  }
  return sentences;
}

constexpr double kEarly = 0.5;        // a limit before this share of an axis' range fails
constexpr double kLeastShown = 1e-9;  // on a logarithmic axis
constexpr const char* kStressNote =
    "The share that a filter's worst variant is ok in, to its best one's. \u2717: one breaks, or is over the axis' "
    "bound "
    "before half of the range.";
constexpr const char* kNoFilter = "no filter";

/// The share of an axis' range, from its easy end on, in which a case is ok.
double measure_reach(const records::StressAxis& axis, const records::StressCase& item) {
  const records::StressOnset* onset = records::find_onset(item, records::StressVerdict::kDegraded);
  if (!onset) return 1.0;
  if (!onset->last_before) return 0.0;
  const auto place = [&](double value) { return axis.log ? std::log(value) : value; };
  const double easy = *onset->last_before > onset->value ? axis.range.high : axis.range.low;
  return std::abs((place(*onset->last_before) - place(easy)) / (place(axis.range.high) - place(axis.range.low)));
}

/// What a filter's variants come to on an axis. A scalar model is no variant: it says what the GL should do.
struct Standing {
  double least = 1.0, most = 0.0;  ///< of what measure_reach() measures
  bool breaks = false;

  page::Grade grade() const {
    if (breaks || least < kEarly) return page::Grade::kBad;
    return least < 1.0 ? page::Grade::kNear : page::Grade::kGood;
  }
  std::string describe() const {
    return fmt::format("{:.0f}{} %", 100.0 * least, most > least ? fmt::format(" .. {:.0f}", 100.0 * most) : "");
  }
};

std::map<std::string, Standing> find_standings(const records::StressAxis& axis) {
  std::map<std::string, Standing> standings;
  for (const records::StressCase& item : axis.cases) {
    if (item.level == "model" || item.samples.empty()) continue;
    Standing& standing = standings[item.filter.empty() ? kNoFilter : item.filter];
    standing.least = std::min(standing.least, measure_reach(axis, item));
    standing.most = std::max(standing.most, measure_reach(axis, item));
    standing.breaks = standing.breaks || item.broken;
  }
  return standings;
}

/// Says who holds furthest on the axes that have all filters of a table, and how much of the table fails.
std::string summarize_stress(const records::StressRecord& record, const page::Table& table) {
  std::vector<std::pair<double, std::string>> reaches;
  for (const std::string& name : table.table.header)
    if (name != table.table.header.front() && name != kNoFilter) reaches.emplace_back(0.0, name);
  int axes = 0;
  for (const records::StressAxis& axis : record.axes) {
    const auto standings = find_standings(axis);
    const auto has = [&](const auto& reach) { return standings.contains(reach.second); };
    if (reaches.empty() || !std::ranges::all_of(reaches, has)) continue;
    ++axes;
    for (auto& [reach, name] : reaches) reach += standings.at(name).least;
  }
  std::string text;
  if (axes > 0) {
    const auto [least, most] = std::ranges::minmax_element(reaches, {}, &std::pair<double, std::string>::first);
    text = fmt::format("On the {} that every filter has, {} holds furthest, {:.0f} % of the range on average",
                       axes == 1 ? "axis" : fmt::format("{} axes", axes), most->second, 100.0 * most->first / axes);
    if (least->first < most->first)
      text += fmt::format(", and {} least far, {:.0f} %", least->second, 100.0 * least->first / axes);
    text += ". ";
  }
  std::ptrdiff_t failed = 0, all = 0;
  for (const auto& row : table.grades) {
    failed += std::ranges::count(row, page::Grade::kBad);
    all += std::ssize(row) - std::ranges::count(row, page::Grade::kNone);
  }
  return text + fmt::format(
                    "{} of {} cells fail; limits that are not where theory puts them, and that nothing "
                    "explains: {}.",
                    failed, all, records::count_disagreements(record));
}

page::Section make_stress_answer(const records::StressRecord& record) {
  page::Table table{"How much of each axis' range holds", {{"axis"}, {}}};
  for (const records::StressAxis& axis : record.axes) {
    const auto standings = find_standings(axis);
    for (const records::StressCase& item : axis.cases) {
      const auto found = standings.find(item.filter.empty() ? kNoFilter : item.filter);
      if (found == standings.end()) continue;
      table.judge(fmt::format("{}: {}, {:g} .. {:g}", axis.id, axis.quantity, axis.range.low, axis.range.high),
                  found->first, found->second.describe(), found->second.grade());
    }
  }
  page::Paragraph answer{summarize_stress(record, table)};
  return {"answer", "", {std::move(answer), std::move(table), page::Paragraph{kStressNote, true}}};
}

bool is_shown(const records::StressAxis& axis, const std::optional<double>& measured) {
  return measured && (!axis.measured_log || *measured >= kLeastShown);
}

page::ChartAxis choose_value_axis(const records::StressAxis& axis) {
  if (axis.log) return page::choose_log_axis({axis.range.low, axis.range.high}, {});
  page::ChartAxis chosen = page::choose_axis({axis.range.low, axis.range.high}, {}, page::TickKind::kNumber);
  if (chosen.log)  // choose_axis() prefers a logarithm for what is positive
    chosen = page::choose_axis({0.0, axis.range.high}, {}, page::TickKind::kNumber);
  return chosen;
}

page::ChartAxis choose_measured_axis(const records::StressAxis& axis) {
  std::vector<double> values = {axis.bound};
  for (const records::StressCase& item : axis.cases) {
    for (const records::StressSample& sample : item.samples)
      if (is_shown(axis, sample.measured)) values.push_back(*sample.measured);
  }
  return axis.measured_log ? page::choose_log_axis(values, {}) : page::choose_axis(values, {}, page::TickKind::kNumber);
}

page::ChartSeries make_line(std::string title, page::ChartPoint from, page::ChartPoint to, std::string color,
                            page::LineStyle style) {
  page::ChartSeries series;
  series.title = std::move(title);
  series.color = std::move(color);
  series.line = style;
  series.points = {std::move(from), std::move(to)};
  return series;
}

void add_case(page::Chart& chart, const records::StressAxis& axis, const records::StressCase& item,
              const page::ChartStyle& style) {
  const bool model = item.level == "model";  // a dashed line beside the GL's, whose points would hide it
  page::ChartSeries line, broken;
  line.title = records::label_of(item);
  line.color = broken.color = style.color;
  line.mark = model ? page::Mark::kNone : style.mark;
  broken.mark = style.mark;
  line.filled = false;
  line.line = model ? page::LineStyle::kDashed : page::LineStyle::kSolid;
  for (const records::StressSample& sample : item.samples) {
    const bool shown = is_shown(axis, sample.measured);
    if (!shown && sample.verdict != records::StressVerdict::kBroken) continue;
    page::ChartPoint point = page::exact_point(sample.value, shown ? *sample.measured : chart.y.high);
    point.details = {line.title, fmt::format("{} {:.4g}: {}", axis.quantity, sample.value, name_of(sample.verdict)),
                     fmt::format("{}: {}", axis.measured, format_value(sample.measured, "nothing finite"))};
    if (!sample.why.empty()) point.details.push_back(sample.why);
    if (sample.verdict == records::StressVerdict::kBroken) broken.points.push_back(point);
    if (shown) line.points.push_back(std::move(point));
  }
  chart.series.push_back(std::move(line));
  if (!broken.points.empty()) chart.series.push_back(std::move(broken));
}

/// Adds a vertical line for each theoretical limit within the chart; equal limits are one line.
void add_theory(page::Chart& chart, const records::StressAxis& axis) {
  std::map<std::string, double> onsets;  // by what the label says
  bool says_none = false;
  for (const records::StressCase& item : axis.cases) {
    for (const records::StressLimit& limit : item.limits) {
      says_none = says_none || !limit.onset;
      if (limit.onset && *limit.onset >= chart.x.low && *limit.onset <= chart.x.high)
        onsets.emplace(fmt::format("{:.4g}", *limit.onset), *limit.onset);
    }
  }
  std::string title = "theoretical limits";
  for (const auto& [label, onset] : onsets)
    chart.series.push_back(make_line(std::exchange(title, {}), page::exact_point(onset, chart.y.low),
                                     page::exact_point(onset, chart.y.high), page::kInk, page::LineStyle::kTies));
  if (says_none) chart.notes.push_back("some cases have no theoretical limit");
}

void add_exhibit(std::vector<page::Block>& blocks, const records::StressExhibit& exhibit) {
  blocks.emplace_back(page::Heading{exhibit.title});
  blocks.emplace_back(page::Sentences{{}, exhibit.sentences});
  if (exhibit.table) blocks.emplace_back(page::Table{exhibit.title, *exhibit.table});
  for (const records::StressExhibit::Picture& picture : exhibit.pictures)
    blocks.emplace_back(page::Gallery{{}, {{picture.file, picture.caption}}});
}

page::Section make_axis_section(const records::StressAxis& axis) {
  page::Section section{axis.id, fmt::format("{}: {}", axis.id, axis.title), {}};
  if (has_stress_chart(axis)) section.blocks.emplace_back(make_stress_chart(axis));
  page::Details details{"Every variant, and why",
                        {page::Paragraph{describe_axis(axis), true},
                         page::Table{"What is safe, and where it ends", make_case_table(axis)}}};
  const auto add_sentences = [&](const char* lead, std::vector<std::string> sentences) {
    if (!sentences.empty()) details.blocks.emplace_back(page::Sentences{lead, std::move(sentences)});
  };
  add_sentences("Not what theory says, and why:", describe_explanations(axis));
  add_sentences("Also seen:", describe_notes(axis));
  for (const records::StressExhibit& exhibit : axis.exhibits) add_exhibit(details.blocks, exhibit);
  section.blocks.emplace_back(std::move(details));
  return section;
}

page::Details make_limit_details(const records::StressRecord& record) {
  page::Details details{"Measured against theoretical limits",
                        {page::Table{"Where each verdict is first met, found to 1 %", make_limit_table(record)}}};
  if (std::vector<std::string> unseen = describe_out_of_sight(record); !unseen.empty())
    details.blocks.emplace_back(page::Sentences{"Not met, and not expected:", std::move(unseen)});
  return details;
}

}  // namespace

records::TextTable make_case_table(const records::StressAxis& axis) {
  records::TextTable table{{"case", "last value that is ok", "degraded from", "broken from", "why", "observations"},
                           {}};
  for (const records::StressCase& item : axis.cases) {
    table.rows.push_back({records::label_of(item), format_last_ok(item), format_onset(item.degraded),
                          format_onset(item.broken), format_reason(item), fmt::format("{}", item.samples.size())});
  }
  return table;
}

records::TextTable make_limit_table(const records::StressRecord& record) {
  records::TextTable table{
      {"axis", "case", "verdict", "theory", "theoretical", "measured", "ratio", "kind, tolerance", "result"}, {}};
  for (const records::StressAxis& axis : record.axes) {
    for (const records::StressCase& item : axis.cases) {
      for (const records::StressLimit& limit : item.limits)
        if (!is_out_of_sight(limit)) table.rows.push_back(make_limit_row(axis, item, limit));
    }
  }
  return table;
}

std::vector<std::string> describe_out_of_sight(const records::StressRecord& record) {
  std::vector<std::string> sentences;
  for (const records::StressAxis& axis : record.axes) {
    int unlimited = 0, beyond = 0;
    for (const records::StressCase& item : axis.cases) {
      for (const records::StressLimit& limit : item.limits)
        if (is_out_of_sight(limit)) ++(limit.onset ? beyond : unlimited);
    }
    std::vector<std::string> counts;
    if (unlimited > 0) counts.push_back(fmt::format("{} where it says that there is none", unlimited));
    if (beyond > 0) counts.push_back(fmt::format("{} where it puts it beyond the range", beyond));
    if (!counts.empty())
      sentences.push_back(
          fmt::format("{}: no limit within the range, as theory says: {}.", axis.id, fmt::join(counts, ", ")));
  }
  return sentences;
}

std::vector<std::string> describe_explanations(const records::StressAxis& axis) {
  return list_limits(axis, records::StressAgreement::kExplained);
}

std::vector<std::string> describe_disagreements(const records::StressAxis& axis) {
  return list_limits(axis, records::StressAgreement::kDisagrees);
}

std::vector<std::string> describe_absences(const records::StressAxis& axis) {
  std::vector<std::string> sentences;
  for (const records::StressCase& item : axis.cases)
    if (!item.not_available.empty()) sentences.push_back(records::label_of(item) + ": " + item.not_available);
  return sentences;
}

std::vector<std::string> describe_notes(const records::StressAxis& axis) {
  std::vector<std::string> sentences;
  for (const records::StressCase& item : axis.cases)
    for (const std::string& note : item.notes)
      sentences.push_back(fmt::format("{}: {}.", records::label_of(item), note));
  return sentences;
}

std::string describe_axis(const records::StressAxis& axis) {
  return fmt::format("Over the {}{}, {:g} .. {:g}. Measured: {}{}; degraded where it is over {:g}. Broken: {}.",
                     axis.quantity, axis.unit.empty() ? "" : ", " + axis.unit, axis.range.low, axis.range.high,
                     axis.measured, axis.measured_unit.empty() ? "" : ", " + axis.measured_unit, axis.bound,
                     axis.broken_when);
}

bool has_stress_chart(const records::StressAxis& axis) {
  return std::ranges::any_of(
      axis.cases, [](const records::StressCase& item) { return !item.samples.empty(); });
}

page::Chart make_stress_chart(const records::StressAxis& axis) {
  const auto with_unit = [](const std::string& name, const std::string& unit) {
    return unit.empty() ? name : fmt::format("{}, {}", name, unit);
  };
  page::Chart chart;
  chart.id = "stress." + axis.id;
  chart.title = axis.title;
  chart.x_name = with_unit(axis.quantity, axis.unit);
  chart.y_name = with_unit(axis.measured, axis.measured_unit);
  chart.x = choose_value_axis(axis);
  chart.y = choose_measured_axis(axis);
  std::map<std::string, std::size_t> styles;  // the levels of one variant are drawn alike
  std::vector<std::pair<double, std::string>> weights;
  for (const records::StressCase& item : axis.cases) {
    if (item.samples.empty()) continue;
    const bool reference = item.filter == "none" && weights.empty();
    const double hidden_by = item.level == "model" ? 1.0 : 0.0;  // its GL's curve, which it follows
    weights.emplace_back(reference ? 1.0 : -measure_reach(axis, item) - hidden_by, records::label_of(item));
    const auto style = styles.emplace(item.filter + ": " + item.variant, styles.size()).first;
    add_case(chart, axis, item, page::style_of(style->second));
  }
  chart.series.push_back(make_line(fmt::format("bound, {:g}", axis.bound), page::exact_point(chart.x.low, axis.bound),
                                   page::exact_point(chart.x.high, axis.bound), "#8a8f98", page::LineStyle::kDashed));
  add_theory(chart, axis);
  chart.notes.push_back("filled: broken, at the upper edge where nothing finite was measured");
  page::show_most_telling(chart, std::move(weights));
  return chart;
}

std::string make_limit_text(const records::StressRecord& record) {
  std::string text = page::write_markdown_table(make_limit_table(record));
  const std::vector<std::string> unseen = describe_out_of_sight(record);
  if (unseen.empty()) return text;
  text += "Not met, and not expected:\n\n";
  for (const std::string& sentence : unseen) text += "- " + sentence + "\n";
  return text + "\n";
}

page::Page make_stress_page(const records::StressRecord& record) {
  page::Page page{"Where filters break", {make_stress_answer(record)}, {}};
  std::vector<std::string> warnings;
  for (const records::StressAxis& axis : record.axes)
    for (const std::string& sentence : describe_disagreements(axis)) warnings.push_back(axis.id + ": " + sentence);
  if (!warnings.empty())
    page.sections.push_back({"warnings", "Warnings", {page::Sentences{{}, std::move(warnings)}}, true});
  for (const records::StressAxis& axis : record.axes) page.sections.push_back(make_axis_section(axis));
  page.sections.push_back({"data",
                           "",
                           {make_limit_details(record), page::Details{"Settings and data",
                                                                      {page::Facts{list_provenance(record)},
                                                                       page::Sentences{"Filters:", record.filters},
                                                                       link_data({"stress.json", "stress.csv"})}}}});
  return page;
}

}  // namespace shadowbench::pages
