#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/text.h"
#include "filters/depth_map.h"
#include "filters/filter_spec.h"
#include "reference/metrics/metric_table.h"

namespace shadowbench::records {

using filters::ParamValue, filters::RangeRule, shadowbench::name_of;
using metrics::ArtefactRecord, metrics::AttributionPart, metrics::AttributionRecord, metrics::CostRecord,
    metrics::CoverageRecord, metrics::ErrorRecord, metrics::MapScaleRecord, metrics::StabilityRecord,
    metrics::TruthRecord;
using ParamMap = filters::ParamValues;

/// Version of results.json and of the cell files; a reader refuses any other.
inline constexpr int kSchemaVersion = 4;

/// The spread of `n` repeated measurements.
struct Quartiles {
  double median = 0.0;
  double q1 = 0.0;
  double q3 = 0.0;
  int n = 0;
};

/// A confidence interval.
struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// The spread of per-round differences with the 95 % interval of their median.
struct OwnTime : Quartiles {
  Interval ci95;
};

/// The median of per-round ratios with its 95 % interval.
struct Ratio {
  double median = 0.0;
  Interval ci95;
};

/// How a cell ended. Suspect: its filter was drawn, and what it drew or read shows that it is wrong.
enum class CellStatus { kOk, kSuspect, kTimeout, kCrashed, kError };
constexpr auto names_of(CellStatus) { return std::array{"ok", "suspect", "timeout", "crashed", "error"}; }

/// A length along the light in three units, whose parts add up.
struct BiasAmount {
  double depth = 0.0;   ///< [0,1] over the light's range
  double texels = 0.0;  ///< in widths of a shadow-map texel
  double world = 0.0;   ///< metres
};

/// What is drawn into the depth map instead of the surfaces that light meets first.
struct MapBias {
  double polygon_factor = 0.0;  ///< glPolygonOffset: times the larger depth slope
  double polygon_units = 0.0;   ///< glPolygonOffset: times the format's smallest step
  bool cull_front = false;      ///< leave out faces that face the light, of meshes that allow it
  bool midpoint = false;        ///< half-way between the first and the second surface

  bool operator==(const MapBias&) const = default;
};

/// The depth bias that every filter of the run was given, as it was asked for. The parts add up.
struct BiasRecord {
  BiasAmount constant;
  BiasAmount slope;             ///< times 1 - n.l; the larger of this and `constant` holds
  double plane_texels = 0.0;    ///< depth change of the receiver's plane over this many shadow-map texels
  double plane_kernels = 0.0;   ///< the same change, in units of filters::bias_reach_texels()
  BiasAmount normal_offset;     ///< receiver moved along its normal; `depth` is not used
  bool receiver_plane = false;  ///< the plane's gradient is added for every tap
  MapBias map;
};

/// What a cell's passes cost in time, in milliseconds of the clock that the run names.
struct TimeRecord {
  std::optional<Quartiles> map;
  std::optional<Quartiles> prefilter;
  std::optional<Quartiles> lookup;                 ///< screen passes included
  std::optional<Quartiles> screen = std::nullopt;  ///< of it these
  std::optional<Quartiles> empty = std::nullopt;   ///< a lookup that reads what the filter does of its receivers, alone
  std::optional<OwnTime> static_light = std::nullopt;  ///< lookup less empty: the filter's own
  std::optional<OwnTime> moving = std::nullopt;  ///< map, prefilter and the filter's own: what a moving light pays
  std::optional<std::string> stopped =
      std::nullopt;  ///< why no more rounds were timed: "rounds", "precise" or "budget"
};

/// Per-round ratios to the filter `none`; `none` itself carries 1 [1, 1].
struct RatioRecord {
  std::optional<Ratio> lookup;
  std::optional<Ratio> static_light;  ///< map and prefilter cached: lookup alone is paid
  std::optional<Ratio> moving;        ///< map, prefilter and lookup are paid in every frame
};

/// What a cascade shows: the receivers of which it serves the most, and how wrong they are.
struct CascadeRecord {
  double end_m = 0.0;                      ///< depth along the camera's axis at which it ends
  double texels_per_m = 0.0;               ///< of its map
  std::optional<double> texels_per_pixel;  ///< median over its receivers
  double share = 0.0;                      ///< of all receivers
  std::optional<double> rmse;              ///< these four are empty where too few receivers could tell
  std::optional<double> acne;
  std::optional<double> leak;
  std::optional<double> contact_gap;
};

/// A part of a picture, pixels.
struct TileRecord {
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;
  bool operator==(const TileRecord&) const = default;
};

/// Paths relative to the report folder, with '/' between folders.
struct ImagesRecord {
  std::optional<std::string> picture;
  std::optional<std::string> visibility;
  std::optional<std::string> depth_map;                     ///< one per scene and map settings
  std::optional<std::string> grid;                          ///< one per scene, view and map settings
  std::optional<std::string> exr;                           ///< one per scene
  std::optional<std::string> texel_density = std::nullopt;  ///< texels per pixel; one per scene, view and map settings
  std::optional<std::string> all_lights = std::nullopt;     ///< one per scene of several lights, view and map settings
  std::optional<std::string> stability = std::nullopt;      ///< where the cell's numbers break, per texel and per pixel
  std::optional<std::string> values = std::nullopt;         ///< visibility, error parts and FLIP, for the page's viewer
  std::optional<std::string> truth_picture = std::nullopt;  ///< one per scene and view
  std::optional<std::string> truth_values = std::nullopt;   ///< of the same: visibility, its standard error, the mask
  std::optional<std::string> frames = std::nullopt;  ///< how cells that were drawn together are drawn, for the page
  std::optional<std::string> parts = std::nullopt;   ///< no path, but how the names of the cell's parts in `exr` begin
  std::optional<TileRecord> hardest = std::nullopt;  ///< where the picture's FLIP is largest
  /// Of what the page shows first, both with several samples a pixel: the picture, and that of the truth.
  std::optional<std::string> supersampled = std::nullopt;
  std::optional<std::string> truth_supersampled = std::nullopt;
  std::optional<std::int64_t> samples = std::nullopt;  ///< of each of their pixels
};

/// How wide the filter's kernel is.
struct KernelRecord {
  std::optional<double> sigma_texels;        ///< standard deviation along an axis, reconstruction included
  std::optional<std::string> width_class;    ///< of filters::list_width_names()
  std::optional<std::string> by_light = {};  ///< the parameter whose value the light's width gave; empty: none has it
  std::optional<double> light_texels = {};   ///< the standard deviation that the scene's light asks for in this map
};

/// What a GPU's compiler says of one shader. Nothing here is measured; counts are of the machine code, in which the
/// body of a loop stands once. Source: the Vulkan extension VK_KHR_pipeline_executable_properties.
struct ShaderFacts {
  int instructions = 0;
  int code_bytes = 0;
  int vector_registers = 0;   ///< of each lane
  int scalar_registers = 0;   ///< of each wave
  int spilled_registers = 0;  ///< that live in memory for want of room
  int scratch_bytes = 0;      ///< of that memory, of each wave
  int waves_per_simd = 0;     ///< that fit at once, as the driver counts them
  int latency_cycles = 0;     ///< of one wave alone, loops guessed at
  int busy_cycles = 0;        ///< of a SIMD for one wave of 64 among others: the inverse throughput, loops guessed at
  int samples = 0;            ///< reads with a sampler
  int compares = 0;           ///< reads with a sampler that compares
  int gathers = 0;            ///< reads of four texels at once, with or without comparison
  int loads = 0;              ///< reads of a texel without a sampler
  int loops = 0;

  /// Reads of textures, of all four kinds.
  int reads() const { return samples + compares + gathers + loads; }

  bool operator==(const ShaderFacts&) const = default;
};

/// One pass of a filter.
struct GpuPassRecord {
  std::string pass;  ///< "lookup", "empty", "encode", "blur", or the name of a pass of the filter's own
  int draws = 1;     ///< how often it is drawn for one map
  ShaderFacts facts;
};

/// Microseconds that a written model makes of the facts; frame_ms() makes the cost of them. See harness/gpu/README.md.
struct GpuEstimateRecord {
  double lookup_us = 0.0;                          ///< of a million receivers, less the empty lookup's arithmetic
  double prefilter_us = 0.0;                       ///< of the map, each of its passes
  double map_us = 0.0;                             ///< a lower bound of drawing the map, all layers
  double arithmetic_us = 0.0, sampling_us = 0.0;   ///< of the lookup: the largest of these three is its time
  std::optional<double> memory_us = std::nullopt;  ///< nothing where the reads of the filter are not known
  std::string bound_by = {};                       ///< what takes longest: "arithmetic", "sampling" or "memory"
};

/// What one filter costs on one GPU that need not be there.
struct GpuRecord {
  std::vector<GpuPassRecord> facts;  ///< empty where `refused` says why
  std::optional<GpuEstimateRecord> estimate = std::nullopt;
  std::string refused;  ///< empty where there are facts
};

/// By the GPU's name.
using GpuRecords = std::map<std::string, GpuRecord>;

/// Which clock the times come from.
enum class TimerKind { kWallClock, kTimerQuery };
constexpr auto names_of(TimerKind) { return std::array{"wall_clock", "timer_query"}; }

/// The kind of machine that a cell was measured on. Times of two kinds are never compared.
struct MachineKind {
  std::string cpu;
  int cores = 0;
  std::string renderer;  ///< GL_RENDERER
  bool software = true;  ///< a rasteriser on the CPU
  TimerKind timer = TimerKind::kWallClock;

  bool operator==(const MachineKind&) const = default;
};

/// What is said of a row that another renderer drew, and whether it shows the same view. Its errors are those of the
/// one picture that was given; everything else is absent.
struct ExternalRecord {
  std::optional<std::string> engine;  ///< its name and version, driver, map, bias and fit, as its user says
  std::optional<std::string> version;
  std::optional<std::string> driver;
  std::optional<std::string> map;
  std::optional<std::string> bias;
  std::optional<std::string> fit;
  std::optional<double> ms;                ///< what it cost, as its user says
  std::optional<std::string> timed;        ///< how that was timed
  std::string truth;                       ///< names the scene, light, camera and size that it was scored against
  std::int64_t undefined = 0;              ///< receivers that have no visibility: left out
  std::optional<double> inside_rmse;       ///< over receivers that lie beside no silhouette
  std::string aligned_by = "nothing";      ///< "depth", "coverage": what the shift was found from
  std::optional<double> shift_x, shift_y;  ///< pixels, of its picture to the right and down
  std::optional<double> shift_p99;         ///< 99th percentile over pixels of how far the two are apart
  bool unaligned = false;                  ///< the pictures do not show the same, and it was scored all the same
  std::optional<std::string> nearest;      ///< the filter of this run whose picture is nearest
  std::optional<double> nearest_rmse;      ///< between the two pictures
  std::map<std::string, double> peers;     ///< RMSE of the run's filters in the one picture of the first phase
};

/// How visibility fares that is accumulated over frames by one rule, in a view that stands still.
struct ResolveRecord {
  std::string rule;                          ///< "newest", "mean", "exponential" or "clamped"
  bool jitter = false;                       ///< the camera moved by parts of a pixel
  std::vector<double> rmse;                  ///< after each frame, against the truth
  std::optional<std::vector<double>> noise;  ///< after each frame, against what very many frames converge to
  std::optional<double> flicker;             ///< root mean square of its change from frame to frame, in the second half
};

/// How long a shadow lags behind that moved.
struct GhostRecord {
  double texels = 0.0;              ///< that it moved by in each frame
  std::string rule;                 ///< as ResolveRecord's
  std::int64_t pixels = 0;          ///< behind its edges
  std::optional<double> at_stop;    ///< mean error of these pixels in the last frame of the motion; nothing without any
  std::optional<int> frames_until;  ///< that the shadow then stood still, until it was within kGhostLimit of the truth
};
inline constexpr double kGhostLimit = 0.02;

/// What accumulation over frames makes of a filter.
struct AccumulationRecord {
  std::vector<ResolveRecord> resolves;
  std::vector<GhostRecord> ghosts;
  std::string no_ghosts;        ///< why there are none; empty where there are
  double exponential_ms = 0.0;  ///< of the pass that accumulates, which is in no other time
  double clamped_ms = 0.0;
  std::optional<std::string> picture;  ///< of all cells of the view, relative to the report folder
};

/// Everything measured of one scene x view x filter x parameters x map settings.
///
/// What does not exist stays empty, and `absent` says why: dotted field name, or the name of a whole group
/// ("error"), to reason. A null that nobody explained is written as "not measured".
struct CellRecord : metrics::MetricValues {
  std::string key;      ///< cell_key() of the settings below
  std::string content;  ///< names what made the cell beside its settings: program, scene, filter, options
  std::optional<MachineKind> machine;  ///< what measured it; empty where nothing did
  std::optional<double> measured_s;  ///< seconds that measuring it took: its share of what cells did together, without
                                     ///< the truth, which others use too
  CellStatus status = CellStatus::kOk;
  std::string message;                  ///< why `status` is not ok; empty otherwise
  std::vector<std::string> suspect_of;  ///< what is wrong with the filter, and what to do; empty unless it is suspect
  std::string scene;
  std::string view;
  std::string filter;
  ParamMap params;
  std::optional<double> kernel_radius_texels;  ///< half-width of the kernel, which follows from `params`
  KernelRecord kernel = {};
  bool teaching = false;            ///< the filter is for teaching: it is not advised
  std::vector<std::string> claims;  ///< what the filter says of itself, such as "contact-hardening"
  int map_size = 0;                 ///< texels along a side
  std::string map_format;           ///< "d32f", "d16 reversed hashed"
  std::string fit = "tight";    ///< how the light's frustum is fitted: "sphere", "tight" or "view", perhaps " snapped"
  std::string light = "scene";  ///< where the light stands: as the scene says, or "AZIMUTH,ELEVATION" in degrees
  BiasRecord bias;
  RangeRule range;
  int width = 0;  ///< pixels
  int height = 0;
  std::optional<double> screen_reads;   ///< pixels that screen passes read for a receiver, mean
  std::optional<std::int64_t> excused;  ///< pixels left out: on a tie or a texel's border
  std::optional<std::int64_t>
      phases;  ///< places of the map's grid that the errors of visibility are means over; all else is of the first
  std::optional<Interval> rmse_ci95;  ///< of `error.rmse` over the phases
  std::optional<std::vector<double>>
      rmse_replicates;                   ///< means of the RMSE over groups of phases that are independent of each other
  std::optional<Interval> flicker_ci95;  ///< of `error.flicker` over the phases
  TimeRecord time_ms;
  RatioRecord ratio_to_none;
  std::optional<std::vector<CascadeRecord>> cascades;  ///< from near to far; empty without cascades, or a truth
  std::optional<AccumulationRecord> accumulation;      ///< over frames
  std::optional<GpuRecords> gpu;                       ///< what the cell costs on GPUs that were not there
  std::optional<ExternalRecord> external;              ///< of a row that another renderer drew
  ImagesRecord images;
  std::vector<std::string> warnings;  ///< for people: what makes this cell's numbers doubtful
  std::map<std::string, std::string> absent;
  std::vector<std::string> nothing_to_see;  ///< those of `absent` whose fault cannot occur in the view
};

/// Whether the cell's filter was drawn to the end, be it suspect or not.
inline bool is_drawn(const CellRecord& cell) {
  return cell.status == CellStatus::kOk || cell.status == CellStatus::kSuspect;
}

/// Whether advice and fronts are about the cell: not where its filter shows a mistake, or another renderer drew it.
inline bool is_advised(const CellRecord& cell) { return !cell.teaching && !cell.external; }

/// The OpenGL that drew the pictures.
struct GlRecord {
  std::string backend;   ///< "osmesa", "egl", "glfw"
  std::string renderer;  ///< GL_RENDERER
  std::string version;   ///< GL_VERSION
  bool software = true;  ///< a rasteriser on the CPU
  TimerKind timer = TimerKind::kWallClock;
};

/// The machine and the build.
struct MachineRecord {
  std::string cpu;
  int cores = 0;
  std::optional<double> load_at_start;  ///< one-minute load average
  std::string compiler;
  std::string os;
};

/// The kind of a machine and its OpenGL.
inline MachineKind kind_of(const MachineRecord& machine, const GlRecord& gl) {
  return {machine.cpu, machine.cores, gl.renderer, gl.software, gl.timer};
}

/// Counts the work that was done, and the work that no chosen filter needed.
struct WorkRecord {
  std::int64_t shader_variants_compiled = 0;
  std::int64_t passes_run = 0;
  std::int64_t passes_skipped = 0;
  std::int64_t truths_traced = 0;  ///< ray-traced images computed in this run
  std::int64_t truths_cached = 0;  ///< ray-traced images read from the cache
  double timed_s = 0.0;            ///< seconds that the timed passes took, with the rounds that warm up
  double elapsed_s = 0.0;          ///< seconds from the first cell to the last, without the report
  std::optional<double> attribution_s = std::nullopt;  ///< seconds of `elapsed_s` that the attribution took
};

/// Names a scene for people.
struct SceneRecord {
  std::string name;
  std::string title;
  std::vector<std::string> view_words = {};  ///< what opens it in the window, as it was given; empty: not known
};

/// Which cells of which experiment a run holds.
struct ExperimentRecord {
  std::string title;
  std::string settings;  ///< names all cells of the experiment and what they are made from
  int cells = 0;         ///< number of cells of the whole experiment
  int shard = 1;         ///< 1 .. shards: every `shards`-th cell, from this one on
  int shards = 1;
};

/// What is common to all cells of a run.
struct RunRecord {
  std::string commit;
  std::vector<std::string> command;  ///< the command line, one entry per argument
  std::uint64_t seed = 0;
  GlRecord gl;
  MachineRecord machine;
  WorkRecord work;
  ExperimentRecord experiment;
  std::vector<SceneRecord> scenes;
  std::map<std::string, std::optional<std::string>> filter_files = {};  ///< of the user, by id; empty: not known
  std::vector<std::string> warnings;
};

/// Why a value is absent.
struct Absence {
  std::string why;
  bool nothing_to_see = false;  ///< its fault cannot occur in the view: that is not a value that nobody measured
};

/// Says why a field, or a group of them, is absent.
inline void explain(CellRecord& cell, const std::string& field, const Absence& absence) {
  cell.absent[field] = absence.why;
  if (absence.nothing_to_see) cell.nothing_to_see.push_back(field);
}

/// Whether the fault that a field measures cannot occur in the cell's view.
inline bool has_nothing_to_see(const CellRecord& cell, std::string field) {
  for (;; field.resize(field.rfind('.'))) {
    if (cell.absent.contains(field)) return std::ranges::count(cell.nothing_to_see, field) > 0;
    if (field.find('.') == std::string::npos) return false;
  }
}

/// Why a cell lacks a value: what `absent` holds for the field, for a group that it is in, or for a part of it;
/// "not measured" where it holds nothing.
inline std::string explain_absence(const CellRecord& cell, const std::string& field) {
  for (std::string name = field;; name.resize(name.rfind('.'))) {
    if (const auto found = cell.absent.find(name); found != cell.absent.end()) return found->second;
    if (name.find('.') == std::string::npos) break;
  }
  const auto part = cell.absent.lower_bound(field + ".");
  return part != cell.absent.end() && part->first.starts_with(field + ".") ? part->second : "not measured";
}

/// The frame that a cost on a GPU is of: each of its pixels is a receiver that is looked up.
inline constexpr int kGpuFrameWidth = 1920, kGpuFrameHeight = 1080;

/// By which factor estimates missed published times at most; harness/gpu/README.md has them side by side.
inline constexpr double kEstimateFactor = 1.6;

/// Milliseconds that the lookups of such a frame take of what a million receivers take, microseconds.
inline constexpr double lookups_ms(double million_us) {
  return million_us * (1e-6 * kGpuFrameWidth * kGpuFrameHeight) * 1e-3;
}

/// What such a frame costs by an estimate, milliseconds: its lookups, and where light or casters move the prefilter of
/// one map and a lower bound of drawing it. What every lookup pays is in no estimate.
inline double frame_ms(const GpuEstimateRecord& estimate, bool is_moving) {
  return lookups_ms(estimate.lookup_us) + (is_moving ? 1e-3 * (estimate.prefilter_us + estimate.map_us) : 0.0);
}

}  // namespace shadowbench::records
