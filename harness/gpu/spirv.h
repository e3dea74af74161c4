#pragma once

#include <cstdint>
#include <vector>

#include "harness/gl/shader_source.h"

namespace shadowbench::gpu {

/// What a shader binds at a place of its only descriptor set.
struct Binding {
  std::uint32_t place = 0;
  bool is_texture = false;  ///< else a block of uniforms
};

/// A shader stage as Vulkan takes it.
struct SpirvShader {
  std::vector<std::uint32_t> words;
  std::vector<Binding> bindings;
};

enum class ShaderStage { kVertex, kFragment };

/// Compiles the GLSL that OpenGL is given for Vulkan 1.3, with loose uniforms put into a block.
/// Throws Error(kFilter) with file and line for what Vulkan's rules refuse.
SpirvShader compile_spirv(const gl::ShaderSource& source, ShaderStage stage);

}  // namespace shadowbench::gpu
