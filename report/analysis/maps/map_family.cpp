#include "report/analysis/maps/map_family.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "report/analysis/cell_group.h"
#include "report/analysis/configuration.h"
#include "report/records/cell_names.h"

namespace shadowbench::analysis {
namespace {

using CellPointers = std::vector<const records::CellRecord*>;

Estimate estimate_time(const std::optional<records::Quartiles>& time) {
  return time ? Estimate{time->median, time->q1, time->q3} : Estimate{};
}

Estimate add_times(const Estimate& a, const Estimate& b) { return {a.value + b.value, a.low + b.low, a.high + b.high}; }

bool is_complete(const records::CellRecord& cell) {
  const bool prefilters = cell.cost.prefilter_texels.value_or(0) > 0;
  return cell.status == records::CellStatus::kOk && cell.error.rmse && cell.time_ms.map && cell.time_ms.lookup &&
         (cell.time_ms.prefilter || !prefilters) && cell.cost.map_bytes && cell.cost.bytes_per_texel.value_or(0) > 0;
}

// One map serves every camera where it is fitted to the scene and to nothing that the camera sees.
bool is_shared(const std::string& fit) { return fit.starts_with("tight") || fit.starts_with("sphere"); }

MapUse make_use(const records::CellRecord& cell, const std::set<std::string>& fits) {
  const double layer = static_cast<double>(*cell.cost.bytes_per_texel) * cell.map_size * cell.map_size;
  return {records::name_fit(cell.fit, fits),
          cell.map_size,
          static_cast<int>(std::lround(static_cast<double>(*cell.cost.map_bytes) / layer)),
          *cell.cost.map_bytes,
          is_shared(cell.fit),
          estimate_rmse(cell),
          add_times(estimate_time(cell.time_ms.map), estimate_time(cell.time_ms.prefilter)),
          estimate_time(cell.time_ms.lookup),
          cell.time_ms.empty ? cell.time_ms.empty->median : 0.0};
}

// Whether a cell has the map of another that is kept.
bool repeats(const records::CellRecord& cell, const CellPointers& kept) {
  return std::ranges::any_of(
      kept,
      [&](const auto* other) {
        return other->map_size == cell.map_size && other->error.rmse == cell.error.rmse &&
               other->map_scale.texel_m == cell.map_scale.texel_m;
      });
}

double find_drift(const std::vector<MapUse>& maps) {
  std::vector<double> empty;
  for (const MapUse& map : maps)
    if (map.layers == 1 && map.empty_ms > 0.0) empty.push_back(map.empty_ms);
  return empty.empty() ? 1.0 : std::ranges::max(empty) / std::ranges::min(empty);
}

void widen(Estimate& time, double factor) { time = {time.value, time.low / factor, time.high * factor}; }

MapFamily make_family(const std::string& name, const std::string& place, CellPointers cells,
                      const std::set<std::string>& fits) {
  std::ranges::stable_sort(cells, {},
                           [](const auto* cell) { return std::pair(!is_shared(cell->fit), cell->map_size); });
  CellPointers kept;
  for (const auto* cell : cells)
    if (!repeats(*cell, kept)) kept.push_back(cell);
  MapFamily family{name, place, {}};
  for (const auto* cell : kept) family.maps.push_back(make_use(*cell, fits));
  family.drift = find_drift(family.maps);
  for (MapUse& map : family.maps)
    for (Estimate* time : {&map.redraw, &map.lookup}) widen(*time, std::sqrt(family.drift));
  std::ranges::stable_sort(family.maps, {}, &MapUse::size);
  return family;
}

bool has_fits(const MapFamily& family) {
  std::set<std::string> fits;
  for (const MapUse& map : family.maps) fits.insert(map.fit);
  return fits.size() > 1;
}

bool is_as_accurate(const MapUse& map, const MapUse& as) { return !is_clearly_less_error(as.rmse, map.rmse); }

int compare_costs_of(const Estimate& a, const Estimate& b) {
  return is_clearly_less_cost(a, b) ? -1 : is_clearly_less_cost(b, a) ? 1 : 0;
}

// The best map among those that `may`; nothing where none may.
template <class May, class Better>
std::optional<std::size_t> find_best(const MapFamily& family, May&& may, Better&& better) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < family.maps.size(); ++i)
    if (may(family.maps[i]) && (!best || better(family.maps[i], family.maps[*best]))) best = i;
  return best;
}

// B + V L < V (b + l) for the ends of the quartiles that speak against it.
std::optional<int> find_first_view(const MapUse& shared, const MapUse& own) {
  const double gain = own.frame().low - shared.lookup.high;
  if (!(gain > 0.0)) return std::nullopt;
  return static_cast<int>(std::floor(shared.redraw.high / gain)) + 1;
}

}  // namespace

Estimate MapUse::frame() const { return add_times(redraw, lookup); }

std::vector<MapFamily> list_map_families(const std::vector<records::CellRecord>& cells) {
  std::set<std::string> fits;
  for (const records::CellRecord& cell : cells) fits.insert(cell.fit);
  if (fits.size() < 2) return {};
  CellPointers complete;
  std::vector<records::CellRecord> plain;  // the same without their maps: one configuration is a family
  for (const records::CellRecord& cell : cells) {
    if (!is_complete(cell)) continue;
    complete.push_back(&cell);
    plain.push_back(cell);
    plain.back().fit.clear();
    plain.back().map_size = 0;
  }
  const CellPointers all = point_to(plain);
  const auto places = list_places(all);
  std::vector<MapFamily> families;
  for (const Configuration& configuration : list_configurations(all)) {
    for (const Place& place : places) {
      CellPointers members;
      for (const records::CellRecord* cell : configuration.cells)
        if (place_of(*cell) == place) members.push_back(complete[static_cast<std::size_t>(cell - plain.data())]);
      MapFamily family = make_family(configuration.name, describe_place(place, places), std::move(members), fits);
      if (has_fits(family)) families.push_back(std::move(family));
    }
  }
  return families;
}

std::vector<LayerComparison> compare_layers(const MapFamily& family) {
  std::vector<LayerComparison> comparisons;
  std::set<std::int64_t> sizes;
  for (const MapUse& map : family.maps) sizes.insert(map.bytes);
  for (const std::int64_t bytes : sizes) {
    const auto layered = find_best(
        family, [&](const MapUse& map) { return map.layers > 1 && map.bytes == bytes; },
        [](const MapUse& a, const MapUse& b) { return a.rmse.value < b.rmse.value; });
    for (std::size_t i = 0; layered && i < family.maps.size(); ++i) {
      const MapUse &a = family.maps[*layered], &b = family.maps[i];
      if (b.layers > 1 || b.bytes != bytes || !(b.rmse.value > 0.0) || !(b.frame().value > 0.0)) continue;
      const int error_sign = is_clearly_less_error(a.rmse, b.rmse) ? -1 : is_clearly_less_error(b.rmse, a.rmse) ? 1 : 0;
      comparisons.push_back({*layered, i, a.rmse.value / b.rmse.value, a.frame().value / b.frame().value, error_sign,
                             compare_costs_of(a.frame(), b.frame())});
    }
  }
  return comparisons;
}

std::vector<Sharing> find_sharing(const MapFamily& family) {
  std::vector<Sharing> all;
  for (std::size_t i = 0; i < family.maps.size(); ++i) {
    const MapUse& shared = family.maps[i];
    if (!shared.shared) continue;
    const auto own = find_best(
        family, [&](const MapUse& map) { return !map.shared && is_as_accurate(map, shared); },
        [](const MapUse& a, const MapUse& b) { return a.frame().value < b.frame().value; });
    all.push_back({i, own, own ? find_first_view(shared, family.maps[*own]) : std::nullopt});
  }
  const bool any_own = std::ranges::any_of(family.maps, [](const MapUse& map) { return !map.shared; });
  return any_own ? all : std::vector<Sharing>();
}

std::vector<Caching> find_caching(const MapFamily& family) {
  std::vector<Caching> all;
  for (std::size_t i = 0; i < family.maps.size(); ++i) {
    const MapUse& own = family.maps[i];
    if (own.shared) continue;
    const auto cached = find_best(
        family, [&](const MapUse& map) { return map.shared && is_as_accurate(map, own); },
        [](const MapUse& a, const MapUse& b) {
          return std::pair(a.size, a.lookup.value) < std::pair(b.size, b.lookup.value);
        });
    const Estimate lookup = cached ? family.maps[*cached].lookup : Estimate{};
    all.push_back({i, cached, cached ? own.frame().value - lookup.value : 0.0,
                   cached && is_clearly_less_cost(lookup, own.frame())});
  }
  const bool any_shared = std::ranges::any_of(family.maps, &MapUse::shared);
  return any_shared ? all : std::vector<Caching>();
}

}  // namespace shadowbench::analysis
