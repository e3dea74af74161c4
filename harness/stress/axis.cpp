#include "harness/stress/axis.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/files.h"
#include "base/folder_lock.h"
#include "base/text.h"
#include "filters/model.h"
#include "harness/measure/scene_measurement.h"
#include "harness/run/provenance.h"
#include "report/document/markdown.h"
#include "report/pages/stress_page.h"
#include "report/pages/write_page.h"
#include "report/records/stress_record.h"

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
  if (const std::optional<double> value = parse_number(text)) return *value;
  fail(fmt::format("--range: '{}' of '{}' must be a finite number, as in --range esm-exponent=10,200", text, range));
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
  else if (!filters::find_model(request.spec))
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

namespace {

constexpr int kMostHalvings = 60;

/// The coarse samples, both ends among them, in the order of the search. Of a case that can take a few values alone,
/// those within the range.
std::vector<double> place_samples(const Axis& axis, const Case& item) {
  const int count = std::max(axis.coarse_samples, 2);
  const auto [low, high] = axis.range;
  std::vector<double> values;
  for (const double value : item.values)
    if (value >= low && value <= high) values.push_back(value);
  for (int i = 0; item.values.empty() && i < count; ++i) {
    const double share = static_cast<double>(i) / (count - 1);
    double value = axis.log ? low * std::pow(high / low, share) : low + (high - low) * share;
    if (axis.whole) value = std::round(value);
    if (i == 0) value = low;
    if (i == count - 1) value = high;
    if (values.empty() || value > values.back()) values.push_back(value);
  }
  if (axis.from == SearchFrom::kHigh) std::ranges::reverse(values);
  return values;
}

/// Observes each value once, whoever asks for it.
class Observer {
 public:
  explicit Observer(const Case& item) : item_(item) {}

  const Observation& at(double value) {
    const auto known = seen_.find(value);
    if (known != seen_.end()) return known->second;
    return seen_.emplace(value, observe(value)).first->second;
  }

  std::vector<records::StressSample> samples() const {
    std::vector<records::StressSample> samples;
    for (const auto& [value, seen] : seen_) samples.push_back({value, seen.verdict, seen.measured, seen.why});
    return samples;
  }

 private:
  const Case& item_;
  std::map<double, Observation> seen_;

  Observation observe(double value) const {
    if (seen_.empty()) return tidy(item_.observe(value));  // an Error here makes the case not available
    try {
      return tidy(item_.observe(value));
    } catch (const Error& error) {
      return {Verdict::kBroken, std::nullopt, error.what()};
    }
  }

  static Observation tidy(Observation seen) {
    if (seen.measured && !std::isfinite(*seen.measured)) seen.measured.reset();
    return seen;
  }
};

class Search {
 public:
  /// Observes the coarse samples: those between which there is nothing to be found where `only_coarse`.
  Search(const Axis& axis, Observer& observer, std::vector<double> coarse, bool only_coarse)
      : axis_(axis), observer_(observer), coarse_(std::move(coarse)), only_coarse_(only_coarse) {
    for (const double value : coarse_) observer_.at(value);
  }

  /// Finds the first value, in the direction of the search, with this verdict or a worse one.
  std::optional<records::StressOnset> find_first(Verdict verdict) {
    const auto first =
        std::ranges::find_if(coarse_, [&](double value) { return observer_.at(value).verdict >= verdict; });
    if (first == coarse_.end()) return std::nullopt;
    if (first == coarse_.begin()) return records::StressOnset{*first, std::nullopt, observer_.at(*first).why};
    double before = *(first - 1), with = *first;
    for (int i = 0; i < kMostHalvings && !only_coarse_ && !is_narrow(before, with); ++i) {
      const double middle = halve(before, with);
      (observer_.at(middle).verdict >= verdict ? with : before) = middle;
    }
    return records::StressOnset{with, before, observer_.at(with).why};
  }

  /// Where, on the coarse samples, a verdict got better again after `verdict` was met.
  std::optional<std::string> find_recovery(Verdict verdict, const char* name) {
    const auto first = std::ranges::find_if(
        coarse_, [&](double value) { return observer_.at(value).verdict >= verdict; });
    const auto better =
        std::find_if(first, coarse_.end(), [&](double value) { return observer_.at(value).verdict < verdict; });
    if (better == coarse_.end()) return std::nullopt;
    return fmt::format("{} at {:.4g}, but {} again at {:.4g}", name, *first,
                       records::name_of(observer_.at(*better).verdict), *better);
  }

 private:
  const Axis& axis_;
  Observer& observer_;
  std::vector<double> coarse_;
  bool only_coarse_;

  bool is_narrow(double a, double b) const {
    if (axis_.whole) return std::abs(a - b) <= 1.0;
    return std::abs(a - b) <= kOnsetPrecision * std::min(std::abs(a), std::abs(b)) || halve(a, b) == a ||
           halve(a, b) == b;
  }

  double halve(double a, double b) const {
    const double middle = axis_.log ? std::sqrt(a * b) : 0.5 * (a + b);
    return axis_.whole ? std::clamp(std::round(middle), std::min(a, b) + 1.0, std::max(a, b) - 1.0) : middle;
  }
};

/// Whether a theory that was met nowhere in the range, or right where the range begins, can be true: its onset,
/// give or take the tolerance, lies beyond the range or before it.
bool agrees_outside(double onset, double tolerance, bool met, const Axis& axis) {
  const bool lies_above = met ? onset > axis.range.low * tolerance : onset * tolerance > axis.range.high;
  const bool lies_below = met ? onset < axis.range.high / tolerance : onset / tolerance < axis.range.low;
  const bool lies_after = axis.from == SearchFrom::kLow ? lies_above : lies_below;
  return lies_after != met;
}

bool agrees(const records::StressLimit& limit, const records::StressOnset* met, const Axis& axis) {
  if (!limit.onset) return met == nullptr;
  const double tolerance = records::tolerance_of(limit.kind);
  if (!met || !met->last_before) return agrees_outside(*limit.onset, tolerance, met != nullptr, axis);
  return *limit.ratio <= tolerance && *limit.ratio >= 1.0 / tolerance;
}

}  // namespace

records::StressCase find_onsets(const Case& item, const Axis& axis) {
  records::StressCase record;
  record.filter = item.filter;
  record.variant = item.variant;
  record.level = name_of(item.level);
  record.params = item.params;
  record.not_available = item.not_available;
  if (!item.observe) return record;
  const std::vector<double> coarse = place_samples(axis, item);
  if (coarse.empty()) {
    record.not_available =
        fmt::format("it takes {} {} alone, none of them in the range", axis.quantity, fmt::join(item.values, ", "));
    return record;
  }
  Observer observer(item);
  try {
    observer.at(coarse.front());
  } catch (const Error& error) {
    record.not_available = error.what();
    return record;
  }
  Search search(axis, observer, coarse, !item.values.empty());
  record.broken = search.find_first(Verdict::kBroken);
  record.degraded = search.find_first(Verdict::kDegraded);
  // A case that breaks at once was never merely degraded.
  if (record.degraded && observer.at(record.degraded->value).verdict == Verdict::kBroken) record.degraded.reset();
  const bool breaks = record.broken.has_value();
  if (const auto note =
          search.find_recovery(breaks ? Verdict::kBroken : Verdict::kDegraded, breaks ? "broken" : "degraded"))
    record.notes.push_back(*note);
  record.samples = observer.samples();
  return record;
}

std::vector<records::StressLimit> compare(const Case& item, const records::StressCase& record, const Axis& axis) {
  std::vector<records::StressLimit> limits;
  if (!record.not_available.empty()) return limits;
  for (const Theory& theory : item.theories) {
    const records::StressOnset* met = records::find_onset(record, theory.predicts);
    records::StressLimit limit{theory, {}, {}, {}, {}};
    if (met) limit.measured = met->value;
    if (limit.onset && met && met->last_before) limit.ratio = met->value / *limit.onset;
    if (!agrees(limit, met, axis)) {
      limit.explanation = item.explain ? item.explain({theory, limit.measured, record}) : std::string();
      limit.agreement =
          limit.explanation.empty() ? records::StressAgreement::kDisagrees : records::StressAgreement::kExplained;
    }
    limits.push_back(std::move(limit));
  }
  return limits;
}

namespace {

using Clock = std::chrono::steady_clock;

std::vector<Axis> read_axes(const StressOptions& options) {
  std::vector<Axis> axes = choose_axes(options.axes);
  for (const std::string& range : options.ranges) apply_range(axes, range);
  return axes;
}

class StressRun {
 public:
  StressRun(const StressOptions& options, options::Progress& progress)
      : options_(options),
        progress_(progress),
        axes_(read_axes(options)),
        renderer_(measure::make_renderer(options.backend, options.resources)) {
    inputs_ = {&renderer_, options.resources, options.filters, options.seed};
  }

  StressOutcome run() {
    const FolderLock lock(options_.out, options_.force);  // a folder that cannot be written is better found now
    const auto start = Clock::now();
    describe_run();
    make_all_cases();
    for (std::size_t i = 0; i < axes_.size(); ++i) record_.axes.push_back(drive(axes_[i], cases_[i]));
    record_.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    warn();
    progress_.show(done_, "writing");
    lock.require_in_place();
    pages::write_page(options_.out, "stress", pages::make_stress_page(record_));
    write_text_file(options_.out / "stress.csv", records::make_stress_csv(record_));
    write_text_file(options_.out / "stress.json", records::make_stress_json(record_));
    return {document::write_markdown_table(pages::make_limit_table(record_)), records::count_disagreements(record_)};
  }

 private:
  const StressOptions& options_;
  options::Progress& progress_;
  std::vector<Axis> axes_;
  measure::Renderer renderer_;
  AxisInputs inputs_;
  std::vector<std::vector<Case>> cases_;  ///< of each axis; gone before the renderer
  records::StressRecord record_;
  int done_ = 0;

  void describe_run() {
    for (const std::string& reason : renderer_.refused) progress_.note("not used: " + reason);
    record_.commit = run::build_commit();
    record_.gl = run::describe_gl(renderer_);
    record_.machine = run::describe_machine();
    record_.seed = options_.seed;
    record_.command = options_.command;
    for (const filters::FilterRequest& request : options_.filters) record_.filters.push_back(request.label());
  }

  void make_all_cases() {
    int count = 0;
    for (const Axis& axis : axes_) {
      cases_.push_back(axis.make_cases(inputs_));
      count += static_cast<int>(cases_.back().size());
    }
    progress_.begin(count, 0);
  }

  records::StressAxis drive(const Axis& axis, std::vector<Case>& cases) {
    records::StressAxis record{axis, {}};
    for (const Case& item : cases) {
      progress_.show(done_, fmt::format("{} · {}", axis.id, describe(item)));
      records::StressCase found = find_onsets(item, axis);
      found.limits = compare(item, found, axis);
      record.cases.push_back(std::move(found));
      renderer_.context->require_no_gl_errors();
      ++done_;
    }
    cases.clear();  // and with them their maps
    return record;
  }

  static std::string describe(const Case& item) {
    return fmt::format("{}{} ({})", item.filter.empty() ? "" : item.filter + ": ", item.variant, name_of(item.level));
  }

  void warn() {
    for (const records::StressAxis& axis : record_.axes) {
      for (const std::string& sentence : pages::describe_stress_limits(axis, records::StressAgreement::kDisagrees))
        progress_.note(fmt::format("warning: {}: {}", axis.id, sentence));
      for (const records::StressCase& item : axis.cases)
        if (!item.not_available.empty())
          progress_.note(fmt::format("{}: not available: {}: {}", axis.id, label_of(item), item.not_available));
    }
  }
};

}  // namespace

StressOutcome run_stress(const StressOptions& options, options::Progress& progress) {
  return StressRun(options, progress).run();
}

std::string describe_axes(const std::vector<filters::FilterRequest>& filters) {
  std::string text;
  for (const Axis& axis : axis_table()) {
    std::vector<std::string> driven;
    for (const filters::FilterRequest& request : filters) {
      const std::string param = axis.driven_param ? axis.driven_param(request.spec) : std::string();
      if (!param.empty()) driven.push_back(fmt::format("{}:{}", request.spec.id, param));
    }
    text += fmt::format(
        "{}  {}\n  {}{}, {:g} .. {:g} (--range: within {:g} .. {:g})\n  measures {}; degraded over {:g}\n  broken: "
        "{}\n",
        axis.id, axis.title, axis.quantity, axis.unit.empty() ? "" : ", " + axis.unit, axis.range.low, axis.range.high,
        axis.limits.low, axis.limits.high, axis.measured, axis.bound, axis.broken_when);
    if (!driven.empty()) text += fmt::format("  drives: {}\n", fmt::join(driven, ", "));
    text += "\n";
  }
  return text;
}

}  // namespace shadowbench::stress
