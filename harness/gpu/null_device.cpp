#include "harness/gpu/null_device.h"

#include "base/error.h"

#ifdef SHADOWBENCH_HAS_GPU_ESTIMATES
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <vulkan/vulkan_raii.hpp>

#include "harness/gl/program.h"
#include "harness/gpu/facts_request.h"
#include "harness/spirv/spirv.h"

namespace shadowbench::gpu {
namespace {

constexpr const char* kExtension = VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;

[[noreturn]] void fail(const std::string& message) { throw Error(ErrorKind::kContext, message); }

vk::Format find_format(std::string_view name) {
  using enum vk::Format;
  constexpr std::array<std::pair<std::string_view, vk::Format>, 15> kFormats = {{{"r8", eR8Unorm},
                                                                                 {"rg8", eR8G8Unorm},
                                                                                 {"rgba8", eR8G8B8A8Unorm},
                                                                                 {"r16", eR16Unorm},
                                                                                 {"rg16", eR16G16Unorm},
                                                                                 {"rgba16", eR16G16B16A16Unorm},
                                                                                 {"r16f", eR16Sfloat},
                                                                                 {"rg16f", eR16G16Sfloat},
                                                                                 {"rgba16f", eR16G16B16A16Sfloat},
                                                                                 {"r32f", eR32Sfloat},
                                                                                 {"rg32f", eR32G32Sfloat},
                                                                                 {"rgba32f", eR32G32B32A32Sfloat},
                                                                                 {"r32ui", eR32Uint},
                                                                                 {"rg32ui", eR32G32Uint},
                                                                                 {"rgba32ui", eR32G32B32A32Uint}}};
  for (const auto& [known, format] : kFormats)
    if (known == name) return format;
  throw std::logic_error(fmt::format("no Vulkan format goes with '{}'", name));
}

vk::raii::Instance make_instance(vk::raii::Context& context) {
  const vk::ApplicationInfo application("shadowbench", 1, nullptr, 0, VK_API_VERSION_1_3);
  return {context, vk::InstanceCreateInfo({}, &application)};
}

/// RADV's device, by its driver: the loader may list others.
vk::raii::PhysicalDevice find_device(const vk::raii::Instance& instance, const std::string& family) {
  for (vk::raii::PhysicalDevice& device : vk::raii::PhysicalDevices(instance))
    if (device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties>()
            .get<vk::PhysicalDeviceDriverProperties>()
            .driverID == vk::DriverId::eMesaRadv)
      return std::move(device);
  fail(fmt::format("no Vulkan driver compiles for '{}': install mesa-vulkan-drivers, or choose another --gpu", family));
}

vk::raii::Device make_device(const vk::raii::PhysicalDevice& physical) {
  bool has_extension = false;
  for (const auto& each : physical.enumerateDeviceExtensionProperties())
    has_extension = has_extension || std::string_view(each.extensionName.data()) == kExtension;
  if (!has_extension) fail(fmt::format("the Vulkan driver does not tell what it compiles: it has no {}", kExtension));
  constexpr float kPriority = 1.0f;
  const vk::DeviceQueueCreateInfo queue({}, 0, 1, &kPriority);
  vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR executables(VK_TRUE);
  vk::PhysicalDeviceVulkan13Features features;
  features.dynamicRendering = VK_TRUE;
  features.pNext = &executables;
  vk::DeviceCreateInfo info({}, queue, {}, kExtension);
  info.pNext = &features;
  return {physical, info};
}

vk::raii::DescriptorSetLayout make_layout(const vk::raii::Device& device, const std::vector<spirv::Binding>& bindings) {
  std::vector<vk::DescriptorSetLayoutBinding> places;
  for (const spirv::Binding& each : bindings)
    places.emplace_back(
        each.place, each.is_texture ? vk::DescriptorType::eCombinedImageSampler : vk::DescriptorType::eUniformBuffer, 1,
        vk::ShaderStageFlagBits::eFragment);
  return {device, vk::DescriptorSetLayoutCreateInfo({}, places)};
}

vk::raii::Pipeline make_pipeline(const vk::raii::Device& device, const vk::raii::PipelineLayout& layout,
                                 const spirv::Shader& vertex, const spirv::Shader& fragment, vk::Format format) {
  const vk::raii::ShaderModule vertex_module(device, vk::ShaderModuleCreateInfo({}, vertex.words));
  const vk::raii::ShaderModule fragment_module(device, vk::ShaderModuleCreateInfo({}, fragment.words));
  const std::array stages = {
      vk::PipelineShaderStageCreateInfo({}, vk::ShaderStageFlagBits::eVertex, *vertex_module, "main"),
      vk::PipelineShaderStageCreateInfo({}, vk::ShaderStageFlagBits::eFragment, *fragment_module, "main")};
  const vk::PipelineVertexInputStateCreateInfo no_vertices;
  const vk::PipelineInputAssemblyStateCreateInfo triangles({}, vk::PrimitiveTopology::eTriangleList);
  const vk::PipelineViewportStateCreateInfo viewport({}, 1, nullptr, 1, nullptr);
  vk::PipelineRasterizationStateCreateInfo rasterization;
  rasterization.lineWidth = 1.0f;
  const vk::PipelineMultisampleStateCreateInfo one_sample;
  vk::PipelineColorBlendAttachmentState colors;
  using enum vk::ColorComponentFlagBits;
  colors.colorWriteMask = eR | eG | eB | eA;
  const vk::PipelineColorBlendStateCreateInfo blend({}, VK_FALSE, vk::LogicOp::eCopy, colors);
  const vk::PipelineDepthStencilStateCreateInfo no_depth;
  const std::array dynamic = {vk::DynamicState::eViewport, vk::DynamicState::eScissor};
  const vk::PipelineDynamicStateCreateInfo dynamic_state({}, dynamic);
  const vk::PipelineRenderingCreateInfo target(0, format);
  using Flags = vk::PipelineCreateFlagBits;
  vk::GraphicsPipelineCreateInfo info(Flags::eCaptureStatisticsKHR | Flags::eCaptureInternalRepresentationsKHR, stages,
                                      &no_vertices, &triangles, nullptr, &viewport, &rasterization, &one_sample,
                                      &no_depth, &blend, &dynamic_state, *layout);
  info.pNext = &target;
  return {device, nullptr, info};
}

/// Reads what the driver calls its numbers. Requires that it gives all of them.
void read_statistics(const vk::raii::Device& device, const vk::PipelineExecutableInfoKHR& executable,
                     records::ShaderFacts& facts) {
  int spilled_scalars = 0, spilled_vectors = 0;
  std::vector<std::pair<std::string_view, int*>> wanted = {
      {"Instructions", &facts.instructions},  {"Code size", &facts.code_bytes},
      {"VGPRs", &facts.vector_registers},     {"SGPRs", &facts.scalar_registers},
      {"Spilled SGPRs", &spilled_scalars},    {"Spilled VGPRs", &spilled_vectors},
      {"Scratch size", &facts.scratch_bytes}, {"Subgroups per SIMD", &facts.waves_per_simd},
      {"Latency", &facts.latency_cycles},     {"Inverse Throughput", &facts.busy_cycles}};
  for (const auto& statistic : device.getPipelineExecutableStatisticsKHR(executable)) {
    const auto found =
        std::ranges::find(wanted, std::string_view(statistic.name.data()), &std::pair<std::string_view, int*>::first);
    if (found == wanted.end()) continue;
    *found->second = static_cast<int>(statistic.value.u64);
    wanted.erase(found);
  }
  if (!wanted.empty()) fail(fmt::format("the Vulkan driver does not tell '{}' of a shader", wanted.front().first));
  facts.spilled_registers = spilled_scalars + spilled_vectors;
}

/// The listing of the machine code, the last of the driver's texts that ends as every program does. Of GCN 1 and 2 it
/// disassembles nothing without a program that Debian has not, and the compiler's last step stands in. The headers' C++
/// functions leave no room for the texts themselves.
std::string read_listing(const vk::raii::Device& device, const vk::PipelineExecutableInfoKHR& executable) {
  using Text = VkPipelineExecutableInternalRepresentationKHR;
  const Text empty = {
      VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INTERNAL_REPRESENTATION_KHR, nullptr, {}, {}, VK_FALSE, 0, nullptr};
  const VkPipelineExecutableInfoKHR& info = executable;
  std::uint32_t count = 0;
  std::vector<Text> texts;
  const auto read = [&] {
    device.getDispatcher()->vkGetPipelineExecutableInternalRepresentationsKHR(*device, &info, &count,
                                                                              texts.empty() ? nullptr : texts.data());
  };
  read();
  texts.assign(count, empty);
  read();
  std::vector<std::string> listings;
  for (const Text& text : texts) listings.emplace_back(text.dataSize, '\0');
  for (std::size_t i = 0; i < texts.size(); ++i) texts[i].pData = listings[i].data();
  read();
  for (std::size_t i = texts.size(); i-- > 0;)
    if (texts[i].isText && listings[i].find("s_endpgm") != std::string::npos)
      return listings[i].substr(0, listings[i].find('\0'));
  fail("the Vulkan driver lists no machine code");
}

}  // namespace

struct NullDevice::Vulkan {
  vk::raii::Context context;
  vk::raii::Instance instance = make_instance(context);
  vk::raii::PhysicalDevice physical;
  std::string driver;
  // Both are made when something is first compiled: glslang and a device take long to start.
  std::optional<spirv::Shader> vertex = std::nullopt;
  std::optional<vk::raii::Device> device = std::nullopt;

  explicit Vulkan(const std::string& family) : physical(find_device(instance, family)) {
    const auto properties =
        physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties>();
    const auto& named = properties.get<vk::PhysicalDeviceDriverProperties>();
    const std::string_view device_name = properties.get<vk::PhysicalDeviceProperties2>().properties.deviceName.data();
    if (device_name.find(family) == std::string_view::npos)
      fail(fmt::format("the Vulkan driver has '{}' where '{}' was asked for: it does not know that family", device_name,
                       family));
    driver = fmt::format("{} {}", named.driverName.data(), named.driverInfo.data());
  }
};

NullDevice::NullDevice(const std::string& family) {
  setenv("RADV_FORCE_FAMILY", family.c_str(), 1);
  try {
    vulkan_ = std::make_unique<Vulkan>(family);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    fail(fmt::format("there is no Vulkan to compile for '{}' with ({}): install libvulkan1 and mesa-vulkan-drivers",
                     family, error.what()));
  }
}

NullDevice::~NullDevice() = default;

const std::string& NullDevice::driver() const { return vulkan_->driver; }

records::ShaderFacts NullDevice::compile(const gl::ShaderSource& source, const std::string& format) {
  if (!vulkan_->vertex)
    vulkan_->vertex =
        spirv::compile(gl::FullscreenTriangle::vertex_source(), spirv::Stage::kVertex, spirv::Rules::kVulkan);
  const spirv::Shader fragment = spirv::compile(source, spirv::Stage::kFragment, spirv::Rules::kVulkan);
  try {
    if (!vulkan_->device) vulkan_->device = make_device(vulkan_->physical);
    const vk::raii::Device& device = *vulkan_->device;
    const vk::raii::DescriptorSetLayout set = make_layout(device, fragment.bindings);
    const vk::raii::PipelineLayout layout(device, vk::PipelineLayoutCreateInfo({}, *set));
    const vk::raii::Pipeline pipeline = make_pipeline(device, layout, *vulkan_->vertex, fragment, find_format(format));
    const auto executables = device.getPipelineExecutablePropertiesKHR(vk::PipelineInfoKHR(*pipeline));
    for (std::uint32_t i = 0; i < executables.size(); ++i) {
      if (!(executables[i].stages & vk::ShaderStageFlagBits::eFragment)) continue;
      records::ShaderFacts facts;
      const vk::PipelineExecutableInfoKHR executable(*pipeline, i);
      read_statistics(device, executable, facts);
      count_reads(read_listing(device, executable), facts);
      return facts;
    }
  } catch (const vk::SystemError& error) {
    fail(fmt::format("the Vulkan driver refuses the pass: {}", error.what()));
  }
  fail("the Vulkan driver made no fragment shader of the pass");
}

}  // namespace shadowbench::gpu
#else
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
#endif
