#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace shadowbench::records {

/// Version of results.json and of the cell files; a reader refuses any other.
inline constexpr int kSchemaVersion = 2;

/// Holds the spread of repeated measurements; `n` of them.
struct Quartiles {
  double median = 0.0;
  double q1 = 0.0;
  double q3 = 0.0;
  int n = 0;
};

/// Holds a confidence interval.
struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// Holds the median of per-round ratios with its 95 % bootstrap interval.
struct Ratio {
  double median = 0.0;
  Interval ci95;
};

/// Says how a cell ended.
enum class CellStatus { kOk, kTimeout, kCrashed, kError };

/// Holds one parameter's value.
using ParamValue = std::variant<double, std::string, bool>;
using ParamMap = std::map<std::string, ParamValue>;

/// Holds a length along the light in three units, whose parts add up.
struct BiasAmountRecord {
  double depth = 0.0;   ///< [0,1] over the light's range
  double texels = 0.0;  ///< as long as so many shadow-map texels are wide
  double world = 0.0;   ///< metres
};

/// Holds the depth bias that every filter of the run was given, as it was asked for.
struct BiasRecord {
  BiasAmountRecord constant;
  BiasAmountRecord slope;          ///< times 1 - n.l; the larger of this and `constant` holds
  double plane_texels = 0.0;       ///< depth change of the receiver's plane over this many shadow-map texels
  double plane_kernels = 0.0;      ///< the same, in units of the filter's kernel half-width plus one texel
  BiasAmountRecord normal_offset;  ///< receiver moved along its normal; `depth` is 0
  bool receiver_plane = false;     ///< the plane's gradient is added for every tap
  double polygon_factor = 0.0;     ///< glPolygonOffset in the depth pass
  double polygon_units = 0.0;
  bool front_cull = false;  ///< faces towards the light are not drawn into the map
  bool midpoint = false;    ///< the map lies half-way between the first and the second surface
};

/// Holds what the units of lengths along the light are worth in a map.
struct MapScaleRecord {
  std::optional<double> texel_m;        ///< side of a texel, metres
  std::optional<double> depth_range_m;  ///< between depth 0 and depth 1, metres
};

/// Holds what lookups did outside the map; the defaults are right, everything else shows an artefact.
struct RangeRecord {
  std::string border = "border";  ///< outside the map: border (lit), edge or repeat
  bool far_test = true;           ///< beyond the far plane is lit
  bool behind_test = true;        ///< behind the light of a projective map is lit
};

/// Holds what a cell's passes cost in time, in milliseconds of the clock that the run names.
struct TimeRecord {
  std::optional<Quartiles> map;
  std::optional<Quartiles> prefilter;
  std::optional<Quartiles> lookup;
  std::optional<std::string> stopped =
      std::nullopt;  ///< why no more rounds were timed: "rounds", "precise" or "budget"
};

/// Holds per-round ratios to the filter `none`; `none` itself carries 1 [1, 1].
struct RatioRecord {
  std::optional<Ratio> lookup;
  std::optional<Ratio> static_map;  ///< map and prefilter cached: lookup alone is paid
  std::optional<Ratio> moving;      ///< map, prefilter and lookup are paid in every frame
};

/// Holds what a frame lit by several lights costs, each with a shadow map of its own; milliseconds of the clock that
/// the run names.
struct LightCountRecord {
  int count = 0;        ///< lights: the scene's, turned about the vertical by i * 360 / count degrees
  Quartiles still_ms;   ///< maps and prefilters cached: a lookup per light
  Quartiles moving_ms;  ///< a depth map, a prefilter and a lookup per light
  Ratio still_ratio;    ///< per-round ratios to the filter `none` under as many lights
  Ratio moving_ratio;
  std::int64_t maps_bytes = 0;  ///< of the maps that the lookups read
};

/// Holds the costs that do not depend on the machine.
struct CostRecord {
  std::optional<double> fetches;  ///< mean texture fetches per receiver
  std::optional<std::int64_t> bytes_per_texel;
  std::optional<std::int64_t> passes;
  std::optional<std::int64_t> map_bytes;
  std::optional<std::int64_t> prefilter_texels;
};

/// Holds the error against the truth, in visibility.
struct ErrorRecord {
  std::optional<double> rmse;
  std::optional<double> mae;
  std::optional<double> p95;
  std::optional<double> max;
  std::optional<double> mean;  ///< signed
  std::optional<double> flip;
  std::optional<double> kernel_rmse;  ///< against the truth seen through the filter's own kernel
};

/// Says how sure the truth itself is.
struct TruthRecord {
  std::optional<double> se;
  std::optional<double> unanimous;
};

/// Holds the rates of the faults a person sees, each a share of some receivers, in [0,1].
struct ArtefactRecord {
  std::optional<double> acne;         ///< of the wholly lit receivers (the area light, and the guard square around the
                                      ///< receiver in the map), those darker than the limit
  std::optional<double> leak;         ///< of those wholly blocked by something not near, those brighter than the limit
  std::optional<double> contact_gap;  ///< of those blocked by a surface near them, those brighter than the limit
  std::optional<double> noise;        ///< of those in the filter's penumbra, those off the local mean by the limit
};

/// Holds one part of the error.
struct AttributionPart {
  std::optional<double> rms;    ///< root mean square, in visibility
  std::optional<double> share;  ///< mean(error * part) / mean(error^2): all shares sum to 1, and may be negative
};

/// Holds the four parts that the error is the sum of.
struct AttributionRecord {
  AttributionPart numeric;
  AttributionPart estimator;
  AttributionPart discretisation;
  AttributionPart model;
};

/// Says where a cell's numbers break, or come near to it.
struct StabilityRecord {
  std::optional<std::int64_t> overflow_texels;           ///< of the encoded map, or that the blur mixed one into
  std::optional<std::int64_t> nan_texels;                ///< of the encoded map, NaN
  std::optional<std::int64_t> negative_variance_texels;  ///< of a map of moments, before any clamp
  std::optional<double> lowest_variance;                 ///< of a map of moments, before any clamp
  std::optional<double>
      headroom;  ///< ln(largest number of the store) - ln(largest stored): what exponents could grow by
  std::optional<double>
      safe_exponent;  ///< largest value of the filter's exponent with which no texel of this map overflows
  std::optional<double> half_difference_max;  ///< of visibility, 16-bit store less 32-bit store: largest magnitude
  std::optional<double> half_difference_rms;
  std::optional<double> bound_shortfall_max;           ///< by how much a bound is darker than what it bounds
  std::optional<std::int64_t> bound_violations;        ///< receivers where it is by more than rounding explains
  std::optional<std::int64_t> bound_exact_violations;  ///< receivers where it is in double precision, too
};

/// Says how well the map's texels are spent on the view; over receivers: pixels whose surface faces the light.
struct CoverageRecord {
  std::optional<double> texels_per_pixel;         ///< map texels under a pixel's footprint on its surface: the median
  std::optional<double> fewest_texels_per_pixel;  ///< the same of the worst pixel
  std::optional<double> map_used;                 ///< share of the map's area on which a pixel's footprint falls
  std::optional<double> map_filled;               ///< share of the map's texels that hold a caster
};

/// Holds paths relative to the report folder, with '/' between folders.
struct ImagesRecord {
  std::optional<std::string> picture;
  std::optional<std::string> visibility;
  std::optional<std::string> depth_map;                     ///< one per scene and map settings
  std::optional<std::string> grid;                          ///< one per scene, view and map settings
  std::optional<std::string> exr;                           ///< one per scene
  std::optional<std::string> attribution = std::nullopt;    ///< the error and its four parts, as heat maps
  std::optional<std::string> texel_density = std::nullopt;  ///< texels per pixel; one per scene, view and map settings
  std::optional<std::string> texel_grid = std::nullopt;     ///< the map's texels on the surfaces; one per the same
  std::optional<std::string> stability = std::nullopt;      ///< where the cell's numbers break, per texel and per pixel
  std::optional<std::string> parts = std::nullopt;  ///< no path: what the names of the cell's parts in `exr` begin with
};

/// Holds everything measured of one scene x view x filter x parameters x map settings.
///
/// What does not exist stays empty, and `absent` says why: dotted field name, or the name of a whole group
/// ("error"), to reason. A null that nobody explained is written as "not measured".
struct CellRecord {
  std::string key;      ///< cell_key() of the settings below
  std::string content;  ///< names what it was made from beside its settings: program, OpenGL, scene, filter, options
  CellStatus status = CellStatus::kOk;
  std::string message;  ///< why `status` is not ok; empty otherwise
  std::string scene;
  std::string view;
  std::string filter;
  ParamMap params;
  std::optional<double> kernel_radius_texels;      ///< half-width of the kernel; no setting, it follows from `params`
  std::optional<std::vector<std::string>> claims;  ///< what the filter says of itself, such as "contact-hardening"
  int map_size = 0;                                ///< texels along a side
  std::string map_format;                          ///< "d32f", "d16 reversed"
  std::string fit = "tight";    ///< of the light's frustum: "sphere", "tight" or "view"; with " snapped" behind it
  std::string light = "scene";  ///< where the light stands: as the scene says, or "AZIMUTH,ELEVATION" in degrees
  BiasRecord bias;
  MapScaleRecord map_scale;
  RangeRecord range;
  int width = 0;  ///< pixels
  int height = 0;
  std::optional<std::int64_t> receivers;  ///< pixels that count
  std::optional<std::int64_t> excused;    ///< pixels left out: on a tie or a texel's border
  std::optional<std::int64_t> nan;        ///< pixels whose visibility is not finite
  TimeRecord time_ms;
  RatioRecord ratio_to_none;
  std::optional<std::vector<LightCountRecord>> lights;  ///< by ascending count
  CostRecord cost;
  ErrorRecord error;
  TruthRecord truth;
  CoverageRecord coverage;
  ArtefactRecord artefact;
  AttributionRecord attribution;
  StabilityRecord stability;
  ImagesRecord images;
  std::vector<std::string> warnings;  ///< for people: what makes this cell's numbers doubtful
  std::map<std::string, std::string> absent;
};

/// Says which clock the times come from.
enum class TimerKind { kWallClock, kTimerQuery };

/// Describes the OpenGL that drew the pictures.
struct GlRecord {
  std::string backend;   ///< "osmesa", "egl", "glfw"
  std::string renderer;  ///< GL_RENDERER
  std::string version;   ///< GL_VERSION
  bool software = true;  ///< a rasteriser on the CPU
  TimerKind timer = TimerKind::kWallClock;
};

/// Describes the machine and the build.
struct MachineRecord {
  std::string cpu;
  int cores = 0;
  std::optional<double> load_at_start;  ///< one-minute load average
  std::string compiler;
  std::string os;
};

/// Counts the work that was done, and the work that no chosen filter needed.
struct WorkRecord {
  std::int64_t shader_variants_compiled = 0;
  std::int64_t passes_run = 0;
  std::int64_t passes_skipped = 0;
  std::int64_t truths_traced = 0;  ///< ray-traced images computed in this run
  std::int64_t truths_cached = 0;  ///< ray-traced images read from the cache
  double timed_s = 0.0;            ///< of the passes that were timed, rounds that warm up included; seconds
  double elapsed_s = 0.0;          ///< from the first cell to the last, the report not included; seconds
  std::optional<double> attribution_s = std::nullopt;  ///< of `elapsed_s`, what taking errors apart took; seconds
};

/// Says how the times of a run compare with those of the run that it replaced, which was told the very same.
struct RepeatRecord {
  std::optional<std::int64_t> cells;        ///< that both have
  std::optional<std::int64_t> overlapping;  ///< ratios to `none` whose 95 % intervals overlap
  std::optional<std::int64_t> of;           ///< so many
};

/// Names a scene for people.
struct SceneRecord {
  std::string name;
  std::string title;
};

/// Says which cells of which experiment a run holds.
struct ExperimentRecord {
  std::string title;
  std::string settings;  ///< names all cells of the experiment and what they are made from
  int cells = 0;         ///< of the whole experiment
  int shard = 1;         ///< 1 .. shards: every `shards`-th cell, from this one on
  int shards = 1;
};

/// Holds what is common to all cells of a run.
struct RunRecord {
  std::string commit;
  std::vector<std::string> command;  ///< the command line, one entry per argument
  std::uint64_t seed = 0;
  GlRecord gl;
  MachineRecord machine;
  WorkRecord work;
  ExperimentRecord experiment;
  RepeatRecord repeat = {};
  std::vector<SceneRecord> scenes;
  std::vector<std::string> warnings;
};

}  // namespace shadowbench::records
