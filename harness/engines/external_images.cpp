#include "harness/engines/external_images.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "base/error.h"
#include "report/images/stored_picture.h"

namespace shadowbench::engines {
namespace {

using Member = std::optional<images::Image> ExternalImages::*;

const std::vector<std::pair<std::string, Member>>& list_layers() {
  static const std::vector<std::pair<std::string, Member>> layers = {{"lit", &ExternalImages::lit},
                                                                     {"unlit", &ExternalImages::unlit},
                                                                     {"visibility", &ExternalImages::visibility},
                                                                     {"depth", &ExternalImages::depth}};
  return layers;
}

/// The mean of the colour channels: a shadow is grey.
images::Image to_grey(const images::StoredPicture& stored, const std::string& name) {
  if (stored.srgb) {
    fail_input(
        "these are sRGB codes, and shadows are compared in linear light: write floats, EXR or PFM, before the "
        "picture is encoded for a display",
        name);
  }
  const int channels = stored.image.channels;
  images::Image grey(stored.image.width, stored.image.height, 1);
  const int used = channels - (stored.alpha_channel >= 0 && channels > 1 ? 1 : 0);
  for (std::size_t i = 0; i < grey.texels.size(); ++i) {
    float sum = 0.0f;
    for (int c = 0; c < channels; ++c)
      if (c != stored.alpha_channel || used == channels)
        sum += stored.image.texels[i * static_cast<std::size_t>(channels) + static_cast<std::size_t>(c)];
    grey.texels[i] = sum / static_cast<float>(used);
  }
  return grey;
}

void require_whole(const ExternalImages& read, const std::vector<std::string>& found) {
  if (read.visibility || (read.lit && read.unlit)) return;
  const std::string there = found.empty() ? "nothing of that" : fmt::format("{}", fmt::join(found, ", "));
  fail_input(fmt::format("there is {}; give lit and unlit, or visibility: as layers of one file, or as --lit F --unlit "
                         "F, or --visibility F",
                         there),
             read.names);
}

void require_one_size(const ExternalImages& read) {
  const images::Image* first = nullptr;
  for (const auto& [name, member] : list_layers()) {
    const std::optional<images::Image>& image = read.*member;
    if (!image) continue;
    if (!first) first = &*image;
    if (image->width == first->width && image->height == first->height) continue;
    fail_input(fmt::format("{} has {} x {} pixels, and another of them has {} x {}: write all of one size", name,
                           image->width, image->height, first->width, first->height),
               read.names);
  }
}

}  // namespace

ExternalImages read_external_images(const ExternalFiles& files) {
  ExternalImages read;
  std::vector<std::string> found, names;
  if (!files.layers.empty()) {
    names.push_back(files.layers);
    const auto layers = images::read_layers(files.layers);
    for (const auto& [name, layer] : layers) {
      const auto known = std::ranges::find(list_layers(), name, &std::pair<std::string, Member>::first);
      if (known == list_layers().end()) continue;
      read.*(known->second) = to_grey(layer, files.layers + "#" + name);
      found.push_back(name);
    }
  }
  for (const auto& [name, file] : {std::pair("lit", &files.lit), std::pair("unlit", &files.unlit),
                                   std::pair("visibility", &files.visibility), std::pair("depth", &files.depth)}) {
    if (file->empty()) continue;
    const auto known = std::ranges::find(list_layers(), name, &std::pair<std::string, Member>::first);
    read.*(known->second) = to_grey(images::read_stored_picture(*file), *file);
    found.emplace_back(name);
    names.push_back(*file);
  }
  if (!files.shadow_map.empty())
    read.shadow_map = to_grey(images::read_stored_picture(files.shadow_map), files.shadow_map);
  read.names = fmt::format("{}", fmt::join(names, ", "));
  require_whole(read, found);
  require_one_size(read);
  return read;
}

}  // namespace shadowbench::engines
