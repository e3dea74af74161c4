#include "report/pages/stress_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "report/pages/write_page.h"
#include "report/records/format.h"

namespace shadowbench::pages {

using records::find_onset, records::label_of, records::StressAgreement, records::StressAxis, records::StressCase,
    records::StressLimit, records::StressRecord, records::StressVerdict;

namespace {

std::string format_value(const std::optional<double>& value, const char* nothing) {
  return value ? fmt::format("{:.4g}", *value) : std::string(nothing);
}

std::string format_onset(const std::optional<records::StressOnset>& onset) {
  if (!onset) return records::kNothing;
  return fmt::format("{:.4g}{}", onset->value, onset->last_before ? "" : " (where the range begins)");
}

/// Whether a limit was not met, as theory says: the range ends before it, or theory says that there is none.
bool is_out_of_sight(const StressLimit& limit) {
  return !limit.measured && limit.agreement == StressAgreement::kAgrees;
}

/// All limits of an axis, each after its case.
std::vector<std::pair<const StressCase*, const StressLimit*>> list_limits(const StressAxis& axis) {
  std::vector<std::pair<const StressCase*, const StressLimit*>> limits;
  for (const StressCase& item : axis.cases)
    for (const StressLimit& limit : item.limits) limits.emplace_back(&item, &limit);
  return limits;
}

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : fmt::format("{}, {}", name, unit);
}

constexpr double kEarly = 0.5;        // a limit before this share of an axis' range fails
constexpr double kLeastShown = 1e-9;  // on a logarithmic axis
constexpr const char* kStressNote =
    "The share that a filter's worst variant is ok in, to its best one's. \u2717: one breaks, or is over the axis' "
    "bound before half of the range. –: nothing was measured; an axis asks only filters that have what it drives.";
constexpr const char* kNoFilter = "no filter";

/// The share of an axis' range, from its easy end on, in which a case is ok.
double measure_reach(const StressAxis& axis, const StressCase& item) {
  const records::StressOnset* onset = find_onset(item, StressVerdict::kDegraded);
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

  document::Grade grade() const {
    if (breaks || least < kEarly) return document::Grade::kBad;
    return least < 1.0 ? document::Grade::kNear : document::Grade::kGood;
  }
  std::string describe() const {
    return fmt::format("{:.0f}{} %", 100.0 * least, most > least ? fmt::format(" .. {:.0f}", 100.0 * most) : "");
  }
};

std::map<std::string, Standing> find_standings(const StressAxis& axis) {
  std::map<std::string, Standing> standings;
  for (const StressCase& item : axis.cases) {
    if (item.level == "model" || item.samples.empty()) continue;
    Standing& standing = standings[item.filter.empty() ? kNoFilter : item.filter];
    standing.least = std::min(standing.least, measure_reach(axis, item));
    standing.most = std::max(standing.most, measure_reach(axis, item));
    standing.breaks = standing.breaks || item.broken;
  }
  return standings;
}

/// The case that breaks first on an axis; null where none does.
const StressCase* find_first_broken(const StressAxis& axis) {
  const StressCase* first = nullptr;
  for (const StressCase& item : axis.cases)
    if (item.level != "model" && item.broken && (!first || measure_reach(axis, item) < measure_reach(axis, *first)))
      first = &item;
  return first;
}

/// Where that is, and where theory puts it; empty where nothing breaks.
std::string describe_break(const StressAxis& axis) {
  const StressCase* item = find_first_broken(axis);
  if (!item) return {};
  std::string text = fmt::format("{} breaks at {} = {:.4g}", label_of(*item), axis.quantity, item->broken->value);
  const auto limit = std::ranges::find_if(item->limits, [](const StressLimit& each) {
    return each.predicts == StressVerdict::kBroken && each.onset.has_value();
  });
  return text + (limit == item->limits.end() ? "." : fmt::format("; theory {:.4g}.", *limit->onset));
}

/// The case that breaks first on any axis, and what else breaks.
std::string describe_breaks(const StressRecord& record) {
  std::vector<std::string> where;
  const StressAxis* first = nullptr;
  const auto reach_of = [](const StressAxis& axis) { return measure_reach(axis, *find_first_broken(axis)); };
  for (const StressAxis& axis : record.axes) {
    if (!find_first_broken(axis)) continue;
    where.push_back(axis.id);
    if (!first || reach_of(axis) < reach_of(*first)) first = &axis;
  }
  std::string text = first ? describe_break(*first) : "No filter breaks.";
  if (where.size() > 1) text += fmt::format(" Filters break on {} of {} axes.", where.size(), record.axes.size());
  const int unexplained = records::count_disagreements(record);
  return text + (unexplained > 0 ? fmt::format(" Limits that disagree with theory: {}.", unexplained) : "");
}

document::Section make_stress_answer(const StressRecord& record) {
  document::Table table{"How much of each axis' range holds", {{"axis"}, {}}};
  for (const StressAxis& axis : record.axes) {
    const auto standings = find_standings(axis);
    for (const StressCase& item : axis.cases) {
      const auto found = standings.find(item.filter.empty() ? kNoFilter : item.filter);
      if (found == standings.end()) continue;
      table.judge(fmt::format("{}: {}, {:g} .. {:g}", axis.id, axis.quantity, axis.range.low, axis.range.high),
                  found->first, found->second.describe(), found->second.grade());
    }
  }
  std::string answer = describe_breaks(record);
  return {
      "answer", "", {document::Paragraph{std::move(answer)}, std::move(table), document::Paragraph{kStressNote, true}}};
}

bool is_shown(const std::optional<double>& measured) { return measured.value_or(0.0) >= kLeastShown; }

document::ChartAxis choose_value_axis(const StressAxis& axis) {
  if (axis.log) return document::choose_log_axis({axis.range.low, axis.range.high}, {});
  const document::ChartAxis chosen =
      document::choose_axis({axis.range.low, axis.range.high}, {}, document::TickKind::kNumber);
  // choose_axis() prefers a logarithm for what is positive
  return chosen.log ? document::choose_axis({0.0, axis.range.high}, {}, document::TickKind::kNumber) : chosen;
}

document::ChartAxis choose_measured_axis(const StressAxis& axis) {
  std::vector<double> values = {axis.bound};
  for (const StressCase& item : axis.cases) {
    for (const records::StressSample& sample : item.samples)
      if (is_shown(sample.measured)) values.push_back(*sample.measured);
  }
  return document::choose_log_axis(values, {});
}

void add_case(document::Chart& chart, const StressAxis& axis, const StressCase& item,
              const document::ChartStyle& style) {
  const bool model = item.level == "model";  // a dashed line beside the GL's, whose points would hide it
  document::ChartSeries broken{.title = {}, .color = style.color, .mark = style.mark, .points = {}}, line = broken;
  line.title = label_of(item);
  line.mark = model ? document::Mark::kNone : style.mark;
  line.filled = false;
  line.line = model ? document::LineStyle::kDashed : document::LineStyle::kSolid;
  for (const records::StressSample& sample : item.samples) {
    const bool shown = is_shown(sample.measured);
    if (!shown && sample.verdict != StressVerdict::kBroken) continue;
    document::ChartPoint point = document::exact_point(sample.value, shown ? *sample.measured : chart.y.high);
    point.details = {line.title, fmt::format("{} {:.4g}: {}", axis.quantity, sample.value, name_of(sample.verdict)),
                     fmt::format("{}: {}", axis.measured, format_value(sample.measured, "nothing finite"))};
    if (!sample.why.empty()) point.details.push_back(sample.why);
    if (sample.verdict == StressVerdict::kBroken) broken.points.push_back(point);
    if (shown) line.points.push_back(std::move(point));
  }
  chart.series.push_back(std::move(line));
  if (!broken.points.empty()) chart.series.push_back(std::move(broken));
}

/// Adds a vertical line for each theoretical limit within the chart; equal limits are one line.
void add_theory(document::Chart& chart, const StressAxis& axis) {
  std::map<std::string, double> onsets;  // by what the label says
  bool says_none = false;
  for (const auto& [item, limit] : list_limits(axis)) {
    says_none = says_none || !limit->onset;
    if (limit->onset && *limit->onset >= chart.x.low && *limit->onset <= chart.x.high)
      onsets.emplace(fmt::format("{:.4g}", *limit->onset), *limit->onset);
  }
  document::ChartSeries lines{
      .title = "theoretical limits", .color = document::kInk, .line = document::LineStyle::kTies, .points = {}};
  for (const auto& [label, onset] : onsets)
    for (const double end : {chart.y.low, chart.y.high}) lines.points.push_back(document::exact_point(onset, end));
  if (!onsets.empty()) chart.series.push_back(std::move(lines));
  if (says_none) chart.notes.push_back("some cases have no theoretical limit");
}

void add_sentences(document::Details& details, const char* lead, std::vector<std::string> sentences) {
  if (!sentences.empty()) details.blocks.emplace_back(document::Sentences{lead, std::move(sentences)});
}

document::Section make_axis_section(const StressAxis& axis) {
  document::Section section{axis.id, fmt::format("{}: {}", axis.id, axis.title), {}};
  if (std::string first = describe_break(axis); !first.empty())
    section.blocks.emplace_back(document::Paragraph{std::move(first)});
  if (std::optional<document::Chart> chart = make_stress_chart(axis)) section.blocks.emplace_back(std::move(*chart));
  const std::string about =
      fmt::format("Over the {}, {:g} .. {:g}. Measured: {}; degraded where it is over {:g}. Broken: {}.",
                  with_unit(axis.quantity, axis.unit), axis.range.low, axis.range.high,
                  with_unit(axis.measured, axis.measured_unit), axis.bound, axis.broken_when);
  document::Details details{
      "Every variant, and why",
      {document::Paragraph{about, true}, document::Table{"What is safe, and where it ends", make_case_table(axis)}}};
  std::vector<std::string> notes;
  for (const StressCase& item : axis.cases)
    for (const std::string& note : item.notes) notes.push_back(fmt::format("{}: {}.", label_of(item), note));
  add_sentences(details, "Not what theory says, and why:", describe_stress_limits(axis, StressAgreement::kExplained));
  add_sentences(details, "Also seen:", std::move(notes));
  section.blocks.emplace_back(std::move(details));
  return section;
}

}  // namespace

records::TextTable make_case_table(const StressAxis& axis) {
  records::TextTable table{{"case", "last value that is ok", "degraded from", "broken from", "why", "observations"},
                           {}};
  for (const StressCase& item : axis.cases) {
    const records::StressOnset *ends = find_onset(item, StressVerdict::kDegraded),
                               *breaks = find_onset(item, StressVerdict::kBroken);
    const records::StressOnset* decides = breaks ? breaks : ends;
    std::string last_ok = ends ? format_value(ends->last_before, "nowhere") : "all of the range",
                why = decides ? decides->why : std::string();
    if (!item.not_available.empty()) {
      last_ok = records::kNothing;
      why = "not available: " + item.not_available;
    }
    table.rows.push_back({label_of(item), std::move(last_ok), format_onset(item.degraded), format_onset(item.broken),
                          std::move(why), fmt::format("{}", item.samples.size())});
  }
  return table;
}

records::TextTable make_limit_table(const StressRecord& record) {
  records::TextTable table{
      {"axis", "case", "verdict", "theory", "theoretical", "measured", "ratio", "kind, tolerance", "result"}, {}};
  for (const StressAxis& axis : record.axes) {
    for (const auto& [item, limit] : list_limits(axis)) {
      if (is_out_of_sight(*limit)) continue;
      const bool rounds = limit->kind == records::StressTheoryKind::kRounding;
      table.rows.push_back({axis.id, label_of(*item), name_of(limit->predicts), limit->formula,
                            format_value(limit->onset, "none"), format_value(limit->measured, "not in the range"),
                            limit->ratio ? fmt::format("{:.3f}", *limit->ratio) : std::string(records::kNothing),
                            fmt::format("{}, {}", name_of(limit->kind), rounds ? "factor 8" : "10 %"),
                            name_of(limit->agreement)});
    }
  }
  return table;
}

std::vector<std::string> describe_stress_limits(const StressAxis& axis, StressAgreement agreement) {
  std::vector<std::string> sentences;
  for (const auto& [item, limit] : list_limits(axis)) {
    if (limit->agreement != agreement) continue;
    sentences.push_back(fmt::format(
        "{}: {} at {}, where theory says {} ({}){}{}.", label_of(*item), name_of(limit->predicts),
        format_value(limit->measured, "no value of the range"), format_value(limit->onset, "none"), limit->formula,
        limit->explanation.empty() ? ", and nothing explains it" : ": ", limit->explanation));
  }
  return sentences;
}

std::optional<document::Chart> make_stress_chart(const StressAxis& axis) {
  document::Chart chart;
  chart.id = "stress." + axis.id;
  chart.title = axis.title;
  chart.x_name = with_unit(axis.quantity, axis.unit);
  chart.y_name = with_unit(axis.measured, axis.measured_unit);
  chart.x = choose_value_axis(axis);
  chart.y = choose_measured_axis(axis);
  std::map<std::string, std::size_t> styles;  // the levels of one variant are drawn alike
  std::vector<std::pair<double, std::string>> weights;
  for (const StressCase& item : axis.cases) {
    if (item.samples.empty()) continue;
    const bool reference = item.filter == "none" && weights.empty();
    const double hidden_by = item.level == "model" ? 1.0 : 0.0;  // its GL's curve, which it follows
    weights.emplace_back(reference ? 1.0 : -measure_reach(axis, item) - hidden_by, label_of(item));
    const auto style = styles.emplace(item.filter + ": " + item.variant, styles.size()).first;
    add_case(chart, axis, item, document::style_of(style->second));
  }
  chart.series.push_back(
      {.title = fmt::format("bound, {:g}", axis.bound),
       .color = "#8a8f98",
       .line = document::LineStyle::kDashed,
       .points = {document::exact_point(chart.x.low, axis.bound), document::exact_point(chart.x.high, axis.bound)}});
  add_theory(chart, axis);
  chart.notes.push_back("filled: broken, at the upper edge where nothing finite was measured");
  if (weights.empty()) return std::nullopt;
  document::show_most_telling(chart, std::move(weights));
  return chart;
}

document::Page make_stress_page(const StressRecord& record) {
  document::Page page{"Where filters break", {make_stress_answer(record)}, {}};
  std::vector<std::string> warnings;
  for (const StressAxis& axis : record.axes)
    for (const std::string& sentence : describe_stress_limits(axis, StressAgreement::kDisagrees))
      warnings.push_back(axis.id + ": " + sentence);
  if (!warnings.empty())
    page.sections.push_back({"warnings", "Warnings", {document::Sentences{{}, std::move(warnings)}}, true});
  for (const StressAxis& axis : record.axes) page.sections.push_back(make_axis_section(axis));
  document::Details limits{
      "Measured against theoretical limits",
      {document::Table{"Where each verdict is first met, found to 1 %", make_limit_table(record)},
       document::Paragraph{"Limits that theory puts beyond the range, and that were not met, are in stress.json alone.",
                           true}}};
  const records::GlRecord& gl = record.gl;
  document::Facts facts{{{"OpenGL", fmt::format("{} ({}), {}", gl.renderer, gl.backend, gl.version)},
                         {"machine", fmt::format("{}, {} cores", record.machine.cpu, record.machine.cores)},
                         {"program", record.commit},
                         {"command", fmt::format("{}", fmt::join(record.command, " "))},
                         {"took", fmt::format("{:.1f} s", record.seconds)}}};
  document::Details settings{
      "Settings and data",
      {std::move(facts), document::Sentences{"Filters:", record.filters}, link_data({"stress.json", "stress.csv"})}};
  page.sections.push_back({"data", "", {std::move(limits), std::move(settings)}});
  return page;
}

}  // namespace shadowbench::pages
