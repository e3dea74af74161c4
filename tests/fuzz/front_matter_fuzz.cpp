// A filter file: its front matter, and what is told from its GLSL without compiling it.

#include "filters/catalogue.h"
#include "filters/front_matter.h"
#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace shadowbench;
  fuzz::allow_refusal([&] {
    const filters::FilterSpec spec = filters::parse_filter(std::string(fuzz::as_text(data, size)), "folder/input.glsl");
    const filters::ParamValues values = filters::default_values(spec);
    filters::radius_texels(spec, values);
    filters::prefilter_radius_texels(spec, values);
  });
  return 0;
}
