#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "filters/catalogue.h"
#include "filters/depth_map.h"
#include "harness/gl/context/context.h"
#include "harness/gpu/gpu.h"
#include "harness/render/bias.h"
#include "harness/scene/lights/light.h"
#include "harness/scene/lights/light_fit.h"
#include "report/images/figure.h"

namespace shadowbench::options {

/// When enough rounds are timed.
struct RoundLimits {
  int fewest = 9;
  int most = 200;
  /// How wide the 95 % interval of a filter's ratio to the reference may be, relative to the ratio.
  double precision = 0.05;
  double budget_ms = 200.0;  ///< of timed work for each filter; what a filter does not need is left to the others

  /// Exactly this many rounds, however precise they are.
  static RoundLimits exactly(int rounds) { return {.fewest = rounds, .most = rounds}; }
  bool is_fixed() const { return fewest == most; }
};

/// Receives how far a run is; the command line shows it.
class Progress {
 public:
  virtual ~Progress() = default;
  /// A run of `cells` cells begins, of which `finished` were finished before.
  virtual void begin(int cells, int finished) = 0;
  /// What is named is under way, `done` cells are finished.
  virtual void show(int done, const std::string& what) = 0;
  /// The user should know this; it is shown once.
  virtual void note(const std::string& message) = 0;
};

/// Hears what is under way.
using StepListener = std::function<void(const std::string& what)>;

/// The folders that come with the program.
struct Resources {
  std::filesystem::path filters;
  std::filesystem::path shaders;
  std::filesystem::path scenes;
  std::filesystem::path experiments;
  std::filesystem::path gpus;
  std::filesystem::path lessons;  ///< a file, which the window alone reads
};

/// Finds the program's folders: below $SHADOWBENCH_ROOT where that is set, else in ../share/shadowbench beside the
/// program where that is, else in the sources that it was built from. Throws Error(kUsage) where one is missing.
Resources find_resources();

/// The folder for traced images: $XDG_CACHE_HOME/shadowbench, else ~/.cache/shadowbench; empty where neither is
/// set. Source: XDG Base Directory Specification 0.8.
std::filesystem::path default_cache_folder();

/// The size of a picture, in pixels.
struct PictureSize {
  int width = 960;
  int height = 540;
  bool operator==(const PictureSize&) const = default;
};

/// What visibility is held against; pictures are held against the second of the two.
enum class TruthWeight {
  kArea,    ///< the share of the light's area, of a sphere's solid angle, that is seen: what filters define
  kCosine,  ///< the share of the light that would arrive unshadowed: what a renderer multiplies its shading by
};
constexpr auto names_of(TruthWeight) { return std::array{"area", "cosine"}; }

/// What a run leaves of the cells that it does.
enum class Product {
  kReport,    ///< a folder of its own, and a report once all of them are there
  kImages,    ///< a worker's: records and float images, which the run that started it scores and draws
  kPrograms,  ///< a worker's: nothing, but that the filters compile
};

/// The part of an experiment that a run does.
struct Part {
  Product product = Product::kReport;
  int shard = 1;  ///< every `shards`-th cell, from the `shard`-th on
  int shards = 1;

  bool is_worker() const { return product == Product::kImages || product == Product::kPrograms; }
};

/// The most places of the map's grid, and the most frames, that a run may take means over.
inline constexpr int kMostAveraged = 64;

/// All options of `shadowbench run`; the other commands that draw use some of them.
struct RunOptions {
  Resources resources;
  std::vector<std::string> scenes;  ///< names or paths
  bool ground = false;
  std::vector<filters::FilterRequest> filters;
  std::vector<std::string> filter_files;  ///< of the user, as they were named
  std::string kernel_width;  ///< of filters that were told none: see filters::set_widths(); empty: their own
  std::vector<int> map_sizes = {1024};
  bool equal_bytes = false;               ///< layers of a map share the texels that one map of that size has
  std::vector<PictureSize> sizes = {{}};  ///< of all pictures of a run
  int width = 960;                        ///< of the pictures that are drawn at present, in pixels
  int height = 540;
  std::vector<std::string> views;        ///< names of cameras; none: all that each scene has
  std::vector<std::string> light_names;  ///< of scenes that have several; none: all
  render::MapSettings map;
  std::vector<scene::FitRule> fits = {{}};  ///< of all maps of a run
  scene::FitRule fit;                       ///< of the maps that are drawn at present
  bool snap = false;                        ///< keep the map's texel grid fixed in the world
  std::optional<scene::SkyAngles> light;    ///< in place of the light of every scene
  render::BiasRule bias;
  filters::RangeRule range;          ///< outside the map, beyond its far plane, behind the light
  bool border_page = false;          ///< also draw every rule for what lies outside the map, side by side
  std::optional<double> pad_texels;  ///< around the scene in the map; empty: as many as the widest kernel needs
  RoundLimits rounds;
  int phases = 8;                    ///< places of the map's grid over which errors are averaged
  int frames = 1;                    ///< also accumulate visibility over so many
  std::vector<gpu::Gpu> gpus;        ///< also estimate costs on these, which need not be there
  filters::FilterRequest reference;  ///< the filter that the others' times are ratios to
  std::uint32_t seed = 1;
  gl::Backend backend = gl::Backend::kAuto;
  bool truth = true;  ///< trace rays, and score every filter against them
  TruthWeight truth_weight = TruthWeight::kArea;
  bool attribution = true;   ///< split the errors into their four parts; needs truth
  bool stability = false;    ///< find where numbers break, per texel and per pixel
  bool uncertainty = false;  ///< keep how far rounding and other seeds can move each pixel
  bool all_parts = false;    ///< keep pictures, parts of errors, receivers and the map as floats, too
  bool grids = true;  ///< compare all filters of a view in one picture and keep their float images; else each cell's
                      ///< pictures alone
  images::SheetWidth grid_width;
  bool pictures = true;  ///< draw what people look at beside the float images, which the window asks for alone
  Part part;
  std::string title;             ///< of the experiment
  bool fresh = false;            ///< measure again the cells that the report folder has
  bool large_is_fine = false;    ///< start even where there are very many cells
  std::filesystem::path cache;   ///< keeps traced images between runs; empty: nothing is kept
  double cell_timeout_s = 60.0;  ///< how long one filter of the user may take on one scene
  std::filesystem::path out;
  bool force = false;                   ///< write into `out` even where it holds what this program did not write
  std::vector<std::string> command;     ///< the command line, for the record
  std::vector<std::string> bias_texts;  ///< as given
  std::vector<std::string> notes;       ///< what the user should know about the options
};

}  // namespace shadowbench::options
