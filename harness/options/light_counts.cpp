#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/error.h"
#include "filters/store_format.h"
#include "harness/gl/pixel_format.h"
#include "harness/options/run_options.h"

namespace shadowbench::options {
namespace {

constexpr std::int64_t kMebibyte = 1 << 20;

std::int64_t count_texel_bytes(const RunOptions& options) {
  std::int64_t bytes = gl::pixel_format(options.map.format).bytes_per_texel * (options.bias.map.midpoint ? 3 : 1);
  std::set<std::string> formats;
  for (const filters::FilterRequest& request : options.filters)
    if (request.spec.has_encode) formats.insert(filters::text_or(request.values, "store", ""));
  for (const filters::FilterRequest& request : options.filters)
    for (const filters::PassSpec& pass : request.spec.passes)
      bytes += std::max<std::int64_t>(1, filters::store_bytes(pass.store) / (pass.half ? 4 : 1));
  for (const std::string& format : formats) bytes += filters::store_bytes(format);
  return bytes;
}

}  // namespace

std::int64_t count_light_map_bytes(const RunOptions& options, int lights, int map_size) {
  return count_texel_bytes(options) * lights * map_size * map_size;
}

void require_light_maps_fit(const RunOptions& options) {
  if (options.lights.empty()) return;
  const int lights = *std::max_element(options.lights.begin(), options.lights.end());
  const int map_size = *std::max_element(options.map_sizes.begin(), options.map_sizes.end());
  const std::int64_t bytes = count_light_map_bytes(options, lights, map_size);
  if (bytes <= kMostLightMapBytes) return;
  throw Error(ErrorKind::kUsage, fmt::format("--lights: the maps of {} lights at --map-size {} take {} MiB, more than "
                                             "the {} MiB there may be; choose fewer lights, "
                                             "smaller maps, or filters that store less",
                                             lights, map_size, bytes / kMebibyte, kMostLightMapBytes / kMebibyte));
}

}  // namespace shadowbench::options
