// A glTF file, as text or binary, loaded as a bare model: parsed, checked, framed, lit and put on a floor.
// The loader reads nothing outside the file's folder, which holds the input, one buffer and one picture.

#include <array>

#include "harness/scene/lights/light_fit.h"
#include "harness/scene/load.h"
#include "tests/fuzz/input.h"

namespace shadowbench::fuzz {
namespace {

/// A picture of one white pixel.
constexpr std::array<unsigned char, 69> kPng{
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00,
    0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x02, 0x00, 0x00, 0x00, 0x90, 0x77, 0x53, 0xde, 0x00, 0x00, 0x00,
    0x0c, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0xf8, 0xff, 0xff, 0x3f, 0x00, 0x05, 0xfe, 0x02, 0xfe, 0x0d,
    0xef, 0x46, 0xb8, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

void load_model(std::string_view bytes) {
  static const std::filesystem::path picture = write_input("p.png", as_text(kPng.data(), kPng.size()));
  static const std::filesystem::path buffer = write_input("b.bin", std::string(256, '\x3f'));
  scene::LoadOptions options;
  options.ground = true;
  const scene::Scene scene = scene::load(write_input("input.gltf", bytes).string(), options);
  scene::fit_light(scene, scene::FitMode::kTight, 64, 2.0);
}

}  // namespace
}  // namespace shadowbench::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace shadowbench::fuzz;
  allow_refusal([&] { load_model(as_text(data, size)); });
  return 0;
}
