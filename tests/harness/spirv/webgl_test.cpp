// GLSL of the program, translated for browsers.

#include "harness/spirv/spirv.h"
#include "tests/test_files.h"

namespace shadowbench::spirv {
namespace {

std::string translate(const std::string& body, Stage stage = Stage::kFragment) {
  return translate_to_webgl({"#version 450 core\n" + body, {}}, stage);
}

TEST(WebGl, UniformsAndOutputsKeepTheirNames_AndBindingsGo) {
  const std::string text = translate(
      "layout(binding = 3) uniform sampler2D map_stored;\nuniform mat4 clip;\nlayout(location = 0) out vec4 "
      "out_color;\n"
      "void main() { out_color = clip * texelFetch(map_stored, ivec2(gl_FragCoord.xy), 0); }\n");
  EXPECT_THAT(text, StartsWith("#version 300 es\nprecision highp float;"));
  EXPECT_THAT(text, HasSubstr("uniform highp sampler2D map_stored;"));
  EXPECT_THAT(text, HasSubstr("uniform mat4 clip;"));
  EXPECT_THAT(text, HasSubstr("layout(location = 0) out vec4 out_color;"));
  EXPECT_THAT(text, Not(HasSubstr("binding")));
}

TEST(WebGl, ClipSpaceIsThatOfWebGl) {
  const std::string text = translate("in vec3 p;\nvoid main() { gl_Position = vec4(p, 1.0); }\n", Stage::kVertex);
  EXPECT_THAT(text, HasSubstr("gl_Position.z = 2.0 * gl_Position.z - gl_Position.w;"));
}

TEST(WebGl, TheTextSeesThatItIsForABrowser) {
  const std::string body =
      "layout(location = 0) out float o;\n#ifdef WEBGL\nvoid main() { o = 0.25; }\n#else\nvoid main() { o = 0.5; }\n"
      "#endif\n";
  EXPECT_THAT(translate(body), HasSubstr("0.25"));
}

TEST(WebGl, WhatItLacksIsNamed) {
  EXPECT_THAT(error_of([] {
                translate(
                    "layout(binding = 0) uniform sampler2D map;\nlayout(location = 0) out vec4 o;\n"
                    "void main() { o = textureGather(map, vec2(0.5)); }\n");
              }),
              is_error(ErrorKind::kFilter, "WebGL 2", "textureGather"));
}

TEST(WebGl, WhatItLacks_DoesNoHarm_WhereAConstantKeepsItFromBeingReached) {
  const std::string text = translate(
      "layout(binding = 0) uniform sampler2D map;\nlayout(location = 0) out vec4 o;\nconst int read = 0;\n"
      "vec4 look() {\n  if (read != 2) return texelFetch(map, ivec2(0), 0);\n"
      "  return textureGather(map, vec2(0.5));\n}\nvoid main() { o = look(); }\n");
  EXPECT_THAT(text, HasSubstr("texelFetch"));
}

TEST(WebGl, AMistakeIsRefused) { EXPECT_THROW(translate("void main() { nothing; }\n"), Error); }

}  // namespace
}  // namespace shadowbench::spirv
