#include "harness/view/save_picture.h"

#include <fmt/format.h>

#include <system_error>

#include "report/images/picture_io.h"

namespace shadowbench::view {

std::filesystem::path find_free_stem(const std::filesystem::path& folder, const std::string& name) {
  const auto is_taken = [&](const std::string& stem) {
    std::error_code missing;  // a folder that is not there yet has no files
    for (const auto& entry : std::filesystem::directory_iterator(folder, missing))
      if (entry.path().filename().string().starts_with(stem + ".")) return true;
    return false;
  };
  int number = 1;
  while (is_taken(fmt::format("{}-{}", name, number))) ++number;
  return folder / fmt::format("{}-{}", name, number);
}

void save_picture(Workbench& bench, render::DisplayPass& display, const std::array<render::DisplayedValues, 2>& shown,
                  float divider, const std::filesystem::path& stem) {
  const ViewState& state = bench.state();
  const glm::ivec2 size(state.options.width, state.options.height);
  render::ImageTarget target("saved picture", GL_RGBA8, size.x, size.y);
  display.draw(bench.renderer().shaders, shown, {glm::ivec2(0), size, glm::vec2(0.0f), 1.0f, divider}, target);
  std::vector<images::Part> parts;
  for (std::size_t side = 0; side < kSides; ++side) {
    const std::string name = kSideNames[side];
    parts.push_back(
        {name + ".visibility", {"Y"}, render::read_image(bench.stage().visibility(side, {0, size.x}), 1), false});
    const gl::Texture& picture = bench.stage().picture(state, side, {0, size.x});
    parts.push_back({name + ".picture", {"R", "G", "B"}, render::read_image(picture, 3), true});
  }
  if (bench.stage().truth() != nullptr)
    parts.push_back({"truth.area", {"Y"}, render::read_image(*bench.stage().truth(), 1), false});
  images::Metadata metadata = {{"scene", state.scene.name}};
  for (std::size_t side = 0; side < kSides; ++side) metadata[kSideNames[side]] = state.sides[side].label();
  images::write_exr(std::filesystem::path(stem) += ".exr", parts, metadata);
  images::write_display_png(std::filesystem::path(stem) += ".png", render::read_image(target.texture(), 3));
}

}  // namespace shadowbench::view
