#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "harness/gpu/gpu.h"
#include "report/records/records.h"

namespace shadowbench::gpu {

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
