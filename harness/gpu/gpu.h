#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::gpu {

/// What to do about a GPU that has no description, in words.
inline constexpr const char* kOtherGpus =
    "a browser times any other GPU: open a run's report there, choose 'Time on this GPU' in its section Live, save the "
    "times, and give them to 'advise REPORT --times gpu-times.json'";

/// A public number about a GPU, and where it was published.
struct Constant {
  double value = 0.0;
  std::string source;
};

/// A GPU as `data/gpus/<name>.toml` describes it: whose compiler is asked, and what the estimate takes from data
/// sheets.
struct Gpu {
  std::string name;                   ///< stem of its file
  std::string title;                  ///< for people: "AMD Radeon RX 6900 XT (RDNA 2, 2020)"
  std::vector<std::string> families;  ///< what Mesa's RADV calls its family, the newest name first: "NAVI21"
  Constant simds;                     ///< units that each work on one wave at a time
  Constant clock_mhz;
  Constant texture_units;                          ///< texels of at most 32 bits that are filtered in a clock
  Constant rate_64, rate_128;                      ///< share of that rate for texels of 64 and of 128 bits, 0 .. 1
  Constant triangles_per_clock, pixels_per_clock;  ///< that are rasterised at most, before any shader
  Constant cache_mib;                              ///< the last one before memory
  Constant line_bytes;                             ///< of that cache
  Constant memory_gb_s;
};

/// Calls `visit(key, constant)` for every constant of a GPU.
template <class G, class Visitor>
void visit_constants(G& gpu, Visitor&& visit) {
  visit("simds", gpu.simds);
  visit("clock_mhz", gpu.clock_mhz);
  visit("texture_units", gpu.texture_units);
  visit("rate_64", gpu.rate_64);
  visit("rate_128", gpu.rate_128);
  visit("triangles_per_clock", gpu.triangles_per_clock);
  visit("pixels_per_clock", gpu.pixels_per_clock);
  visit("cache_mib", gpu.cache_mib);
  visit("line_bytes", gpu.line_bytes);
  visit("memory_gb_s", gpu.memory_gb_s);
}

/// Reads one description. Throws Error(kInput) with the file's line for what is missing, unknown, or out of range:
/// rates are above 0 and at most 1, a line has a power of two.
Gpu load_gpu(const std::filesystem::path& file);

/// Reads all of a folder, by name. Throws likewise.
std::vector<Gpu> load_gpus(const std::filesystem::path& folder);

/// Finds GPUs by name, in the order given; "none" alone is none at all.
/// Throws Error(kUsage) for a name that is not there, with those that are.
std::vector<Gpu> choose_gpus(const std::vector<Gpu>& all, const std::vector<std::string>& names);

/// Reads of textures, by the bits of a texel: at most 32, 64 and 128.
struct Reads {
  double of_32 = 0.0;
  double of_64 = 0.0;
  double of_128 = 0.0;

  double total() const { return of_32 + of_64 + of_128; }
};

/// One of the passes that make what a lookup reads.
struct PrefilterWork {
  records::ShaderFacts facts;
  double texels = 0.0;    ///< that it writes, for one map, all draws
  int written_bytes = 0;  ///< of a texel
  int read_bytes = 0;     ///< of a texel of what it reads
};

/// What the depth pass of a map rasterises at least, all layers.
struct MapWork {
  double triangles = 0.0;  ///< that reach into a layer's frustum
  double texels = 0.0;     ///< that are not empty afterwards: each was drawn once or more
};

/// What a filter does, as far as an estimate goes.
struct FilterWork {
  records::ShaderFacts lookup, empty;
  Reads reads;                         ///< of a receiver's lookup, the mean
  std::optional<double> memory_bytes;  ///< that a lookup moves from memory to the cache, the mean
  std::vector<PrefilterWork> prefilter;
  std::vector<PrefilterWork> screen;  ///< its texels are draws: of each pixel
  MapWork map;
};

/// What a filter takes on a GPU, by the model of README.md: each of arithmetic, sampling and memory as if it were
/// alone, and the largest of them as the time, for a million receivers' lookups and for each pass of the prefilter. Of
/// the map's depth pass it is a lower bound: triangles or texels at the rates of the rasterisers, whichever takes
/// longer. No part of it is smaller for a filter that has more of everything.
records::GpuEstimateRecord estimate(const Gpu& gpu, const FilterWork& work);

}  // namespace shadowbench::gpu
