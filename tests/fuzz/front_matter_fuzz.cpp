// A filter file: its front matter, and what is told from its GLSL without compiling it.

#include "filters/catalogue.h"
#include "filters/front_matter.h"
#include "tests/fuzz/input.h"

void shadowbench::fuzz::try_input(std::string_view text) {
  const filters::FilterSpec spec = filters::parse_filter(std::string(text), "folder/input.glsl");
  const filters::ParamValues values = filters::default_values(spec);
  filters::radius_texels(spec, values);
  filters::prefilter_radius_texels(spec, values);
}
