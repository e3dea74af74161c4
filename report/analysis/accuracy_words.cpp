#include "report/analysis/accuracy_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "filters/kernel_width.h"
#include "reference/metrics/metric_table.h"
#include "report/analysis/cell_group.h"
#include "report/records/format.h"

namespace shadowbench::analysis {
namespace {

constexpr double kDominatingShare = 0.5;
constexpr double kSmallestRate = 0.001;     // below it a fault is not worth a sentence
constexpr double kSmallestOffset = -0.005;  // what is written as "-1 %" and below

// "a", "a and b", "a, b and c".
std::string join_words(const std::vector<std::string>& words) {
  if (words.size() < 2) return words.empty() ? std::string() : words.front();
  return fmt::format("{} and {}", fmt::join(words.begin(), words.end() - 1, ", "), words.back());
}

double truth_se(const records::CellRecord& cell) { return cell.truth.se.value_or(0.0); }

bool are_tied(const records::CellRecord& a, const records::CellRecord& b) {
  return std::abs(*a.error.rmse - *b.error.rmse) <= std::max(find_rmse_reach(a), find_rmse_reach(b));
}

std::string name_with_rmse(const CellGroup& group, std::size_t index) {
  const records::CellRecord& cell = group.cells[index];
  return fmt::format("{} ({})", label_cell(group, cell), records::format_number(*cell.error.rmse));
}

// The cells of one class of width, or of none, in the order of their errors.
std::string describe_ranks(const CellGroup& group, const std::vector<std::vector<std::size_t>>& ranks,
                           std::optional<std::size_t> width_class) {
  std::vector<std::string> places;
  for (const auto& rank : ranks) {
    if (find_class(group.cells[rank.front()]) != width_class) continue;
    std::vector<std::string> names;
    for (const std::size_t i : rank) names.push_back(name_with_rmse(group, i));
    places.push_back(fmt::format("{}", fmt::join(names, " tied with ")));
  }
  return fmt::format("{}", fmt::join(places, "; then "));
}

// Errors of kernels that are not equally wide are not ranked.
std::vector<std::string> describe_error_ranking(const CellGroup& group) {
  const auto ranks = rank_errors(group.cells);
  std::vector<std::string> sentences;
  const auto& classes = filters::width_classes();
  for (std::size_t i = 0; i < classes.size(); ++i)
    if (const std::string text = describe_ranks(group, ranks, i); !text.empty())
      sentences.push_back(
          fmt::format("Error to the area truth (RMSE) of {} kernels, smallest first: {}.", classes[i].name, text));
  if (std::ranges::any_of(ranks, [](const auto& rank) { return rank.size() > 1; }))
    sentences.emplace_back("Tied filters differ by no more than the truth's standard error.");
  std::vector<std::string> apart;
  for (const records::CellRecord& cell : group.cells)
    if (cell.error.rmse && !find_class(cell))
      apart.push_back(fmt::format("{} ({})", label_cell(group, cell), records::format_number(*cell.error.rmse)));
  if (!apart.empty())
    sentences.push_back(
        fmt::format("Not ranked, for their kernels are of no class, too wide or unknown: {}.", fmt::join(apart, ", ")));
  return sentences;
}

// Indices of the parts, largest share first.
std::array<std::size_t, metrics::kErrorParts> order_parts(const records::PartValues& shares) {
  std::array<std::size_t, metrics::kErrorParts> order{};
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return shares[a] > shares[b]; });
  return order;
}

// A cell whose shares say something: where they exist and its error is not lost in the truth's.
struct AttributedCell {
  std::string label;
  records::PartValues shares{};
};

std::vector<AttributedCell> list_attributed(const CellGroup& group) {
  std::vector<AttributedCell> cells;
  for (const records::CellRecord& cell : group.cells) {
    const auto shares = records::list_shares(cell);
    if (shares && !is_lost_in_truth(cell)) cells.push_back({label_cell(group, cell), *shares});
  }
  return cells;
}

std::vector<std::string> describe_lost(const CellGroup& group) {
  std::vector<std::string> names;
  double largest_se = 0.0;
  for (const records::CellRecord& cell : group.cells) {
    if (is_lost_in_truth(cell)) {
      names.push_back(label_cell(group, cell));
      largest_se = std::max(largest_se, truth_se(cell));
    }
  }
  if (names.empty()) return {};
  return {fmt::format("The error of {} cannot be told from the truth's own (standard error {}).", join_words(names),
                      records::format_number(largest_se))};
}

std::string explain_part(std::size_t part) {
  return fmt::format("{} ({})", records::list_error_parts()[part].id, records::list_error_parts()[part].meaning);
}

// One sentence per part that dominates, for all cells it does so in.
std::vector<std::string> describe_dominated(const std::vector<AttributedCell>& cells) {
  std::map<std::size_t, std::vector<std::string>> names;
  for (const AttributedCell& cell : cells)
    if (const auto part = find_dominating_part(cell.shares))
      names[*part].push_back(fmt::format("{} ({})", cell.label, records::format_share(cell.shares[*part])));
  std::vector<std::string> sentences;
  for (const auto& [part, labels] : names) {
    sentences.push_back(fmt::format("Most of the error of {} is {}: {}.", join_words(labels),
                                    records::list_error_parts()[part].id, records::list_error_parts()[part].meaning));
  }
  return sentences;
}

// One sentence per pair of largest parts, for all cells of which that pair is the largest and neither dominates.
std::vector<std::string> describe_divided(const std::vector<AttributedCell>& cells) {
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::string>> names;
  for (const AttributedCell& cell : cells) {
    if (!find_dominating_part(cell.shares)) {
      const auto order = order_parts(cell.shares);
      names[{order[0], order[1]}].push_back(fmt::format("{} ({} and {})", cell.label,
                                                        records::format_share(cell.shares[order[0]]),
                                                        records::format_share(cell.shares[order[1]])));
    }
  }
  std::vector<std::string> sentences;
  for (const auto& [pair, labels] : names) {
    sentences.push_back(fmt::format("No single part dominates the error of {}; the largest are {} and {}.",
                                    join_words(labels), explain_part(pair.first), explain_part(pair.second)));
  }
  return sentences;
}

std::vector<std::string> explain_offsets(const std::vector<AttributedCell>& cells) {
  const bool any = std::any_of(cells.begin(), cells.end(), [](const AttributedCell& cell) {
    return *std::min_element(cell.shares.begin(), cell.shares.end()) <= kSmallestOffset;
  });
  return any ? std::vector<std::string>{"A part with a share below 0 % offsets others, whose shares then sum to more "
                                        "than 100 %."}
             : std::vector<std::string>();
}

// A sentence on one kind of fault, "Acne: filters with their rates", and one that defines it; none where no filter has
// it.
std::vector<std::string> describe_artefact(const CellGroup& group, const metrics::Metric& fault) {
  std::vector<std::string> rates;
  for (const records::CellRecord& cell : group.cells) {
    const double rate = fault.read(cell).value_or(0.0);
    if (rate >= kSmallestRate)
      rates.push_back(fmt::format("{} {}", label_cell(group, cell), records::format_rate(rate)));
  }
  if (rates.empty()) return {};
  std::string name(fault.title);
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return {fmt::format("{}: {}. The rate is the share {}.", name, fmt::join(rates, ", "), fault.definition)};
}

std::vector<std::string> describe_artefacts(const CellGroup& group) {
  std::vector<std::string> sentences;
  for (const metrics::Metric& metric : metrics::metric_table()) {
    if (metric.group() != "artefact") continue;
    const auto more = describe_artefact(group, metric);
    sentences.insert(sentences.end(), more.begin(), more.end());
  }
  return sentences;
}

}  // namespace

double find_rmse_reach(const records::CellRecord& cell) {
  return cell.rmse_ci95 ? 0.5 * (cell.rmse_ci95->high - cell.rmse_ci95->low) : truth_se(cell);
}

std::vector<std::vector<std::size_t>> rank_errors(const std::vector<records::CellRecord>& cells) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i].error.rmse) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return *cells[a].error.rmse < *cells[b].error.rmse; });
  std::vector<std::vector<std::size_t>> groups;
  for (const std::size_t i : order) {
    const auto of_class = [&](const auto& group) { return find_class(cells[group.front()]) == find_class(cells[i]); };
    const auto last = std::find_if(groups.rbegin(), groups.rend(), of_class);
    if (last != groups.rend() && find_class(cells[i]) && are_tied(cells[last->front()], cells[i]))
      last->push_back(i);
    else
      groups.push_back({i});
  }
  return groups;
}

std::optional<std::size_t> find_dominating_part(const records::PartValues& shares) {
  const auto order = order_parts(shares);
  const bool one_is = shares[order[0]] > kDominatingShare && shares[order[1]] <= kDominatingShare;
  return one_is ? std::optional(order[0]) : std::nullopt;
}

bool is_lost_in_truth(const records::CellRecord& cell) {
  return cell.error.rmse && cell.truth.se && *cell.error.rmse <= *cell.truth.se;
}

std::vector<std::string> describe_accuracy(const CellGroup& group) {
  std::vector<std::string> sentences;
  const std::vector<AttributedCell> cells = list_attributed(group);
  for (const auto& more : {describe_error_ranking(group), describe_lost(group), describe_dominated(cells),
                           describe_divided(cells), explain_offsets(cells), describe_artefacts(group)})
    sentences.insert(sentences.end(), more.begin(), more.end());
  return sentences;
}

}  // namespace shadowbench::analysis
