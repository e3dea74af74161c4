#include "report/records/csv_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "report/records/format.h"
#include "report/records/json_values.h"

namespace shadowbench::records {
namespace {

bool is_number(std::string_view text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return end == text.data() + text.size() && error != std::errc::invalid_argument;
}

/// Source: OWASP, CSV Injection.
bool is_formula(std::string_view text) { return text.find_first_of("=+-@\t\r\n") == 0 && !is_number(text); }

/// Writes a value as a field; what is made of several is JSON.
template <class T>
std::string write_field(const T& value) {
  if constexpr (kIsA<T, std::optional>)
    return value ? write_field(*value) : std::string();
  else if constexpr (std::is_same_v<T, bool>)
    return value ? "on" : "off";
  else if constexpr (std::is_enum_v<T>)
    return name_of(value);
  else if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>)
    return fmt::format("{}", value);
  else
    return dump_line(value_json(value));
}

/// Calls `emit(ending, meaning, value)` for every column of a value, with what name and meaning end in.
template <class T>
void visit_parts(const T& value, const auto& emit) {
  emit("", "", value);
}
void visit_parts(const Quartiles& time, const auto& emit) {
  emit("_median_ms", ", milliseconds, median", time.median);
  emit("_q1_ms", ", milliseconds, first quartile", time.q1);
  emit("_q3_ms", ", milliseconds, third quartile", time.q3);
  emit("_n", ", number of measurements", time.n);
}
void visit_parts(const OwnTime& time, const auto& emit) {
  visit_parts(static_cast<const Quartiles&>(time), emit);
  emit("_low_ms", ", milliseconds, lower end of the median's 95 % interval", time.ci95.low);
  emit("_high_ms", ", milliseconds, upper end of the median's 95 % interval", time.ci95.high);
}
void visit_parts(const Ratio& ratio, const auto& emit) {
  emit("_median", ", median over rounds", ratio.median);
  emit("_low", ", lower end of the 95 % interval", ratio.ci95.low);
  emit("_high", ", upper end of the 95 % interval", ratio.ci95.high);
}
void visit_parts(const Interval& interval, const auto& emit) {
  emit("_low", ", lower end of its 95 % interval over the phases", interval.low);
  emit("_high", ", upper end of its 95 % interval over the phases", interval.high);
}
/// Of what does not exist the fields are empty.
template <class T>
void visit_parts(const std::optional<T>& value, const auto& emit) {
  visit_parts(
      value.value_or(T()),
      [&](const char* ending, const char* meaning, const auto& part) {
        emit(ending, meaning, value ? std::optional(part) : std::nullopt);
      });
}

/// Calls `emit(path, about, ending, meaning, value)` for every column of a cell.
void visit_columns(const RunRecord& run, const CellRecord& cell, const auto& emit) {
  visit_fields(
      cell,
      [&]<class T>(const std::string& path, const T& value, const About& about = {}) {
        if (about.column.empty() && about.unit.empty()) return;
        const auto emit_part = [&](const char* ending, const char* meaning, const auto& part) {
          emit(path, about, ending, meaning, part);
        };
        if constexpr (std::is_same_v<T, std::optional<MachineKind>>) {
          emit(path, {.column = "what the times are times of", .column_name = "clock"}, "", "",
               value ? describe_clock(*value) : describe_clock(run.gl));
          emit_part("", "", value ? describe_machine_kind(*value) : std::string());
        } else if constexpr (std::is_same_v<T, bool>) {
          about.as_number ? emit_part("", "", value ? 1 : 0) : emit_part("", "", value);
        } else if constexpr (!std::is_same_v<T, Group>) {
          visit_parts(value, emit_part);
        }
      });
}

/// A column, and the field that it is of.
struct Column {
  CsvColumn column;
  std::string path;
  bool is_metric = false;

  bool is_in(std::string_view group) const {
    return path.starts_with(group) && path.find('.') == (group.empty() ? path.npos : group.size());
  }
  bool is_time() const { return path == "machine" || is_in("time_ms") || is_in("ratio_to_none"); }
  bool is_of_phases() const { return path == "phases" || path.ends_with("_ci95"); }
  bool is_setting() const { return !is_metric && !is_time() && !is_of_phases() && path != "key"; }
};

/// "error.rmse" is rmse; groups whose fields say nothing alone stay: "bias.midpoint" is bias_midpoint.
std::string name_column(std::string path, const About& about) {
  if (!about.column_name.empty()) return std::string(about.column_name);
  const bool keeps_group = path.starts_with("truth.") || path.starts_with("kernel.") || path.starts_with("bias.") ||
                           path.starts_with("penumbra.");
  if (!keeps_group) path.erase(0, path.find('.') + 1);
  std::ranges::replace(path, '.', '_');
  return path;
}

/// All columns, in the order in which a cell's values are visited.
std::vector<Column> list_columns() {
  std::vector<Column> columns;
  visit_columns(
      {}, {}, [&](const std::string& path, const About& about, const char* ending, const char* meaning, const auto&) {
        const bool is_metric = !about.unit.empty();
        columns.push_back({{name_column(path, about) + ending, is_metric ? fmt::format("{}, {}", about.unit, about.text)
                                                                         : fmt::format("{}{}", about.column, meaning)},
                           path,
                           is_metric});
      });
  return columns;
}

/// The places of a table's columns among all, in its order.
std::vector<std::size_t> choose_columns(CsvTable table, const std::vector<Column>& columns) {
  std::vector<std::size_t> chosen;
  const auto add = [&](const auto& belongs) {
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (std::invoke(belongs, columns[i])) chosen.push_back(i);
  };
  add(&Column::is_setting);
  if (table == CsvTable::kAccuracy) {
    add([](const Column& each) { return each.is_metric && !each.is_in("cost") && !each.is_in("map_scale"); });
    add(&Column::is_of_phases);
  } else {
    add(&Column::is_time);
    for (const char* group : {"cost", "", "coverage"})
      add([&](const Column& each) { return each.is_metric && each.is_in(group); });
  }
  add([](const Column& each) { return each.path == "key"; });
  return chosen;
}

}  // namespace

std::string quote_csv(std::string_view text) {
  const std::string apostrophe = is_formula(text) ? "'" : "";
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return apostrophe + std::string(text);
  std::string quoted = "\"" + apostrophe;
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string make_csv_row(std::vector<std::string> fields) {
  for (std::string& field : fields) field = quote_csv(field);
  return fmt::format("{}\r\n", fmt::join(fields, ","));
}

std::vector<CsvColumn> list_csv_columns(CsvTable table) {
  const std::vector<Column> columns = list_columns();
  std::vector<CsvColumn> listed;
  for (const std::size_t i : choose_columns(table, columns)) listed.push_back(columns[i].column);
  return listed;
}

std::string make_csv(const TextTable& table) {
  std::string csv = make_csv_row(table.header);
  for (const std::vector<std::string>& row : table.rows) csv += make_csv_row(row);
  return csv;
}

std::string make_csv(CsvTable table, const RunRecord& run, const std::vector<CellRecord>& cells) {
  const std::vector<Column> columns = list_columns();
  const std::vector<std::size_t> chosen = choose_columns(table, columns);
  TextTable written;
  for (const std::size_t i : chosen) written.header.push_back(columns[i].column.name);
  for (const CellRecord& cell : cells) {
    std::vector<std::string> fields;
    visit_columns(run, cell, [&](const std::string&, const About&, const char*, const char*, const auto& value) {
      fields.push_back(write_field(value));
    });
    std::vector<std::string>& row = written.rows.emplace_back();
    for (const std::size_t i : chosen) row.push_back(fields[i]);
  }
  return make_csv(written);
}

}  // namespace shadowbench::records
