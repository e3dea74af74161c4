// One step of a pass of a filter's own. PASS is the name of its function, PASS_TEXEL what that gives.
#include "lib/filter.glsl"

uniform ivec2 pass_size;
uniform int pass_step;
uniform ivec2 pass_direction;
uniform int pass_stride;

layout(location = 0) out PASS_TEXEL out_texel;

void main() { out_texel = PASS(PassInput(ivec2(gl_FragCoord.xy), pass_size, pass_step, pass_direction, pass_stride)); }
