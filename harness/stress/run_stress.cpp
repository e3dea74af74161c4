#include "harness/stress/run_stress.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>

#include "base/atomic_file.h"
#include "base/error.h"
#include "harness/run/provenance.h"
#include "harness/stress/onset.h"
#include "report/files/folder_lock.h"
#include "report/pages/stress_page.h"
#include "report/pages/write_page.h"
#include "report/records/stress_record.h"

namespace shadowbench::stress {
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
    inputs_ = {&renderer_, options.resources, options.filters, options.seed, options.cache, options.out, &progress};
  }

  StressOutcome run() {
    const files::FolderLock lock(options_.out, options_.force);  // a folder that cannot be written is better found now
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
    return {pages::make_limit_text(record_), records::count_disagreements(record_)};
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
    static_cast<records::Provenance&>(record_) = run::describe_provenance(renderer_, options_.seed, options_.command);
    for (const filters::FilterRequest& request : options_.filters) record_.filters.push_back(request.label());
  }

  void make_all_cases() {
    int count = 0;
    for (const Axis& axis : axes_) {
      cases_.push_back(axis.make_cases(inputs_));
      count += static_cast<int>(cases_.back().size()) + (axis.make_exhibits ? 1 : 0);
    }
    progress_.begin(count, 0);
  }

  records::StressAxis drive(const Axis& axis, std::vector<Case>& cases) {
    records::StressAxis record{axis, {}, {}};
    for (const Case& item : cases) {
      progress_.show(done_, fmt::format("{} · {}", axis.id, describe(item)));
      records::StressCase found = find_onsets(item, axis);
      found.limits = compare(item, found, axis);
      record.cases.push_back(std::move(found));
      renderer_.context->require_no_gl_errors();
      ++done_;
    }
    cases.clear();  // and with them their maps
    if (axis.make_exhibits) {
      progress_.show(done_++, axis.id + " · exhibits");
      record.exhibits = axis.make_exhibits(inputs_);
    }
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
