#include "report/pages/stress_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "report/analysis/summary.h"
#include "report/page/markdown.h"
#include "report/page/markdown_table.h"
#include "report/pages/tables.h"
#include "report/records/format.h"
#include "report/records/text_table.h"

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

/// Gives the last value before anything changed.
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

/// There is nothing to see of a limit, and nothing should be: the range ends before it, or there is none.
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

records::TextTable escape(records::TextTable table) {
  for (std::string& field : table.header) field = page::escape_markdown(field);
  for (auto& row : table.rows)
    for (std::string& field : row) field = page::escape_markdown(field);
  return table;
}

std::string list_markdown(const std::string& title, const std::vector<std::string>& sentences) {
  if (sentences.empty()) return {};
  std::string text = title.empty() ? std::string() : title + "\n\n";
  for (const std::string& sentence : sentences) text += "- " + page::escape_markdown(sentence) + "\n";
  return text + "\n";
}

std::string make_axis_text(const records::StressAxis& axis) {
  std::string text = fmt::format("## {}: {}\n\n{}\n\n", axis.id, page::escape_markdown(axis.title),
                                 page::escape_markdown(describe_axis(axis)));
  text += page::make_markdown_table(escape(make_case_table(axis)));
  text += list_markdown("Not what theory says, and why:", describe_explanations(axis));
  text += list_markdown("Not what theory says, and **not explained**:", describe_disagreements(axis));
  text += list_markdown("Also seen:", describe_notes(axis));
  for (const records::StressExhibit& exhibit : axis.exhibits) {
    text += fmt::format("### {}\n\n", page::escape_markdown(exhibit.title)) + list_markdown({}, exhibit.sentences);
    if (exhibit.table) text += page::make_markdown_table(escape(*exhibit.table));
  }
  return text;
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

std::string make_limit_tables(const records::StressRecord& record) {
  return page::make_markdown_table(escape(make_limit_table(record))) +
         list_markdown("Not met, and not expected:", describe_out_of_sight(record));
}

std::string make_stress_text(const records::StressRecord& record) {
  std::string text = "# Where filters break\n\n";
  text += fmt::format("{} ({}), program {}, {:.1f} s. Filters: {}.\n\n", page::escape_markdown(record.gl.renderer),
                      record.gl.backend, record.commit, record.seconds,
                      page::escape_markdown(fmt::format("{}", fmt::join(record.filters, "; "))));
  text += "## Measured against theoretical limits\n\n" + make_limit_tables(record);
  for (const records::StressAxis& axis : record.axes) text += make_axis_text(axis);
  return text;
}

}  // namespace shadowbench::pages
