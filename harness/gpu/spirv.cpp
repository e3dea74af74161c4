#include "harness/gpu/spirv.h"

#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include "filters/base/error.h"
#include "harness/gl/shader_source.h"

namespace shadowbench::gpu {
namespace {

/// glslang's tables, for as long as the process lives.
void start_glslang() {
  static const struct Started {
    Started() { glslang::InitializeProcess(); }
    ~Started() { glslang::FinalizeProcess(); }
  } kStarted;
}

[[noreturn]] void fail(const char* log, const std::vector<std::string>& files) {
  const gl::ShaderLog translated = gl::translate_log(log, files);
  throw Error(ErrorKind::kFilter, "Vulkan refuses this GLSL: " + translated.message, translated.where);
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

SpirvShader compile_spirv(const gl::ShaderSource& source, ShaderStage stage) {
  start_glslang();
  const EShLanguage language = stage == ShaderStage::kVertex ? EShLangVertex : EShLangFragment;
  glslang::TShader shader(language);
  const char* text = source.text.data();
  const auto length = static_cast<int>(source.text.size());
  shader.setStringsWithLengths(&text, &length, 1);
  shader.setEnvInput(glslang::EShSourceGlsl, language, glslang::EShClientVulkan, 100);
  shader.setEnvInputVulkanRulesRelaxed();
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
  shader.setAutoMapBindings(true);
  shader.setAutoMapLocations(true);
  if (!shader.parse(GetDefaultResources(), 450, false, EShMsgDefault)) fail(shader.getInfoLog(), source.files);
  glslang::TProgram program;
  program.addShader(&shader);
  if (!program.link(EShMsgDefault) || !program.mapIO() || !program.buildReflection(EShReflectionSeparateBuffers))
    fail(program.getInfoLog(), source.files);
  SpirvShader compiled;
  glslang::GlslangToSpv(*program.getIntermediate(language), compiled.words);
  compiled.bindings = list_bindings(program);
  return compiled;
}

}  // namespace shadowbench::gpu
