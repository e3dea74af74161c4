#include "harness/measure/traffic_meter.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <list>
#include <map>
#include <memory>

#include "filters/map_reader.h"
#include "harness/gl/objects.h"
#include "harness/measure/scene_assets.h"
#include "report/records/records.h"

namespace shadowbench::measure {
namespace {

constexpr int kTileSideLog2 = 3;
constexpr std::size_t kTilePixels = 1 << (2 * kTileSideLog2);
constexpr std::size_t kIdleReceivers = 8, kIdleReads = 128;  // in a row, that bring no new line

/// Numbers the lines that the texels of maps lie in.
class LineNumbers {
 public:
  explicit LineNumbers(int line_bytes) : line_bytes_(line_bytes) {
    assert(std::has_single_bit(static_cast<unsigned>(line_bytes)));
  }

  std::size_t find(const filters::TexelRead& read) {
    if (maps_.empty() || maps_[last_].memory != read.map) last_ = find_map(*read.map);
    const Map& map = maps_[last_];
    const auto texel = static_cast<std::uint32_t>(read.texel);
    const std::uint32_t row = texel / map.size, column = texel % map.size;
    return map.first_line + (row >> map.height_log2) * map.lines_per_row + (column >> map.width_log2);
  }

  /// How many the maps have that were read so far.
  std::size_t count() const { return count_; }

 private:
  struct Map {
    const filters::MapMemory* memory = nullptr;
    std::uint32_t size = 0;
    int width_log2 = 0, height_log2 = 0;  ///< of a line, texels
    std::size_t lines_per_row = 0, first_line = 0;
  };

  int line_bytes_;
  std::vector<Map> maps_;
  std::size_t last_ = 0, count_ = 0;

  std::size_t find_map(const filters::MapMemory& memory) {
    const auto found = static_cast<std::size_t>(std::ranges::find(maps_, &memory, &Map::memory) - maps_.begin());
    if (found == maps_.size()) add(memory);
    return found;
  }

  void add(const filters::MapMemory& memory) {
    assert(memory.texel_bytes > 0 && memory.texel_bytes <= line_bytes_);
    const int texels_log2 = std::bit_width(static_cast<unsigned>(line_bytes_ / memory.texel_bytes)) - 1;
    Map map{&memory, static_cast<std::uint32_t>(memory.size), (texels_log2 + 1) / 2, texels_log2 / 2, 0, count_};
    map.lines_per_row = ((map.size - 1) >> map.width_log2) + 1;
    count_ += map.lines_per_row * (((map.size - 1) >> map.height_log2) + 1);
    maps_.push_back(map);
  }
};

class Cache {
 public:
  explicit Cache(const CacheShape& shape) : shape_(shape) {}

  void read(std::size_t line) {
    if (line >= places_.size()) places_.resize(line + 1, lines_.end());
    if (places_[line] != lines_.end()) return lines_.splice(lines_.begin(), lines_, places_[line]);
    fetched_bytes_ += shape_.line_bytes;
    lines_.push_front(line);
    places_[line] = lines_.begin();
    if (static_cast<std::int64_t>(lines_.size()) * shape_.line_bytes <= shape_.bytes) return;
    places_[lines_.back()] = lines_.end();
    lines_.pop_back();
  }

  int line_bytes() const { return shape_.line_bytes; }
  std::int64_t fetched_bytes() const { return fetched_bytes_; }

 private:
  CacheShape shape_;
  std::list<std::size_t> lines_;                          ///< that it holds, the latest read first
  std::vector<std::list<std::size_t>::iterator> places_;  ///< of all lines; the end where it does not hold one
  std::int64_t fetched_bytes_ = 0;
};

/// Caches whose lines are of one size.
class CacheGroup {
 public:
  explicit CacheGroup(int line_bytes) : numbers_(line_bytes) {}

  void add(Cache& cache) { caches_.push_back(&cache); }
  void begin_tile() { ++tile_; }

  /// Reads the lines that the tile did not read before; says whether there were any.
  bool read_new_lines(const std::vector<filters::TexelRead>& reads) {
    bool are_new = false;
    for (const filters::TexelRead& read : reads) {
      const std::size_t line = numbers_.find(read);
      if (line >= last_tiles_.size()) last_tiles_.resize(numbers_.count());
      if (last_tiles_[line] == tile_) continue;
      last_tiles_[line] = tile_;
      are_new = true;
      for (Cache* cache : caches_) cache->read(line);
    }
    return are_new;
  }

 private:
  LineNumbers numbers_;
  std::vector<Cache*> caches_;
  std::vector<std::uint32_t> last_tiles_;  ///< that read a line, by line; 0: none
  std::uint32_t tile_ = 0;
};

/// Where a pixel comes in an order in which any first few pixels of a tile are spread over it: ordered dithering's.
std::size_t find_rank(const glm::ivec2& pixel) {
  int rank = 0;
  for (int bit = 0; bit < kTileSideLog2; ++bit)
    rank = 4 * rank + 2 * ((pixel.x ^ pixel.y) >> bit & 1) + (pixel.y >> bit & 1);
  return static_cast<std::size_t>(rank);
}

/// How many tiles hold so many pixels along an axis.
int count_tiles(int pixels) { return ((pixels - 1) >> kTileSideLog2) + 1; }

/// A layer of a map, and its receivers in tiles: row by row from the top, by rank within a tile.
struct TiledLayer {
  std::unique_ptr<filters::Lookup> lookup;
  std::vector<const filters::Receiver*> receivers;  ///< as many for each tile as it has pixels; null: none

  TiledLayer(std::unique_ptr<filters::Lookup> made, const std::vector<filters::Receiver>& from, int width, int height)
      : lookup(std::move(made)) {
    const int columns = count_tiles(width);
    receivers.resize(static_cast<std::size_t>(columns * count_tiles(height)) * kTilePixels);
    for (const filters::Receiver& receiver : from) {
      const int row = (height - 1 - receiver.pixel.y) >> kTileSideLog2, column = receiver.pixel.x >> kTileSideLog2;
      receivers[static_cast<std::size_t>(row * columns + column) * kTilePixels + find_rank(receiver.pixel)] = &receiver;
    }
  }

  std::span<const filters::Receiver* const> tile(std::size_t index) const {
    return std::span(receivers).subspan(index * kTilePixels, kTilePixels);
  }
};

/// All caches, and the log of the reads that go through them.
class Traffic {
 public:
  explicit Traffic(std::span<const CacheShape> shapes) : caches_(shapes.begin(), shapes.end()) {
    for (Cache& cache : caches_) groups_.try_emplace(cache.line_bytes(), cache.line_bytes()).first->second.add(cache);
  }

  void begin_tile() {
    for (auto& [line_bytes, group] : groups_) group.begin_tile();
  }

  /// Asks the receivers of a tile until they bring nothing new.
  void ask(const filters::Lookup& lookup, std::span<const filters::Receiver* const> receivers) {
    std::size_t idle_receivers = 0, idle_reads = 0;
    for (const filters::Receiver* receiver : receivers) {
      if (!receiver) continue;
      log_.clear();
      lookup.at(*receiver);
      const bool are_new = read_new_lines();
      idle_receivers = are_new ? 0 : idle_receivers + 1;
      idle_reads = are_new ? 0 : idle_reads + log_.reads().size();
      if (idle_receivers >= kIdleReceivers && idle_reads >= kIdleReads) return;
    }
  }

  std::vector<double> share_bytes(std::size_t receivers) const {
    std::vector<double> shares;
    for (const Cache& cache : caches_)
      shares.push_back(static_cast<double>(cache.fetched_bytes()) / static_cast<double>(receivers));
    return shares;
  }

 private:
  std::vector<Cache> caches_;
  std::map<int, CacheGroup> groups_;  ///< by the bytes of a line
  filters::ReadLog log_;

  bool read_new_lines() {
    bool are_new = false;
    for (auto& [line_bytes, group] : groups_)
      if (group.read_new_lines(log_.reads())) are_new = true;
    return are_new;
  }
};

/// Reads what a lookup of so many reads may have read.
class CountedLookup final : public filters::Lookup {
 public:
  CountedLookup(const CountedLayer& layer, int columns)
      : grids_{make_grid(layer.map, layer.map.texel_bytes), make_grid(layer.map, 8), make_grid(layer.map, 16)},
        pixels_(layer.pixels),
        columns_(columns) {}

  filters::ModelResult at(const filters::Receiver& receiver) const override {
    const PixelReads& reads = pixels_[static_cast<std::size_t>(receiver.pixel.y * columns_ + receiver.pixel.x)];
    for (std::size_t i = 0; i < grids_.size(); ++i) spread(grids_[i], receiver, reads.fetches[i], reads.reach_texels);
    return {};
  }

 private:
  using Grid = filters::TexelGrid<float>;
  std::array<Grid, 3> grids_;
  const std::vector<PixelReads>& pixels_;
  int columns_;

  static Grid make_grid(const filters::DepthMap& map, int texel_bytes) {
    return Grid(map.size, map.border, texel_bytes);
  }

  static void spread(const Grid& grid, const filters::Receiver& receiver, int count, double reach_texels) {
    const int side = static_cast<int>(std::ceil(std::sqrt(count)));
    const double half = side > 1 ? std::max(reach_texels - 1.0, 0.0) : 0.0,
                 step = side > 1 ? 2.0 * half / (side - 1) : 0.0;
    const glm::dvec2 corner = glm::dvec2(receiver.uv) * static_cast<double>(grid.size()) - half - 0.5;
    for (int i = 0; i < count; ++i) {
      const glm::ivec2 low(glm::floor(corner + step * glm::dvec2(i % side, i / side)));
      for (const int y : {0, 1})
        for (const int x : {0, 1}) grid.read(low.x + x, low.y + y);
    }
  }
};

/// Counts what the lookups that `make_lookup` makes of layers read. Nothing without a receiver.
template <class Layer, class MakeLookup>
std::optional<std::vector<double>> count_traffic(const std::vector<Layer>& layers, const ModelView& view,
                                                 std::span<const CacheShape> caches, const MakeLookup& make_lookup) {
  std::vector<TiledLayer> tiled;
  std::size_t receivers = 0;
  for (const Layer& layer : layers) {
    if (layer.receivers.empty()) continue;
    tiled.emplace_back(make_lookup(layer), layer.receivers, view.width, view.height);
    receivers += layer.receivers.size();
  }
  if (receivers == 0) return std::nullopt;
  Traffic traffic(caches);
  for (std::size_t tile = 0; tile < tiled.front().receivers.size() / kTilePixels; ++tile) {
    traffic.begin_tile();
    for (const TiledLayer& layer : tiled) traffic.ask(*layer.lookup, layer.tile(tile));
  }
  return traffic.share_bytes(receivers);
}

constexpr int kFrameRows = records::kGpuFrameHeight;
constexpr double kMostTexels = 1.5;  ///< of the map, under a pixel of half the rows: more, and lines are missed

/// Every how many rows and columns of the frame are asked.
int choose_step(const options::RunOptions& options, std::optional<double> texels_per_pixel) {
  const double rows = static_cast<double>(options.height) / (kFrameRows / 2);
  return texels_per_pixel && *texels_per_pixel * rows * rows <= kMostTexels ? 2 : 1;
}

int count_columns(const options::RunOptions& options, int rows) {
  return static_cast<int>(std::lround(static_cast<double>(rows) * options.width / options.height));
}

}  // namespace

std::optional<std::vector<double>> count_map_traffic(const filters::FilterRequest& request,
                                                     const std::vector<ModelLayer>& layers, const ModelView& view,
                                                     std::span<const CacheShape> caches) {
  const filters::ScalarModel* model = filters::find_model(request.spec);
  if (!model) return std::nullopt;
  return count_traffic(layers, view, caches, [&](const ModelLayer& layer) {
    return model->prepare(view.input(request, layer.map), filters::Precision::kFloat);
  });
}

std::optional<std::vector<double>> count_map_traffic(const std::vector<CountedLayer>& layers, const ModelView& view,
                                                     std::span<const CacheShape> caches) {
  return count_traffic(
      layers, view, caches,
      [&](const CountedLayer& layer) { return std::make_unique<CountedLookup>(layer, view.width); });
}

TrafficMeter::TrafficMeter(const TaskRig& rig, std::optional<double> texels_per_pixel)
    : rig_(rig),
      light_(rig.light()),
      step_(choose_step(rig.options, texels_per_pixel)),
      gbuffer_(count_columns(rig.options, kFrameRows / step_), kFrameRows / step_) {
  rig.assets.draw_view(gbuffer_, *rig.task.camera);
  for (const gpu::Gpu& gpu : rig_.options.gpus)
    caches_.push_back({.bytes = static_cast<std::int64_t>(gpu.cache_mib.value * 1024.0 * 1024.0),
                       .line_bytes = static_cast<int>(gpu.line_bytes.value)});
  for (const scene::LightFrustum& layer : light_.layers) layers_.push_back({light_.map.read(layer.layer), {}});
}

void TrafficMeter::measure(MeasuredCell& cell) {
  if (cell.passes.empty()) return;
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const scene::LightFrustum& layer = light_.layers[i];
    const render::Bias bias = render::resolve_bias(rig_.options.bias, layer, cell.request.spec, cell.request.values);
    layers_[i].receivers = render::read_receivers(
        rig_.renderer.shaders, gbuffer_,
        render::make_light_setup(layer, rig_.task.scene->light, bias, rig_.options.seed, rig_.options.range));
  }
  const ModelView view{gbuffer_.width(), gbuffer_.height(), rig_.options.seed, rig_.options.bias.plane_max_tangent()};
  auto bytes = filters::find_model(cell.request.spec) ? count_map_traffic(cell.request, layers_, view, caches_)
               : cell.cost.fetches                    ? count_map_traffic(count_reads(cell), view, caches_)
                                                      : std::nullopt;
  if (!bytes) return;
  for (double& each : *bytes) each /= step_ * step_;
  cell.fetched_bytes = std::move(*bytes);
}

std::vector<CountedLayer> TrafficMeter::count_reads(const MeasuredCell& cell) {
  const gl::Recorder::Pause pause(rig_.renderer.recorder.get());
  const auto passes = rig_.make_passes(cell.request);
  passes->prefilter(light_.map);
  std::vector<CountedLayer> layers;
  for (const render::CountedReads& counted : passes->count_reads(gbuffer_, light_.map)) {
    const ModelLayer& own = layers_[layers.size()];
    CountedLayer& layer = layers.emplace_back(CountedLayer{own.map, own.receivers, {}});
    if (passes->encoded_format()) layer.map.texel_bytes = gl::pixel_format(*passes->encoded_format()).bytes_per_texel;
    for (std::size_t i = 0; i < counted.reads.size() / 4; ++i) {
      const int of_64 = static_cast<int>(counted.wide[2 * i]), of_128 = static_cast<int>(counted.wide[2 * i + 1]);
      const int all = std::max(static_cast<int>(counted.reads[4 * i]), 0);
      layer.pixels.push_back({{all - of_64 - of_128, of_64, of_128},
                              static_cast<double>(counted.reads[4 * i + 1]) - passes->blurred_reach()});
    }
  }
  return layers;
}

}  // namespace shadowbench::measure
