#include "harness/engines/external_images.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "report/images/picture_io.h"
#include "report/records/json_values.h"

namespace shadowbench::engines {
namespace {

/// A layer, and where its picture and the name of its own file stand.
struct Layer {
  std::string name;
  std::optional<images::Image> ExternalImages::*image;
  std::string ExternalFiles::*file;
};

const std::vector<Layer>& list_layers() {
  static const std::vector<Layer> layers = {{"lit", &ExternalImages::lit, &ExternalFiles::lit},
                                            {"unlit", &ExternalImages::unlit, &ExternalFiles::unlit},
                                            {"visibility", &ExternalImages::visibility, &ExternalFiles::visibility},
                                            {"depth", &ExternalImages::depth, &ExternalFiles::depth},
                                            {"unbiased", &ExternalImages::unbiased, &ExternalFiles::unbiased}};
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

/// A file's layer or part of that name, where it has one; else what the name says: FILE, or FILE#PART.
images::StoredPicture read_layer(const std::string& file, const std::string& layer) {
  if (std::filesystem::is_regular_file(file))
    if (auto layers = images::read_layers(file); layers.contains(layer)) return std::move(layers.at(layer));
  return images::read_stored_picture(file);
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
  for (const Layer& layer : list_layers()) {
    const std::optional<images::Image>& image = read.*(layer.image);
    if (!image) continue;
    if (!first) first = &*image;
    if (image->width == first->width && image->height == first->height) continue;
    fail_input(fmt::format("{} has {} x {} pixels, and another of them has {} x {}: write all of one size", layer.name,
                           image->width, image->height, first->width, first->height),
               read.names);
  }
}

/// A point's place in the map, and how it changes along a direction.
struct Place {
  glm::dvec3 uv_depth{0.0};
  double w = 1.0;
};

Place place(const glm::dmat4& map_from_world, const glm::dvec3& point) {
  const glm::dvec4 at = map_from_world * glm::dvec4(point, 1.0);
  return {glm::dvec3(at) / at.w, at.w};
}

glm::dvec3 change_along(const glm::dmat4& map_from_world, const Place& at, const glm::dvec3& direction) {
  const glm::dvec4 change = map_from_world * glm::dvec4(direction, 0.0);
  return (glm::dvec3(change) - at.uv_depth * change.w) / at.w;
}

/// The depth that a plane gains over half a texel along u and along v; 0 where the light sees it from its edge.
double plane_bias(const OwnMap& map, const Place& at, const glm::dvec3& normal) {
  const glm::dvec3 across = std::abs(normal.y) < 0.9 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(1.0, 0.0, 0.0);
  const glm::dvec3 first = glm::normalize(glm::cross(normal, across)), second = glm::cross(normal, first);
  const glm::dvec3 a = change_along(map.map_from_world, at, first), b = change_along(map.map_from_world, at, second);
  const double area = a.x * b.y - a.y * b.x;
  if (area == 0.0) return 0.0;
  const double along_u = (a.z * b.y - b.z * a.y) / area, along_v = (b.z * a.x - a.z * b.x) / area;
  return 0.5 * (std::abs(along_u) / map.depth.width + std::abs(along_v) / map.depth.height);
}

using nlohmann::json;

/// What a key may hold: texts, and numbers as they are written.
std::string read_text(const std::string& key, const json& value, const std::string& where) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number() || value.is_boolean()) return value.dump();
  fail_input(fmt::format("'{}' must be a text or a number", key), where);
}

double read_milliseconds(const json& value, const std::string& where) {
  if (value.is_number() && value.get<double>() >= 0.0 && std::isfinite(value.get<double>())) return value.get<double>();
  fail_input("'ms' must be a number of milliseconds, 0 or more", where);
}

glm::dmat4 read_matrix(const json& value, const std::string& where) {
  glm::dmat4 matrix(0.0);
  const bool is_list = value.is_array() && value.size() == 16;
  for (int i = 0; i < 16; ++i) {
    const bool is_number = is_list && value[static_cast<std::size_t>(i)].is_number();
    if (is_number) matrix[i / 4][i % 4] = value[static_cast<std::size_t>(i)].get<double>();
    if (!is_number || !std::isfinite(matrix[i / 4][i % 4]))
      fail_input("'map_from_world' must be 16 numbers, columns first", where);
  }
  if (glm::determinant(matrix) == 0.0) fail_input("'map_from_world' leads all points to one plane of the map", where);
  return matrix;
}

}  // namespace

ExternalImages read_external_images(const ExternalFiles& files) {
  ExternalImages read;
  std::vector<std::string> found, names;
  std::map<std::string, images::StoredPicture> stored;
  if (!files.layers.empty()) {
    stored = images::read_layers(files.layers);
    names.push_back(files.layers);
  }
  for (const Layer& layer : list_layers()) {
    const std::string& file = files.*(layer.file);
    if (!file.empty()) {
      read.*(layer.image) = to_grey(read_layer(file, layer.name), layer.name, file);
      names.push_back(file);
    } else if (stored.contains(layer.name)) {
      read.*(layer.image) = to_grey(stored.at(layer.name), layer.name, files.layers + "#" + layer.name);
    }
    if (read.*(layer.image)) found.push_back(layer.name);
  }
  if (!files.shadow_map.empty())
    read.shadow_map = to_grey(images::read_stored_picture(files.shadow_map), "depth", files.shadow_map);
  read.names = fmt::format("{}", fmt::join(names, ", "));
  require_whole(read, found);
  require_one_size(read);
  return read;
}

std::vector<double> look_up(const OwnMap& map, const truth::ReceiverImage& receivers,
                            const std::vector<glm::vec3>& to_light_ws) {
  std::vector<double> lit(receivers.points.size(), 1.0);
  for (std::size_t i = 0; i < lit.size(); ++i) {
    const truth::ReceiverPoint& receiver = receivers.points[i];
    if (!receiver.counts) continue;
    const Place at = place(map.map_from_world, glm::dvec3(receiver.position_ws));
    const glm::dvec3& p = at.uv_depth;
    if (!(at.w > 0.0 && p.x >= 0.0 && p.x < 1.0 && p.y > 0.0 && p.y <= 1.0)) continue;
    const int column = static_cast<int>(p.x * map.depth.width), row = static_cast<int>((1.0 - p.y) * map.depth.height);
    const double stored =
        static_cast<double>(*map.depth.at(std::min(column, map.depth.width - 1), std::min(row, map.depth.height - 1)));
    // Away from the light depth grows, or with a reversed map falls.
    const double sign = change_along(map.map_from_world, at, -glm::dvec3(to_light_ws[i])).z >= 0.0 ? 1.0 : -1.0;
    constexpr double kRounding = 1e-6;  // of 24 bits, and of single precision on the way
    const double bias = plane_bias(map, at, glm::dvec3(receiver.normal_ws)) + kRounding;
    lit[i] = sign * (p.z - stored) > bias ? 0.0 : 1.0;  // what holds nothing blocks nothing
  }
  return lit;
}

Meta read_meta(const std::filesystem::path& file) {
  const std::string where = file.string();
  const json read = records::read_json_file(file, kMebibyte, "write it anew");
  if (!read.is_object())
    fail_input("a meta.json is one object, such as {\"engine\": \"three.js\", \"version\": \"r187\"}", where);
  Meta meta;
  records::ExternalRecord& external = meta.external;
  const std::vector<std::pair<std::string, std::optional<std::string>*>> texts = {
      {"engine", &external.engine}, {"version", &external.version}, {"driver", &external.driver},
      {"map", &external.map},       {"bias", &external.bias},       {"fit", &external.fit},
      {"timed", &external.timed}};
  std::vector<std::string> known = {"ms", "truth", "map_from_world"};
  for (const auto& [key, member] : texts) known.push_back(key);
  for (const auto& [key, value] : read.items()) {
    const auto text = std::ranges::find(texts, key, &std::pair<std::string, std::optional<std::string>*>::first);
    if (text != texts.end())
      *text->second = read_text(key, value, where);
    else if (key == "ms")
      external.ms = read_milliseconds(value, where);
    else if (key == "map_from_world")
      meta.map_from_world = read_matrix(value, where);
    else if (key == "truth")
      meta.truth = read_text(key, value, where);
    else
      fail_input(fmt::format("there is no key '{}'{}; keys: {}", key, did_you_mean(key, known), fmt::join(known, ", ")),
                 where);
  }
  return meta;
}

}  // namespace shadowbench::engines
