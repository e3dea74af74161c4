#include "harness/engines/external_images.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
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
                                                                     {"depth", &ExternalImages::depth},
                                                                     {"unbiased", &ExternalImages::unbiased}};
  return layers;
}

/// "lit.R" ends in "r".
std::string ending(const std::string& channel) {
  std::string end = channel.substr(channel.rfind('.') + 1);
  std::ranges::transform(end, end.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return end;
}

/// The channels that a layer is made of: of depth the one called so, of others the colours; or else the only one.
std::vector<std::size_t> choose_channels(const images::StoredPicture& stored, const std::string& layer,
                                         const std::string& name) {
  const std::vector<std::string> wanted =
      layer == "depth" ? std::vector<std::string>{"z", "depth"} : std::vector<std::string>{"r", "g", "b", "y"};
  std::vector<std::size_t> chosen, others;
  for (std::size_t c = 0; c < stored.channel_names.size(); ++c) {
    if (static_cast<int>(c) == stored.alpha_channel && stored.image.channels > 1) continue;
    (std::ranges::count(wanted, ending(stored.channel_names[c])) > 0 ? chosen : others).push_back(c);
  }
  if (!chosen.empty()) return chosen;
  const bool is_grey = others.size() == 3 && layer == "depth";  // one value as a colour
  if (others.size() == 1 || is_grey) return others;
  fail_input(fmt::format("its channels are {}: {} is wanted", fmt::join(stored.channel_names, ", "),
                         layer == "depth" ? "one, called Z" : "R, G and B, or one"),
             name);
}

/// The mean of the channels: a shadow is grey.
images::Image to_grey(const images::StoredPicture& stored, const std::string& layer, const std::string& name) {
  if (stored.srgb) {
    fail_input(
        "these are sRGB codes, and shadows are compared in linear light: write floats, EXR or PFM, before the "
        "picture is encoded for a display",
        name);
  }
  const std::vector<std::size_t> channels = choose_channels(stored, layer, name);
  images::Image grey(stored.image.width, stored.image.height, 1);
  for (std::size_t i = 0; i < grey.texels.size(); ++i) {
    float sum = 0.0f;
    for (const std::size_t c : channels)
      sum += stored.image.texels[i * static_cast<std::size_t>(stored.image.channels) + c];
    grey.texels[i] = sum / static_cast<float>(channels.size());
  }
  return grey;
}

/// A file of its own, one of its parts, or one of its layers: FILE#lit.
images::Image read_one(const std::string& file, const std::string& layer) {
  const std::size_t mark = file.rfind('#');
  if (mark != file.npos && std::filesystem::exists(file.substr(0, mark)))
    if (auto layers = images::read_layers(file.substr(0, mark)); layers.contains(file.substr(mark + 1)))
      return to_grey(layers.at(file.substr(mark + 1)), layer, file);
  if (std::filesystem::is_regular_file(file))
    if (auto layers = images::read_layers(file); layers.contains(layer)) return to_grey(layers.at(layer), layer, file);
  return to_grey(images::read_stored_picture(file), layer, file);
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
      read.*(known->second) = to_grey(layer, name, files.layers + "#" + name);
      found.push_back(name);
    }
  }
  for (const auto& [name, file] :
       {std::pair("lit", &files.lit), std::pair("unlit", &files.unlit), std::pair("visibility", &files.visibility),
        std::pair("depth", &files.depth), std::pair("unbiased", &files.unbiased)}) {
    if (file->empty()) continue;
    const auto known = std::ranges::find(list_layers(), name, &std::pair<std::string, Member>::first);
    read.*(known->second) = read_one(*file, name);
    found.emplace_back(name);
    names.push_back(*file);
  }
  if (!files.shadow_map.empty()) read.shadow_map = read_one(files.shadow_map, "depth");
  read.names = fmt::format("{}", fmt::join(names, ", "));
  require_whole(read, found);
  require_one_size(read);
  return read;
}

}  // namespace shadowbench::engines
