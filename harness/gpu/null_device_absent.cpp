// Stands in for null_device.cpp where SHADOWBENCH_WITH_GPU_ESTIMATES is off, or its libraries were not found.
#include "base/error.h"
#include "harness/gpu/null_device.h"

namespace shadowbench::gpu {

struct NullDevice::Vulkan {
  std::string driver;
};

NullDevice::NullDevice(const std::string&) {
  throw Error(ErrorKind::kContext,
              "this build has no compiler for GPUs; install glslang-dev, glslang-tools, libvulkan-dev and spirv-tools, "
              "and configure it again");
}
NullDevice::~NullDevice() = default;
const std::string& NullDevice::driver() const { return vulkan_->driver; }
records::ShaderFacts NullDevice::compile(const gl::ShaderSource&, const std::string&) { return {}; }

}  // namespace shadowbench::gpu
