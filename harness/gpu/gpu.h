#pragma once

#include <filesystem>
#include <string>
#include <vector>

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

}  // namespace shadowbench::gpu
