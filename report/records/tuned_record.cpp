#include "report/records/tuned_record.h"

#include <cassert>

namespace shadowbench::records {
namespace {

TuneVerdict find_verdict(const TunedFilterRecord& filter) {
  const double least = filter.unseen_truth_se.value_or(0.0);
  if (filter.training.gain() <= least) return TuneVerdict::kNoGain;
  if (filter.unseen.gain() > least) return TuneVerdict::kBetter;
  return filter.unseen.gain() > 0.0 ? TuneVerdict::kNoGain : TuneVerdict::kOverfitted;
}

/// The means over the training views, or over the unseen ones.
struct Means {
  TunedScore score;
  double truth_se = 0.0;
};

Means average(const std::vector<TunedViewRecord>& views, bool training) {
  Means means;
  double count = 0.0;
  for (const TunedViewRecord& view : views) {
    if (view.training != training) continue;
    means.score.at_default += view.score.at_default;
    means.score.tuned += view.score.tuned;
    means.truth_se += view.truth_se;
    count += 1.0;
  }
  assert(count > 0.0);
  return {{means.score.at_default / count, means.score.tuned / count}, means.truth_se / count};
}

}  // namespace

void judge_tuning(TunedFilterRecord& filter, const ParamMap& found, bool metric_in_visibility) {
  filter.training = average(filter.views, true).score;
  const Means unseen = average(filter.views, false);
  filter.unseen = unseen.score;
  if (metric_in_visibility) filter.unseen_truth_se = unseen.truth_se;
  filter.verdict = find_verdict(filter);
  filter.params = filter.verdict == TuneVerdict::kBetter ? found : filter.defaults;
}

}  // namespace shadowbench::records
