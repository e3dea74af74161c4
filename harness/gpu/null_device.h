#pragma once

#include <memory>
#include <string>

#include "harness/gl/program.h"
#include "report/records/records.h"

namespace shadowbench::gpu {

/// A GPU that Mesa's RADV compiles for without having it: its pipelines are real, and nothing can be drawn.
class NullDevice {
 public:
  /// `family` is what RADV_FORCE_FAMILY takes; sets it in this process's environment.
  /// Throws Error(kContext) where there is no Vulkan loader, no RADV, or no such family.
  explicit NullDevice(const std::string& family);
  ~NullDevice();

  /// Names the driver and its version: results of another one may differ.
  const std::string& driver() const;

  /// Compiles a full-screen pass that draws into a texture of an OpenGL format, "r32f".
  /// Throws Error(kFilter) with file and line for GLSL that Vulkan's rules refuse, Error(kContext) where the driver
  /// refuses the pipeline. A driver may also crash: call this in a process that can be spared.
  records::ShaderFacts compile(const gl::ShaderSource& fragment, const std::string& format);

 private:
  struct Vulkan;
  std::unique_ptr<Vulkan> vulkan_;
};

}  // namespace shadowbench::gpu
