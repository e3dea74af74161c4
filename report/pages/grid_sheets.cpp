#include "report/pages/grid_sheets.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for_each.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "base/error.h"
#include "report/analysis/advice.h"
#include "report/analysis/advice_words.h"
#include "report/analysis/cells.h"
#include "report/analysis/measures.h"
#include "report/images/color_values.h"
#include "report/images/crop.h"
#include "report/images/picture_io.h"
#include "report/pages/answer.h"
#include "report/records/format.h"
#include "report/records/records.h"

namespace shadowbench::pages {
namespace {

constexpr const char *kTruth = "truth.area", *kTruthMask = "truth.mask";

using ImagesByName = std::map<std::string, images::Image>;

/// The keys of what is advised, with the names of the answers that they are.
std::map<std::string, std::string> list_roles(const std::vector<records::CellRecord>& cells) {
  std::map<std::string, std::string> roles;
  with_first_advice(cells, [&](const analysis::Advice& advice) {
    if (advice.keeping.size() + advice.beaten.size() + advice.no_gain.size() < 2) return;
    for (const analysis::Pick& pick : analysis::list_picks(advice))
      for (const records::CellRecord* cell : advice.keeping[pick.index].configuration.cells)
        roles[cell->key] = fmt::format("{}", fmt::join(pick.names, " and "));
  });
  return roles;
}

std::string write_cost(double value, const analysis::CostKind& kind, const records::GlRecord& gl) {
  if (kind.kind != analysis::CostKind::kGpu) return analysis::format_cost(value, kind, gl);
  return value < 1.0 ? fmt::format("≈ {} µs", records::format_number(1e3 * value))
                     : fmt::format("≈ {} ms", records::format_number(value));
}

std::string explain_cost(const std::vector<records::CellRecord>& cells, const analysis::CostKind& kind) {
  const std::size_t places = analysis::list_places(analysis::point_to(cells)).size();
  return fmt::format("Cost: {}, moving light{}.",
                     kind.kind == analysis::CostKind::kGpu ? "estimated for " + kind.gpu : "a frame's time",
                     places > 1 ? fmt::format(", mean of {} views", places) : "");
}

bool is_suspect(const records::CellRecord& cell) { return cell.status == records::CellStatus::kSuspect; }

std::optional<double> find_rmse(const records::CellRecord& cell) {
  return cell.error.rmse && std::isfinite(*cell.error.rmse) ? cell.error.rmse : std::nullopt;
}

/// By error; behind them those that are suspect, and those without one.
std::vector<const records::CellRecord*> sort_cells(const analysis::CellGroup& group) {
  std::vector<const records::CellRecord*> cells;
  for (const records::CellRecord& cell : group.cells)
    if (cell.images.grid) cells.push_back(&cell);
  const auto rank = [](const records::CellRecord* cell) {
    return std::tuple(!records::is_drawn(*cell), is_suspect(*cell), !find_rmse(*cell), find_rmse(*cell).value_or(0.0));
  };
  std::ranges::stable_sort(cells, {}, rank);
  return cells;
}

/// Writes errors of one grid with the same number of decimals.
int count_decimals(const std::vector<const records::CellRecord*>& cells) {
  double least = 1.0;
  for (const records::CellRecord* cell : cells)
    if (const auto rmse = find_rmse(*cell); rmse && *rmse > 0.0 && !is_suspect(*cell)) least = std::min(least, *rmse);
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(least))), 2, 6);
}

std::string name_part(const records::CellRecord& cell) { return cell.images.parts.value_or("") + ".visibility"; }

/// Reads the visibility of cells and of the truth, what of it can be read.
ImagesByName read_images(const std::filesystem::path& dir, const std::vector<const records::CellRecord*>& cells) {
  std::map<std::string, std::set<std::string>> wanted;
  for (const records::CellRecord* cell : cells)
    if (cell->images.exr) wanted[*cell->images.exr].insert({name_part(*cell), kTruth, kTruthMask});
  ImagesByName images;
  for (const auto& [file, names] : wanted) {
    try {
      const auto is_wanted = [&](const std::string& name) { return names.contains(name) && !images.contains(name); };
      for (images::Part& part : images::read_exr(dir / file, is_wanted).parts)
        images.emplace(part.name, std::move(part.image));
    } catch (const Error&) {
      // The cell's tile says that it has no image.
    }
  }
  return images;
}

const images::Image* find_image(const ImagesByName& images, const std::string& name) {
  const auto found = images.find(name);
  return found == images.end() || found->second.empty() ? nullptr : &found->second;
}

/// The image of a path; empty where it cannot be read.
images::Image read_picture(const std::filesystem::path& dir, const std::optional<std::string>& path) {
  try {
    if (!path) return {};
    images::Image picture = images::read_picture(dir / *path);
    return picture.channels == 3 ? picture : images::Image();
  } catch (const Error&) {
    return {};
  }
}

/// One grid: the cells of a scene, a view and a map.
class GridMaker {
 public:
  GridMaker(const std::filesystem::path& dir, const analysis::CellGroup& group, const GridWords& words)
      : dir_(dir), group_(group), words_(words), cells_(sort_cells(group)), images_(read_images(dir, cells_)) {
    std::vector<const images::Image*> compared = {find_image(images_, kTruth)};
    for (const records::CellRecord* cell : cells_)
      if (!is_suspect(*cell)) compared.push_back(find_image(images_, name_part(*cell)));
    crop_ = images::find_disputed_edge(compared, 0, images::kSheetCrop);
    if (crop_.width == 0 && !images_.empty())  // all are suspect
      crop_ = images::find_disputed_edge({&images_.begin()->second}, 0, images::kSheetCrop);
    std::vector<images::Image> errors;
    std::vector<const images::Image*> counted;
    for (const records::CellRecord* cell : cells_)
      if (!is_suspect(*cell)) errors.push_back(make_error(*cell));
    for (const images::Image& error : errors) counted.push_back(&error);
    error_scale_ = images::choose_error_scale(counted);
    choose_corner(errors);
    for (const records::CellRecord* cell : cells_)
      if (!is_suspect(*cell)) most_ = std::max(most_, find_rmse(*cell).value_or(0.0));
  }

  bool has_images() const { return !cells_.empty() && crop_.width > 0; }
  std::size_t count() const { return cells_.size(); }

  images::Sheet make(std::size_t sheet, std::size_t sheets) const {
    images::Sheet made;
    const bool has_truth = find_image(images_, kTruth) != nullptr;
    made.title = fmt::format("{}: {}{}", group_.scene,
                             has_truth ? "which filter is nearest to the truth?" : "the filters side by side",
                             sheets > 1 ? fmt::format(" ({} of {})", sheet + 1, sheets) : "");
    made.note = describe();
    made.truth = make_truth();
    const std::size_t first = sheet * images::kFiltersOfSheet, end = std::min(first + images::kFiltersOfSheet, count());
    for (std::size_t i = first; i < end; ++i) made.filters.push_back(make_tile(*cells_[i]));
    made.view = read_view();
    made.crop = crop_;
    made.inset_column = corner_ % 2;
    made.inset_row = corner_ / 2;
    if (most_ > 0.0) made.view_notes.emplace_back("Number: RMSE of visibility, bars to one scale.");
    const auto has_cost = [](const images::SheetTile& tile) { return !tile.words.empty(); };
    if (std::ranges::any_of(made.filters, has_cost)) made.view_notes.push_back(words_.cost_note);
    return made;
  }

 private:
  /// Insets hide the quarter of the crop with the smallest errors; the last of several.
  void choose_corner(const std::vector<images::Image>& errors) {
    std::array<double, 4> sums{};
    for (const images::Image& error : errors)
      for (int y = 0; y < error.height; ++y)
        for (int x = 0; x < error.width; ++x)
          if (const float value = std::abs(*error.at(x, y)); std::isfinite(value))
            sums[static_cast<std::size_t>(2 * (2 * y >= error.height) + (2 * x >= error.width))] +=
                static_cast<double>(value);
    corner_ = 3 - static_cast<int>(std::ranges::min_element(sums.rbegin(), sums.rend()) - sums.rbegin());
  }

  std::string describe() const {
    const records::CellRecord& cell = *cells_.front();
    std::string text;
    if (find_image(images_, kTruth))
      text = fmt::format(
          "Sorted by error. Small: visibility minus truth, blue too dark, red too bright, full colour at ±{}. ",
          records::format_number(error_scale_));
    text += fmt::format("Map {}², image {} × {}", cell.map_size, cell.width, cell.height);
    if (cell.fit != "tight") text += ", " + cell.fit;
    if (cell.view != "main") text += ", view " + cell.view;
    return text + ".";
  }

  images::SheetTile make_truth() const {
    if (find_image(images_, kTruth))
      return {.name = "ray-traced truth",
              .words = "the reference",
              .crop = cut(read_picture(dir_, cells_.front()->images.truth_picture), find_image(images_, kTruth))};
    return {.name = "no truth", .message = records::explain_absence(*cells_.front(), "error")};
  }

  images::SheetTile make_tile(const records::CellRecord& cell) const {
    images::SheetTile tile{.name = group_.names.name(cell)};
    if (const auto words = words_.of_cells.find(cell.key); words != words_.of_cells.end()) {
      tile.words = words->second.cost;
      tile.role = words->second.role;
    }
    if (const auto rmse = find_rmse(cell); rmse && !is_suspect(cell)) {
      tile.number = fmt::format("{:.{}f}", *rmse, count_decimals(cells_));
      tile.bar = most_ > 0.0 ? *rmse / most_ : 0.0;
    }
    if (is_suspect(cell)) tile.message = "suspect: see the report";
    tile.crop = cut(read_picture(dir_, cell.images.picture), find_image(images_, name_part(cell)));
    if (tile.crop.empty())
      tile.message = records::is_drawn(cell) ? "its image cannot be read" : records::describe_status(cell);
    else if (const images::Image error = make_error(cell); !error.empty())
      tile.inset = images::color_values(error, images::make_signed_scale(error_scale_));
    return tile;
  }

  /// The crop of an image, or of visibility where there is no image.
  images::Image cut(const images::Image& picture, const images::Image* visibility) const {
    const auto has_crop = [&](const images::Image& image) {
      return crop_.x + crop_.width <= image.width && crop_.y + crop_.height <= image.height;
    };
    if (has_crop(picture)) return images::cut_image(picture, crop_);
    if (!visibility || !has_crop(*visibility)) return {};
    return images::color_values(images::cut_image(*visibility, crop_), images::map_grey);
  }

  /// Visibility minus truth in the crop, 0 where no receiver is; empty without either.
  images::Image make_error(const records::CellRecord& cell) const {
    const images::Image *own = find_image(images_, name_part(cell)), *truth = find_image(images_, kTruth),
                        *mask = find_image(images_, kTruthMask);
    if (!own || !truth || !mask || own->texels.size() != truth->texels.size()) return {};
    images::Image error(crop_.width, crop_.height, 1);
    for (int y = 0; y < crop_.height; ++y)
      for (int x = 0; x < crop_.width; ++x) {
        const int at_x = crop_.x + x, at_y = crop_.y + y;
        if (*mask->at(at_x, at_y) > 0.0f) *error.at(x, y) = *own->at(at_x, at_y) - *truth->at(at_x, at_y);
      }
    return error;
  }

  images::Image read_view() const {
    const records::ImagesRecord& first = cells_.front()->images;
    images::Image view = read_picture(dir_, first.truth_picture ? first.truth_picture : first.picture);
    if (view.empty()) view = images::color_values(images_.begin()->second, images::map_grey);
    return view;
  }

  const std::filesystem::path& dir_;
  const analysis::CellGroup& group_;
  const GridWords& words_;
  std::vector<const records::CellRecord*> cells_;
  ImagesByName images_;
  images::Rect crop_;
  double error_scale_ = 0.0;
  int corner_ = 3;     ///< of insets: 0 and 1 above, 0 and 2 on the left
  double most_ = 0.0;  ///< the largest error
};

}  // namespace

std::vector<std::string> list_sheets(const std::string& grid, std::size_t filters) {
  std::vector<std::string> sheets = {grid};
  const std::size_t dot = std::min(grid.rfind('.'), grid.size()),
                    last = (filters + images::kFiltersOfSheet - 1) / images::kFiltersOfSheet;
  for (std::size_t i = 2; i <= last; ++i)
    sheets.push_back(fmt::format("{}.{}{}", grid.substr(0, dot), i, grid.substr(dot)));
  return sheets;
}

GridWords list_grid_words(const std::vector<records::CellRecord>& cells, const records::GlRecord& gl) {
  const analysis::CostKind kind = analysis::choose_cost(cells);
  const std::map<std::string, std::string> roles = list_roles(cells);
  GridWords words{{}, explain_cost(cells, kind)};
  for (const analysis::Configuration& configuration : analysis::list_configurations(analysis::point_to(cells))) {
    GridWords::OfCell own;
    if (const auto cost = analysis::measure_cost(configuration.cells, kind, analysis::LightMotion::kMoving))
      own.cost = write_cost(cost->mean, kind, gl);
    for (const records::CellRecord* cell : configuration.cells)
      if (const auto role = roles.find(cell->key); role != roles.end()) own.role = role->second;
    for (const records::CellRecord* cell : configuration.cells) words.of_cells[cell->key] = own;
  }
  return words;
}

std::vector<images::Sheet> make_sheets(const std::filesystem::path& dir, const analysis::CellGroup& group,
                                       const GridWords& words) {
  const GridMaker maker(dir, group, words);
  if (!maker.has_images()) return {};
  std::vector<images::Sheet> sheets(list_sheets({}, maker.count()).size());
  for (std::size_t i = 0; i < sheets.size(); ++i) sheets[i] = maker.make(i, sheets.size());
  return sheets;
}

void write_grids(const std::filesystem::path& dir, const std::vector<records::CellRecord>& cells,
                 const records::GlRecord& gl, images::SheetWidth width) {
  const auto has_grid = [](const records::CellRecord& cell) { return cell.images.grid.has_value(); };
  if (std::ranges::none_of(cells, has_grid)) return;
  const GridWords words = list_grid_words(cells, gl);
  const std::vector<analysis::CellGroup> groups = analysis::group_cells(cells);
  tbb::parallel_for_each(groups, [&](const analysis::CellGroup& group) {
    const std::vector<images::Sheet> sheets = make_sheets(dir, group, words);
    if (sheets.empty()) return;
    const std::string& first = *std::ranges::find_if(group.cells, has_grid)->images.grid;
    const auto filters = static_cast<std::size_t>(std::ranges::count_if(group.cells, has_grid));
    const std::vector<std::string> files = list_sheets(first, filters);
    for (std::size_t i = 0; i < sheets.size(); ++i) images::write_sheet(dir / files[i], sheets[i], width);
  });
}

}  // namespace shadowbench::pages
