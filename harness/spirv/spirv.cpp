#include "harness/spirv/spirv.h"

#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include "base/error.h"
#include "harness/gl/program.h"

namespace shadowbench::spirv {
namespace {

/// glslang's tables, for as long as the process lives.
void start_glslang() {
  static const struct Started {
    Started() { glslang::InitializeProcess(); }
    ~Started() { glslang::FinalizeProcess(); }
  } kStarted;
}

[[noreturn]] void refuse(const char* log, const std::vector<std::string>& files, Rules rules) {
  const gl::ShaderLog translated = gl::translate_log(log, files);
  throw Error(
      ErrorKind::kFilter,
      fmt::format("{} refuses this GLSL: {}", rules == Rules::kVulkan ? "Vulkan" : "SPIR-V", translated.message),
      translated.where);
}

void set_rules(glslang::TShader& shader, EShLanguage language, Rules rules) {
  if (rules == Rules::kVulkan) {
    shader.setEnvInput(glslang::EShSourceGlsl, language, glslang::EShClientVulkan, 100);
    shader.setEnvInputVulkanRulesRelaxed();
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
  } else {
    shader.setEnvInput(glslang::EShSourceGlsl, language, glslang::EShClientOpenGL, 100);
    shader.setEnvClient(glslang::EShClientOpenGL, glslang::EShTargetOpenGL_450);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_0);
  }
  shader.setAutoMapBindings(true);
  shader.setAutoMapLocations(true);
}

std::vector<Binding> list_bindings(glslang::TProgram& program) {
  std::vector<Binding> bindings;
  for (int i = 0; i < program.getNumUniformVariables(); ++i) {
    const glslang::TObjectReflection& uniform = program.getUniform(i);
    // What lies in no block is a sampler: the relaxed rules have put all other uniforms into one.
    if (uniform.index < 0) bindings.push_back({static_cast<std::uint32_t>(uniform.getBinding()), true});
  }
  for (int i = 0; i < program.getNumUniformBlocks(); ++i)
    bindings.push_back({static_cast<std::uint32_t>(program.getUniformBlock(i).getBinding()), false});
  return bindings;
}

}  // namespace

Shader compile(const gl::ShaderSource& source, Stage stage, Rules rules) {
  start_glslang();
  const EShLanguage language = stage == Stage::kVertex ? EShLangVertex : EShLangFragment;
  glslang::TShader shader(language);
  const char* text = source.text.data();
  const auto length = static_cast<int>(source.text.size());
  shader.setStringsWithLengths(&text, &length, 1);
  set_rules(shader, language, rules);
  if (!shader.parse(GetDefaultResources(), 450, false, EShMsgDefault)) refuse(shader.getInfoLog(), source.files, rules);
  glslang::TProgram program;
  program.addShader(&shader);
  if (!program.link(EShMsgDefault) || !program.mapIO() || !program.buildReflection(EShReflectionSeparateBuffers))
    refuse(program.getInfoLog(), source.files, rules);
  Shader compiled;
  glslang::GlslangToSpv(*program.getIntermediate(language), compiled.words);
  if (rules == Rules::kVulkan) compiled.bindings = list_bindings(program);
  return compiled;
}

}  // namespace shadowbench::spirv
