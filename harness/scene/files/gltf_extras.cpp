#include "harness/scene/files/gltf_extras.h"

#include <toml++/toml.h>

#include <limits>

#include "base/error.h"

namespace shadowbench::scene {
namespace {

const tinygltf::Value& find_own(const tinygltf::Value& extras) {
  static const tinygltf::Value kNone{tinygltf::Value::Object()};
  return extras.Has("shadowbench") && extras.Get("shadowbench").IsObject() ? extras.Get("shadowbench") : kNone;
}

double read_number(const tinygltf::Value& value) {
  return value.IsNumber() ? value.GetNumberAsDouble() : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

bool read_extra_flag(const tinygltf::Value& extras, const std::string& key) {
  const tinygltf::Value& value = find_own(extras).Get(key);
  return !value.IsBool() || value.Get<bool>();
}

toml::table read_light_extras(const tinygltf::Value& extras) {
  toml::table table;
  const tinygltf::Value& own = find_own(extras);
  for (const std::string& key : own.Keys()) {
    const tinygltf::Value& value = own.Get(key);
    if (!value.IsArray()) {
      table.insert(key, read_number(value));
      continue;
    }
    toml::array list;
    for (std::size_t i = 0; i < value.ArrayLen(); ++i) list.push_back(read_number(value.Get(static_cast<int>(i))));
    table.insert(key, std::move(list));
  }
  return table;
}

SceneExtras read_scene_extras(const tinygltf::Value& extras, const std::string& where) {
  const tinygltf::Value &title = find_own(extras).Get("title"), &background = find_own(extras).Get("background");
  SceneExtras read;
  if (title.IsString()) read.title = title.Get<std::string>();
  if (!background.IsArray()) return read;
  glm::vec3 color;
  for (int i = 0; i < 3; ++i) {
    const double part = read_number(background.Get(i));
    if (background.ArrayLen() != 3 || !(part >= 0.0 && part <= 1.0))
      fail_input("the background of the scene must be 3 numbers from 0 to 1", where);
    color[i] = static_cast<float>(part);
  }
  read.background = color;
  return read;
}

}  // namespace shadowbench::scene
