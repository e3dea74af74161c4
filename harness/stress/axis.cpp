#include "harness/stress/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "filters/model.h"

namespace shadowbench::stress {

namespace {

[[noreturn]] void fail(const std::string& message) { throw Error(ErrorKind::kUsage, message); }

const Axis& find_axis(const std::string& id, const char* option) {
  const std::vector<Axis>& table = axis_table();
  const auto found = std::ranges::find(table, id, &Axis::id);
  if (found != table.end()) return *found;
  std::vector<std::string> known;
  for (const Axis& axis : table) known.push_back(axis.id);
  fail(fmt::format("{}: there is no axis '{}'{}", option, id, did_you_mean_or_known(id, known)));
}

double parse_end(const std::string& text, const std::string& range) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    fail(fmt::format("--range: '{}' of '{}' must be a finite number, as in --range esm-exponent=10,200", text, range));
  return value;
}

records::StressRange parse_ends(const std::string& ends, const std::string& range) {
  const std::size_t comma = ends.find(',');
  if (comma == std::string::npos)
    fail(fmt::format("--range: '{}' must be AXIS=LO,HI, as in --range esm-exponent=10,200", range));
  return {parse_end(ends.substr(0, comma), range), parse_end(ends.substr(comma + 1), range)};
}

void require_usable(records::StressRange range, const Axis& axis, const std::string& text) {
  if (range.low == range.high) fail(fmt::format("--range: '{}' is empty: the ends must differ", text));
  if (range.low > range.high)
    fail(fmt::format("--range: '{}' is reversed: write {}={},{}", text, axis.id, range.high, range.low));
  const bool whole = range.low == std::floor(range.low) && range.high == std::floor(range.high);
  if (axis.whole && !whole) fail(fmt::format("--range: '{}': the {} takes whole numbers", text, axis.quantity));
  if (range.low >= axis.limits.low && range.high <= axis.limits.high) return;
  fail(fmt::format("--range: '{}' reaches beyond what the axis can do: the {} lies within {:g} .. {:g}", text,
                   axis.quantity, axis.limits.low, axis.limits.high));
}

}  // namespace

const char* name_of(Level level) {
  if (level == Level::kGl) return "GL";
  return level == Level::kModel ? "model" : "arithmetic";
}

std::vector<Axis> choose_axes(const std::string& text) {
  if (text.empty()) return axis_table();
  std::vector<Axis> axes;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const Axis& axis = find_axis(text.substr(begin, end - begin), "--axes");
    if (std::ranges::find(axes, axis.id, &Axis::id) != axes.end())
      fail(fmt::format("--axes names '{}' twice; name it once", axis.id));
    axes.push_back(axis);
    begin = end + 1;
  }
  return axes;
}

void apply_range(std::vector<Axis>& axes, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos)
    fail(fmt::format("--range: '{}' must be AXIS=LO,HI, as in --range esm-exponent=10,200", text));
  const Axis& known = find_axis(text.substr(0, equals), "--range");
  const records::StressRange range = parse_ends(text.substr(equals + 1), text);
  require_usable(range, known, text);
  const auto chosen = std::ranges::find(axes, known.id, &Axis::id);
  if (chosen == axes.end())
    fail(fmt::format("--range: the axis '{}' is not among --axes; name it there too", known.id));
  chosen->range = range;
}

std::string find_exponent(const filters::FilterSpec& spec) {
  return spec.holds_moments ? std::string() : spec.exponent;
}

std::vector<std::string> list_choices(const filters::FilterRequest& request, const std::string& param) {
  const filters::ParamSpec* spec = request.spec.find_param(param);
  if (!spec) return {};
  if (request.set_by_user.contains(param)) return {filters::to_string(request.values.at(param))};
  std::vector<std::string> choices;
  for (const filters::ParamValue& choice : spec->choices) choices.push_back(filters::to_string(choice));
  return choices;
}

Case start_case(const AxisInputs& inputs, const filters::FilterRequest& request, std::string variant, Level level) {
  Case item{.filter = request.spec.id, .variant = std::move(variant), .level = level};
  if (level == Level::kGl && !inputs.renderer)
    item.not_available = "there is no GL";
  else if (!filters::make_model(request.spec))
    item.not_available = filters::kNoModel;
  else
    item.params = request.values;
  return item;
}

Observation judge_by_bounds(double measured, double degraded_over, double broken_over,
                            const std::function<std::string(double bound)>& describe) {
  if (measured > broken_over) return {Verdict::kBroken, measured, describe(broken_over)};
  if (measured > degraded_over) return {Verdict::kDegraded, measured, describe(degraded_over)};
  return {Verdict::kOk, measured, {}};
}

double find_largest_measured(const records::StressCase& record) {
  double largest = 0.0;
  for (const records::StressSample& sample : record.samples) largest = std::max(largest, sample.measured.value_or(0.0));
  return largest;
}

std::string explain_broken_throughout(const Disagreement& missed) {
  const bool throughout = std::ranges::all_of(
      missed.record.samples, [](const records::StressSample& sample) { return sample.verdict == Verdict::kBroken; });
  if (!throughout || !missed.record.broken) return {};
  return fmt::format("with the chosen parameters it is broken at every value ({}), which is not this axis' doing",
                     missed.record.broken->why);
}

}  // namespace shadowbench::stress
