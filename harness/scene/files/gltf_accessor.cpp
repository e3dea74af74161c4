#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>
#include <utility>

#include "base/error.h"
#include "harness/scene/files/gltf.h"

namespace shadowbench::scene {
namespace {

constexpr std::size_t kMostElements = std::size_t{1} << 27;
/// The most elements of an accessor without a buffer view; they are all zero, and take no room in the file.
constexpr std::size_t kMostZeros = std::size_t{1} << 16;

/// Bytes that were found to lie inside their buffer.
struct ByteSpan {
  const unsigned char* data = nullptr;
  std::size_t size = 0;
};

ByteSpan checked_span(const tinygltf::Model& model, const tinygltf::BufferView& view, const std::string& owner,
                      const std::string& where) {
  const std::vector<unsigned char>& bytes =
      find_element(model.buffers, view.buffer, owner + " names buffer", where).data;
  if (view.byteOffset <= bytes.size() && view.byteLength <= bytes.size() - view.byteOffset)
    return {bytes.data() + view.byteOffset, view.byteLength};
  fail_input(fmt::format("{} runs past its buffer: offset {} + {} bytes of {}", owner, view.byteOffset, view.byteLength,
                         bytes.size()),
             where);
}

ByteSpan checked_view(const tinygltf::Model& model, int index, const std::string& owner, const std::string& where) {
  const tinygltf::BufferView& view = find_element(model.bufferViews, index, owner + ": there is no buffer view", where);
  return checked_span(model, view, fmt::format("{}: buffer view {}", owner, index), where);
}

/// A type that glTF 2.0 knows for the components of an element.
struct ComponentType {
  int code = 0;
  std::size_t bytes = 0;
  double largest = 1.0;  ///< what stands for 1 where integers are normalized
  bool is_unsigned = false;
  double (*load)(const unsigned char* bytes) = nullptr;
};

template <class T>
double load(const unsigned char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

template <class T>
constexpr ComponentType describe(int code, double largest) {
  return {code, sizeof(T), largest, std::is_unsigned_v<T>, &load<T>};
}

constexpr std::array kComponentTypes{describe<std::int8_t>(TINYGLTF_COMPONENT_TYPE_BYTE, 127.0),
                                     describe<std::uint8_t>(TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 255.0),
                                     describe<std::int16_t>(TINYGLTF_COMPONENT_TYPE_SHORT, 32767.0),
                                     describe<std::uint16_t>(TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, 65535.0),
                                     describe<std::uint32_t>(TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, 1.0),
                                     describe<float>(TINYGLTF_COMPONENT_TYPE_FLOAT, 1.0)};

const ComponentType& find_type(int code, const std::string& owner, const std::string& where) {
  const auto found = std::ranges::find(kComponentTypes, code, &ComponentType::code);
  if (found != kComponentTypes.end()) return *found;
  fail_input(fmt::format("{} has component type {}, which glTF 2.0 does not know", owner, code), where);
}

/// How elements lie in a checked span; all of them lie inside it.
struct Elements {
  const unsigned char* data = nullptr;  ///< null: all zero
  std::size_t count = 0;
  std::size_t stride = 0;
  const ComponentType* type = nullptr;
  std::size_t components = 0;
};

/// Checks that `layout.count` elements from `offset` lie inside the span, and points the layout at the first.
Elements place(Elements layout, ByteSpan span, std::size_t offset, const std::string& owner, const std::string& where) {
  const std::size_t element_size = layout.type->bytes * layout.components;
  if (layout.stride == 0) layout.stride = element_size;
  if (layout.stride < element_size) {
    fail_input(fmt::format("{} has a stride of {} bytes for elements of {}", owner, layout.stride, element_size),
               where);
  }
  const bool fits = layout.count > 0 && offset <= span.size && element_size <= span.size - offset &&
                    layout.count - 1 <= (span.size - offset - element_size) / layout.stride;
  if (layout.count > 0 && !fits) {
    fail_input(fmt::format("{} is out of range: {} elements of {} bytes, stride {}, from byte {} of "
                           "a buffer view of {} bytes",
                           owner, layout.count, element_size, layout.stride, offset, span.size),
               where);
  }
  layout.data = span.data + offset;
  return layout;
}

Elements checked_elements(const tinygltf::Model& model, int index, int components, const std::string& where) {
  const std::string owner = fmt::format("accessor {}", index);
  const tinygltf::Accessor& accessor = find_element(model.accessors, index, "there is no accessor", where);
  if (tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)) != components)
    fail_input(fmt::format("{} must have {} component(s) per element", owner, components), where);
  if (accessor.count > kMostElements)
    fail_input(fmt::format("{} has {} elements; at most {} are read", owner, accessor.count, kMostElements), where);
  Elements elements{nullptr, accessor.count, 0, &find_type(accessor.componentType, owner, where),
                    static_cast<std::size_t>(components)};
  if (accessor.bufferView < 0 && accessor.count > kMostZeros) {
    fail_input(fmt::format("{} has {} elements and no buffer view; at most {} such zeros are read", owner,
                           accessor.count, kMostZeros),
               where);
  }
  if (accessor.bufferView < 0) return elements;
  const ByteSpan span = checked_view(model, accessor.bufferView, owner, where);
  elements.stride = model.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
  return place(elements, span, accessor.byteOffset, owner, where);
}

std::vector<double> load_all(const Elements& elements) {
  std::vector<double> values(elements.count * elements.components, 0.0);
  if (!elements.data) return values;
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = elements.type->load(elements.data + i / elements.components * elements.stride +
                                    i % elements.components * elements.type->bytes);
  return values;
}

/// Replaces the elements that a sparse accessor lists.
std::vector<double> with_sparse_values(std::vector<double> values, const tinygltf::Model& model,
                                       const tinygltf::Accessor& accessor, const Elements& base,
                                       const std::string& where) {
  const auto& sparse = accessor.sparse;
  const std::string owner = fmt::format("sparse accessor '{}'", accessor.name);
  // Offsets are signed in tinygltf 2.5 and unsigned in 2.9.
  if (sparse.count < 0 || static_cast<std::size_t>(sparse.count) > base.count ||
      std::cmp_less(sparse.indices.byteOffset, 0) || std::cmp_less(sparse.values.byteOffset, 0))
    fail_input(fmt::format("{} has a count or offset out of range", owner), where);
  const auto count = static_cast<std::size_t>(sparse.count);
  const Elements slots = place({nullptr, count, 0, &find_type(sparse.indices.componentType, owner, where), 1},
                               checked_view(model, sparse.indices.bufferView, owner, where),
                               static_cast<std::size_t>(sparse.indices.byteOffset), owner, where);
  const Elements news = place({nullptr, count, 0, base.type, base.components},
                              checked_view(model, sparse.values.bufferView, owner, where),
                              static_cast<std::size_t>(sparse.values.byteOffset), owner, where);
  const std::vector<double> slot_values = load_all(slots);
  const std::vector<double> new_values = load_all(news);
  for (std::size_t i = 0; i < count; ++i) {
    if (!(slot_values[i] >= 0.0 && slot_values[i] < static_cast<double>(base.count)))
      fail_input(fmt::format("{} replaces element {} of {}", owner, slot_values[i], base.count), where);
    std::copy_n(
        new_values.begin() + static_cast<std::ptrdiff_t>(i * base.components), base.components,
        values.begin() + static_cast<std::ptrdiff_t>(slot_values[i]) * static_cast<std::ptrdiff_t>(base.components));
  }
  return values;
}

/// What an accessor holds, as numbers.
struct Values {
  std::vector<double> all;
  ComponentType type;
  bool is_normalized = false;
};

Values read_values(const tinygltf::Model& model, int index, int components, const std::string& where) {
  const Elements elements = checked_elements(model, index, components, where);
  const tinygltf::Accessor& accessor = model.accessors[static_cast<std::size_t>(index)];
  std::vector<double> values = load_all(elements);
  if (accessor.sparse.isSparse) values = with_sparse_values(std::move(values), model, accessor, elements, where);
  return {std::move(values), *elements.type, accessor.normalized};
}

}  // namespace

std::vector<float> read_floats(const tinygltf::Model& model, int accessor, int components, const std::string& where) {
  const Values values = read_values(model, accessor, components, where);
  const double scale = 1.0 / values.type.largest;
  std::vector<float> floats;
  floats.reserve(values.all.size());
  for (const double value : values.all)
    floats.push_back(static_cast<float>(values.is_normalized ? std::max(value * scale, -1.0) : value));
  return floats;
}

std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int accessor, const std::string& where) {
  const Values values = read_values(model, accessor, 1, where);
  if (!values.type.is_unsigned) {
    fail_input(fmt::format("accessor {} holds indices, but its component type {} is not an "
                           "unsigned integer",
                           accessor, values.type.code),
               where);
  }
  std::vector<std::uint32_t> indices;
  indices.reserve(values.all.size());
  for (const double value : values.all) indices.push_back(static_cast<std::uint32_t>(value));
  return indices;
}

std::vector<unsigned char> read_span(const tinygltf::Model& model, const tinygltf::BufferView& view,
                                     const std::string& owner, const std::string& where) {
  const ByteSpan span = checked_span(model, view, owner, where);
  return {span.data, span.data + span.size};
}

std::vector<unsigned char> read_buffer_view(const tinygltf::Model& model, int view, const std::string& owner,
                                            const std::string& where) {
  const ByteSpan span = checked_view(model, view, owner, where);
  return {span.data, span.data + span.size};
}

}  // namespace shadowbench::scene
