#include "report/pages/external_section.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "report/analysis/configuration.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

constexpr const char* kNote =
    "Each row is one picture, so that its errors stand beside those of our filters in the first phase of the map's "
    "grid. Without silhouettes: receivers none of whose neighbours lies on another surface. Cost is what its user "
    "says. Nothing is advised of these rows, for what they cost here is not known.";

std::string format_shift(const records::ExternalRecord& external) {
  if (!external.shift_x) return "not known";
  return fmt::format("{:.3f} by {}{}", std::hypot(*external.shift_x, *external.shift_y), external.aligned_by,
                     external.unaligned ? ": NOT our view" : "");
}

/// The run's filters about as good: the best that is worse, and the worst that is better.
std::string describe_peers(const records::CellRecord& cell) {
  if (!cell.error.rmse) return {};
  const std::pair<const std::string, double>*better = nullptr, *worse = nullptr;
  for (const auto& peer : cell.external->peers) {
    if (peer.second <= *cell.error.rmse && (!better || peer.second > better->second)) better = &peer;
    if (peer.second > *cell.error.rmse && (!worse || peer.second < worse->second)) worse = &peer;
  }
  std::vector<std::string> parts;
  if (better) parts.push_back(fmt::format("{} {}", better->first, records::format_number(better->second)));
  if (worse) parts.push_back(fmt::format("{} {}", worse->first, records::format_number(worse->second)));
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace

std::string describe_engine(const records::ExternalRecord& external) {
  std::vector<std::string> parts;
  const std::string engine = fmt::format("{} {}", external.engine.value_or(""), external.version.value_or(""));
  if (engine != " ") parts.push_back(engine);
  for (const auto& [name, text] : {std::pair("map", &external.map), std::pair("bias", &external.bias),
                                   std::pair("fit", &external.fit), std::pair("driver", &external.driver)})
    if (*text) parts.push_back(fmt::format("{} {}", name, **text));
  return fmt::format("{}", fmt::join(parts, " · "));
}

std::optional<document::Section> make_external_section(const std::vector<records::CellRecord>& cells) {
  records::TextTable table{{"row", "scene", "RMSE", "without silhouettes", "our filters beside it",
                            "nearest, and how far", "acne", "leak", "shift, pixels"},
                           {}};
  records::TextTable origins{{"row", "scene", "drawn by", "undefined receivers", "cost, as its user says"}, {}};
  std::vector<const records::CellRecord*> rows;
  for (const records::CellRecord& cell : cells)
    if (cell.external) rows.push_back(&cell);
  const std::vector<analysis::Place> places = analysis::list_places(rows);
  const auto varies = [&](auto member) {
    return std::ranges::any_of(rows, [&](const auto* row) { return row->*member != rows.front()->*member; });
  };
  for (const records::CellRecord* row : rows) {
    const records::CellRecord& cell = *row;
    const records::ExternalRecord& external = *cell.external;
    std::string place = analysis::describe_place(analysis::place_of(cell), places);
    if (varies(&records::CellRecord::map_size)) place += fmt::format(", beside map {}", cell.map_size);
    if (varies(&records::CellRecord::width)) place += fmt::format(", {} x {}", cell.width, cell.height);
    table.rows.push_back({cell.filter, place, records::format_number(cell.error.rmse),
                          records::format_number(external.inside_rmse), describe_peers(cell),
                          external.nearest
                              ? fmt::format("{}, {}", *external.nearest, records::format_number(external.nearest_rmse))
                              : "–",
                          records::format_number(cell.artefact.acne), records::format_number(cell.artefact.leak),
                          format_shift(external)});
    origins.rows.push_back({cell.filter, place, describe_engine(external), fmt::format("{}", external.undefined),
                            external.ms ? fmt::format("{} ms{}", records::format_number(external.ms),
                                                      external.timed ? ", " + *external.timed : "")
                                        : "–"});
  }
  if (table.rows.empty()) return std::nullopt;
  return document::Section{
      "external",
      "Other renderers",
      {document::Table{"What other renderers drew, against the same truth", std::move(table)},
       document::Details{"What drew them", {document::Table{"As their users say", std::move(origins)}}},
       document::Paragraph{kNote, true}}};
}

}  // namespace shadowbench::pages
