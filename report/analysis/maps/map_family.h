#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "report/analysis/front.h"
#include "report/records/records.h"
#include "report/records/text_table.h"

namespace shadowbench::analysis {

/// A map that a filter was measured with. Times are medians in milliseconds, with the quartiles of the passes, which
/// the family's drift widens.
struct MapUse {
  std::string fit;
  int size = 0;            ///< texels along a side of a layer
  int layers = 1;          ///< as many as its bytes hold: cascades and the faces of a cube have several
  std::int64_t bytes = 0;  ///< all layers
  bool shared = false;     ///< fitted to the scene: it serves every camera, and stays while light and casters do
  Estimate rmse;
  Estimate redraw;        ///< drawing the map, and its prefilter
  Estimate lookup;        ///< for one view
  double empty_ms = 0.0;  ///< a lookup that reads nothing of a map; 0 where it was not timed

  Estimate frame() const;  ///< redraw and lookup
};

/// The maps of one filter, all else being equal: scene, view, picture, depth bias and format.
struct MapFamily {
  std::string name;  ///< filter, and what tells it from the run's other families: "vsm (radius 4)"
  std::string place;
  std::vector<MapUse> maps;  ///< by ascending size
  double drift = 1.0;        ///< slowest over fastest empty lookup over single maps, which should take as long
};

/// Lists the families that have maps of different fits, in the order of the cells. Suspect cells, and those without
/// error or times, are left out; of the maps of one size that no fit changes, such as a lamp's, one is kept.
std::vector<MapFamily> list_map_families(const std::vector<records::CellRecord>& cells);

/// A map of several layers against one large map of as many bytes, as ratios. Signs: -1 the layers have clearly less,
/// 1 clearly more, 0 cannot be told apart.
struct LayerComparison {
  std::size_t layered = 0;  ///< indices into the family's maps
  std::size_t single = 0;
  double error = 0.0;
  double cost = 0.0;  ///< of frames in which the map is drawn
  int error_sign = 0;
  int cost_sign = 0;
};

/// Compares, of each number of bytes, the layers of least RMSE with every single map.
std::vector<LayerComparison> compare_layers(const MapFamily& family);

/// A map for all cameras against a map for each, all of them drawn in every frame.
struct Sharing {
  std::size_t shared = 0;
  std::optional<std::size_t> own;  ///< the cheapest whose RMSE is not clearly larger; nothing where each one's is
  std::optional<int> from_views;   ///< from so many on sharing is clearly cheaper; nothing where it never is
};

/// Judges every shared map.
std::vector<Sharing> find_sharing(const MapFamily& family);

/// A map that follows its camera against one that is kept while light and casters stand still.
struct Caching {
  std::size_t own = 0;
  std::optional<std::size_t> cached;  ///< the smallest whose RMSE is not clearly larger; nothing where each one's is
  double saved_ms = 0.0;              ///< of a frame
  bool pays = false;                  ///< clearly
};

/// Judges every map that follows its camera; nothing where none is shared.
std::vector<Caching> find_caching(const MapFamily& family);

/// Makes a table of the maps of all families, and of what is found of each.
records::TextTable make_map_table(const std::vector<MapFamily>& families, const records::GlRecord& gl);

/// Sums up in a sentence what is found; empty where nothing is.
std::string summarize_maps(const std::vector<MapFamily>& families, const records::GlRecord& gl);

}  // namespace shadowbench::analysis
