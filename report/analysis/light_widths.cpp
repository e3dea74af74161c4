#include "report/analysis/light_widths.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "report/analysis/cell_group.h"
#include "report/analysis/configuration.h"
#include "report/records/error_parts.h"
#include "report/records/format.h"

namespace shadowbench::analysis {
namespace {

constexpr double kNear = 0.1;  // relative: what nobody tells from the width that was asked for

std::string number(double value) { return records::format_number(value); }

/// The largest part of an error, or why it is not known.
std::string describe_largest_part(const records::CellRecord& cell) {
  const auto shares = records::list_shares(cell);
  if (!shares) return records::explain_no_attribution(cell);
  const auto most = std::ranges::max_element(*shares);
  const records::ErrorPart& part = records::list_error_parts()[static_cast<std::size_t>(most - shares->begin())];
  return fmt::format("{} {}: {}", records::format_share(most->value_or(0.0)), part.id, part.meaning);
}

/// What a run's sentences are made of, group by group.
class Widths {
 public:
  explicit Widths(const std::vector<records::CellRecord>& cells) : places_(list_places(point_to(cells))) {
    std::set<int> maps;
    for (const records::CellRecord& cell : cells) maps.insert(cell.map_size);
    names_maps_ = maps.size() > 1;
    for (const CellGroup& group : group_cells(cells)) add(group);
  }

  std::vector<std::string> describe() const {
    std::vector<std::string> sentences;
    if (asked_.empty()) return sentences;
    sentences.push_back(fmt::format(
        "Kernels whose width can be chosen are as wide as the scene's light asks for: their standard deviation is a "
        "quarter of the median width of the penumbrae in view. In texels: {}.",
        fmt::join(asked_, ", ")));
    if (!others_.empty())
      sentences.push_back(
          fmt::format("Where a filter cannot be so narrow, or only by whole texels, it has the nearest "
                      "width that it can: {}.",
                      fmt::join(others_, ", ")));
    if (!worse_.empty())
      sentences.push_back(fmt::format(
          "Of a larger RMSE than none all the same, with the largest part of the error: {}.", fmt::join(worse_, "; ")));
    return sentences;
  }

 private:
  std::vector<Place> places_;
  bool names_maps_ = false;
  std::vector<std::string> asked_, others_, worse_;

  void add(const CellGroup& group) {
    const records::CellRecord& first = group.cells.front();
    std::string where = describe_place(place_of(first), places_);
    if (names_maps_) where += fmt::format(" at {}", first.map_size);
    const auto none = std::ranges::find(group.cells, std::string("none"), &records::CellRecord::filter);
    bool is_told = false;
    for (const records::CellRecord& cell : group.cells) {
      const auto& [sigma, width_class, by_light, light] = cell.kernel;
      if (!by_light || !sigma || !light) continue;
      if (!is_told) asked_.push_back(fmt::format("{} on {}", number(*light), where));
      is_told = true;
      const std::string name = fmt::format("{} on {}", group.names.name(cell), where);
      if (std::abs(*sigma - *light) > kNear * *light)
        others_.push_back(fmt::format("{} {} for {}", name, number(*sigma), number(*light)));
      if (none != group.cells.end() && none->error.rmse && cell.error.rmse > none->error.rmse)
        worse_.push_back(fmt::format("{} ({})", name, describe_largest_part(cell)));
    }
  }
};

}  // namespace

std::vector<std::string> describe_light_widths(const std::vector<records::CellRecord>& cells) {
  return Widths(cells).describe();
}

}  // namespace shadowbench::analysis
