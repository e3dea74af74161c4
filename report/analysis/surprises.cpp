#include "report/analysis/surprises.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

#include "reference/metrics/metric_table.h"
#include "report/analysis/advice.h"
#include "report/analysis/cell_group.h"
#include "report/analysis/extremes.h"
#include "report/records/absence.h"
#include "report/records/error_parts.h"
#include "report/records/format.h"

namespace shadowbench::analysis {
namespace {

constexpr double kDearer = 1.5;           // times as dear: worth a sentence
constexpr double kNoFault = 0.001;        // below this rate a fault is not seen
constexpr std::size_t kMostTroubles = 3;  // of which each may hide all else; of other kinds one sentence does
constexpr double kMajority = 2.0 / 3.0;   // of the cells: what "most" means

using Cells = std::vector<records::CellRecord>;

std::string number(double value) { return records::format_number(value); }

/// Everything about a run's configurations that sentences are made of.
class Finder {
 public:
  explicit Finder(const Cells& cells) : all_(point_to(cells)) {
    places_ = list_places(all_);
    configurations_ = list_configurations(all_);
    std::vector<const records::CellRecord*> ranked = all_;
    std::erase_if(ranked, [](const auto* cell) { return !records::is_advised(*cell); });
    ranked_places_ = list_places(ranked).size();
    std::erase_if(ranked, [](const auto* cell) { return cell->status != records::CellStatus::kOk; });
    sound_ = list_configurations(ranked);
  }

  std::vector<std::string> find() const {
    std::vector<std::string> all;
    const auto add = [&](const std::vector<std::string>& more, std::size_t most) {
      all.insert(all.end(), more.begin(), more.begin() + static_cast<std::ptrdiff_t>(std::min(more.size(), most)));
    };
    add(list_troubles(), kMostTroubles);
    for (const auto& more : {list_wasted(), list_turnovers(), list_parts(), list_diluted(), list_only()}) add(more, 1);
    all.resize(std::min(all.size(), kMostSurprises));
    return all;
  }

 private:
  std::string name_place(const records::CellRecord& cell) const { return describe_place(place_of(cell), places_); }

  /// One sentence for all configurations in the same trouble.
  std::vector<std::string> list_troubles() const {
    std::map<std::string, std::vector<std::string>> names;
    for (const Configuration& configuration : configurations_) {
      const auto bad = std::ranges::find_if(configuration.cells,
                                            [](const auto* cell) { return cell->status != records::CellStatus::kOk; });
      if (bad == configuration.cells.end()) continue;
      const bool is_suspect = (*bad)->status == records::CellStatus::kSuspect;
      names[is_suspect ? "suspect: see the warnings" : records::describe_status(**bad)].push_back(configuration.name);
    }
    std::vector<std::string> sentences;
    for (const auto& [status, labels] : names)
      sentences.push_back(fmt::format("Not ranked or advised: {} ({}).", list_some(labels), status));
    for (const records::CellRecord* cell : all_)
      if (cell->nan.value_or(0) > 0)
        sentences.push_back(fmt::format("{} has {} pixels on {} that are not finite, which no number here counts.",
                                        cell->filter, *cell->nan, name_place(*cell)));
    return sentences;
  }

  /// Calls `visit(a, b, pairs)` with each two configurations of one class of width and the cells of both by place.
  template <class Visitor>
  void visit_pairs(Visitor&& visit) const {
    using Common = std::pair<std::string_view, std::size_t>;
    const auto common = [](const Configuration& each) {
      return Common(each.surroundings, *find_class(*each.cells.front()));
    };
    std::map<Common, std::vector<std::size_t>> peers;
    std::vector<std::vector<const records::CellRecord*>> at(sound_.size());  // with an error, by place
    for (std::size_t i = 0; i < sound_.size(); ++i) {
      if (!find_class(*sound_[i].cells.front())) continue;
      peers[common(sound_[i])].push_back(i);
      at[i].resize(places_.size());
      for (const records::CellRecord* cell : sound_[i].cells)
        if (cell->error.rmse) at[i][find_place(places_, *cell)] = cell;
    }
    std::vector<std::array<const records::CellRecord*, 2>> pairs;
    for (std::size_t a = 0; a < sound_.size(); ++a) {
      if (at[a].empty()) continue;
      for (const std::size_t b : peers[common(sound_[a])]) {
        if (a == b) continue;
        pairs.clear();
        for (std::size_t place = 0; place < places_.size(); ++place)
          if (at[a][place] && at[b][place]) pairs.push_back({at[a][place], at[b][place]});
        if (!pairs.empty()) visit(sound_[a], sound_[b], pairs);
      }
    }
  }

  /// By how much the first error is clearly the smaller one, as a ratio; 1 where they cannot be told apart.
  static double gain(const records::CellRecord& a, const records::CellRecord& b) {
    return is_clearly_less_error(estimate_rmse(a), estimate_rmse(b)) ? *b.error.rmse / *a.error.rmse : 1.0;
  }

  /// The sentences of a map's values, those with the largest numbers first.
  static std::vector<std::string> sort_sentences(const auto& found) {
    std::vector<std::pair<double, std::string>> sorted;
    for (const auto& [key, sentence] : found) sorted.push_back(sentence);
    std::ranges::stable_sort(sorted, std::greater(), &std::pair<double, std::string>::first);
    std::vector<std::string> sentences;
    for (auto& [number, sentence] : sorted) sentences.push_back(std::move(sentence));
    return sentences;
  }

  std::vector<std::string> list_turnovers() const {
    std::map<std::pair<std::string_view, std::string_view>, std::pair<double, std::string>> sentences;
    visit_pairs([&](const Configuration& a, const Configuration& b, const auto& pairs) {
      const auto better = [](const auto& p) { return gain(*p[0], *p[1]); };
      const auto worse = [](const auto& p) { return gain(*p[1], *p[0]); };
      const auto best = std::ranges::max_element(pairs, {}, better), worst = std::ranges::max_element(pairs, {}, worse);
      const double turn = std::min(better(*best), worse(*worst));
      if (turn <= 1.0) return;
      // Of all parameters of two filters the pair that turns most.
      const std::string_view first = a.cells.front()->filter, second = b.cells.front()->filter;
      auto& known = sentences[std::minmax(first, second)];
      if (known.first >= turn) return;
      known = {turn, fmt::format(
                         "The order turns over: {} has a smaller RMSE than {} on {} ({} against {}), and a larger one "
                         "on {} ({} against {}).",
                         a.name, b.name, name_place(*(*best)[0]), number(*(*best)[0]->error.rmse),
                         number(*(*best)[1]->error.rmse), name_place(*(*worst)[0]), number(*(*worst)[0]->error.rmse),
                         number(*(*worst)[1]->error.rmse))};
    });
    return sort_sentences(sentences);
  }

  /// Pairs, measured in every place, of which the dearer one is clearly better nowhere; of one dearer filter, the
  /// cheapest that equals it.
  std::vector<std::string> list_wasted() const {
    std::map<std::string, std::pair<double, std::string>> worst;
    visit_pairs([&](const Configuration& a, const Configuration& b, const auto& pairs) {
      if (pairs.size() < ranked_places_) return;
      double of_a = 0.0, of_b = 0.0;
      for (const auto& [cell, other] : pairs) {
        const auto time = frame_time(*cell, LightMotion::kMoving), cheaper = frame_time(*other, LightMotion::kMoving);
        if (!time || !cheaper || gain(*cell, *other) > 1.0) return;
        of_a += time->median;
        of_b += cheaper->median;
      }
      if (!(of_b > 0.0) || of_a < kDearer * of_b) return;
      auto& known = worst[a.name];
      if (known.first >= of_a / of_b) return;
      known = {of_a / of_b, fmt::format("With a moving light {} costs {} times what {} does, has a kernel of the same "
                                        "class of width, and has a clearly smaller RMSE on no scene.",
                                        a.name, number(of_a / of_b), b.name)};
    });
    return sort_sentences(worst);
  }

  /// Errors that most of comes from another part than that of most cells.
  std::vector<std::string> list_parts() const {
    struct Found {
      const records::CellRecord* cell;
      std::string label;
      std::size_t part;
    };
    std::vector<Found> dominated;
    std::map<std::size_t, std::size_t> counts;
    for (const Configuration& configuration : sound_) {
      for (const records::CellRecord* cell : configuration.cells) {
        const auto shares = records::list_shares(*cell);
        const auto part = shares && !is_lost_in_truth(*cell) ? find_dominating_part(*shares) : std::nullopt;
        if (!part) continue;
        dominated.push_back({cell, configuration.name, *part});
        ++counts[*part];
      }
    }
    if (counts.size() < 2) return {};
    const auto usual = std::ranges::max_element(counts, {}, [](const auto& count) { return count.second; });
    if (static_cast<double>(usual->second) < kMajority * static_cast<double>(dominated.size())) return {};
    std::map<std::pair<std::string, std::size_t>, std::vector<std::string>> where;
    for (const Found& each : dominated)
      if (each.part != usual->first) {
        const records::PartShares shares = *records::list_shares(*each.cell);
        where[{each.label, each.part}].push_back(fmt::format("{} ({}{})", name_place(*each.cell),
                                                             records::format_share(*shares[each.part]),
                                                             records::has_offsets(shares) ? ", offset by others" : ""));
      }
    std::vector<std::string> sentences;
    for (const auto& [key, places] : where) {
      const records::ErrorPart &own = records::list_error_parts()[key.second],
                               &most = records::list_error_parts()[usual->first];
      sentences.push_back(
          fmt::format("Most of the error of {} comes from {} ({}) on {}; that of most others from {} ({}).", key.first,
                      own.id, own.meaning, list_some(places), most.id, most.meaning));
    }
    return sentences;
  }

  /// Filters whose own error is much smaller than another's, and whose whole error is not: whoever expects of the whole
  /// what a paper says of a bound.
  std::vector<std::string> list_diluted() const {
    constexpr double kWeighty = 0.5, kMuchSmaller = 0.6, kLess = 1.3;
    std::map<std::pair<std::string_view, std::string_view>, std::pair<double, std::string>> sentences;
    visit_pairs([&](const Configuration& a, const Configuration& b, const auto& pairs) {
      for (const auto& [cell, other] : pairs) {
        const auto own = cell->attribution.estimator.rms, of_other = other->attribution.estimator.rms;
        if (!own || !(*own > 0.0) || !of_other || *of_other < kWeighty * *other->error.rmse) continue;
        const double part = *own / *of_other, whole = *cell->error.rmse / *other->error.rmse;
        if (part > kMuchSmaller || whole >= 1.0 || whole < kLess * part) continue;
        auto& known = sentences[{cell->filter, other->filter}];
        if (known.first >= whole / part) continue;
        known = {whole / part, fmt::format("The estimator's part of the error of {} is {} of that of {} on {}, but the "
                                           "RMSE {}: the rest comes from the map and the kernel, which both share.",
                                           a.name, number(part), b.name, name_place(*cell), number(whole))};
      }
    });
    return sort_sentences(sentences);
  }

  /// The largest rate of a fault; nothing where a place has none, unless there was nothing to see.
  std::optional<double> find_most(const Configuration& configuration, const metrics::Metric& metric) const {
    std::optional<double> most;
    if (configuration.cells.size() < ranked_places_) return most;
    for (const records::CellRecord* cell : configuration.cells) {
      const auto rate = metric.read(*cell);
      if (rate)
        most = std::max(most.value_or(0.0), *rate);
      else if (!records::is_nothing_to_see(records::explain_absence(*cell, std::string(metric.path))))
        return std::nullopt;
    }
    return most;
  }

  /// Faults that a single configuration is free of.
  std::vector<std::string> list_only() const {
    std::vector<std::string> sentences;
    for (const metrics::Metric& metric : metrics::metric_table()) {
      if (metric.group() != "artefact" || metric.limit.empty()) continue;
      std::vector<std::string> free;
      std::size_t judged = 0;
      for (const Configuration& configuration : sound_) {
        const auto most = find_most(configuration, metric);
        judged += most.has_value();
        if (most && *most < kNoFault) free.push_back(configuration.name);
      }
      if (free.size() == 1 && judged > 2)
        sentences.push_back(fmt::format("Only {}, of {} measured, has {} below {} on every scene that can show it.",
                                        free.front(), judged, metric.title, records::format_rate(kNoFault)));
    }
    return sentences;
  }

  std::vector<const records::CellRecord*> all_;
  std::vector<Place> places_;
  std::vector<Configuration> configurations_;
  std::size_t ranked_places_ = 0;
  std::vector<Configuration> sound_;  ///< of cells that may be ranked
};

}  // namespace

std::vector<std::string> list_surprises(const Cells& cells) { return Finder(cells).find(); }

}  // namespace shadowbench::analysis
