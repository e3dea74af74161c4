#include <gmock/gmock.h>

#include "base/error.h"
#include "harness/options/run_options.h"

namespace shadowbench::options {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

RunOptions make_options(const std::string& filters) {
  RunOptions options;
  options.resources = find_resources();
  options.filters = filters::Catalogue(options.resources.filters).parse_requests(filters);
  return options;
}

std::string message_of(const RunOptions& options) {
  try {
    require_light_maps_fit(options);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kUsage);
    return error.what();
  }
  return "fits";
}

TEST(LightMaps, TakeADepthMapPerLight_AndAnEncodedMapPerLightAndFormat) {
  constexpr std::int64_t kTexels = 8 * 100 * 100;
  EXPECT_EQ(count_light_map_bytes(make_options("none,poisson,pcf2x2"), 8, 100), 4 * kTexels);
  EXPECT_EQ(count_light_map_bytes(make_options("none,vsm"), 8, 100), (4 + 8) * kTexels);
  EXPECT_EQ(count_light_map_bytes(make_options("vsm:radius=1,vsm:radius=2"), 8, 100), (4 + 8) * kTexels)
      << "they take turns";
  EXPECT_EQ(count_light_map_bytes(make_options("vsm,vsm:store=rg16f,esm"), 8, 100), (4 + 8 + 4 + 4) * kTexels);
  RunOptions options = make_options("none");
  options.map.format = GL_DEPTH_COMPONENT16;
  EXPECT_EQ(count_light_map_bytes(options, 8, 100), 2 * kTexels);
  options.bias.map.midpoint = true;
  EXPECT_EQ(count_light_map_bytes(options, 8, 100), 6 * kTexels);
}

TEST(LightMaps, ThatTakeTooMuch_AreRefused_WithTheNumbers) {
  RunOptions options = make_options("none");
  options.map_sizes = {256, 4096};
  EXPECT_EQ(message_of(options), "fits");
  options.lights = {1, 16};
  EXPECT_EQ(message_of(options), "fits") << "exactly 1 GiB";
  options.filters = make_options("none,esm").filters;
  EXPECT_THAT(message_of(options), AllOf(HasSubstr("--lights"), HasSubstr("16 lights at --map-size 4096 take 2048 MiB"),
                                         HasSubstr("1024 MiB"), HasSubstr("fewer lights")));
}

}  // namespace
}  // namespace shadowbench::options
