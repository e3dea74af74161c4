#include "filters/store_format.h"

#include <glm/gtc/packing.hpp>
#include <limits>

namespace shadowbench::filters {
namespace {

constexpr double kLargestHalf = 65504.0;

}  // namespace

const std::vector<std::string>& encode_formats() {
  static const std::vector<std::string> formats = {"r16f",    "r32f", "rg16f", "rg32f", "rgba16f",
                                                   "rgba32f", "r16",  "rg16",  "rgba16"};
  return formats;
}

const std::vector<std::string>& pass_formats() {
  static const std::vector<std::string> formats = [] {
    std::vector<std::string> all = encode_formats();
    for (const char* integer : {"r32ui", "rg32ui", "rgba32ui"}) all.emplace_back(integer);
    return all;
  }();
  return formats;
}

StorePrecision store_precision(const std::string& format) {
  if (format.ends_with("32f")) return StorePrecision::kSingle;
  return format.ends_with("16f") ? StorePrecision::kHalf : StorePrecision::kUnorm16;
}

int store_channels(const std::string& format) {
  if (format.starts_with("rgba")) return 4;
  return format.starts_with("rg") ? 2 : 1;
}

int store_bytes(const std::string& format) {
  return store_channels(format) * (format.find("32") != std::string::npos ? 4 : 2);
}

double largest_number(StorePrecision precision) {
  if (precision == StorePrecision::kSingle) return static_cast<double>(std::numeric_limits<float>::max());
  return precision == StorePrecision::kHalf ? kLargestHalf : 1.0;
}

float round_to_store(float value, StorePrecision precision) {
  switch (precision) {
    case StorePrecision::kSingle: return value;
    case StorePrecision::kHalf: return glm::unpackHalf1x16(glm::packHalf1x16(value));
    case StorePrecision::kUnorm16: return std::round(std::clamp(value, 0.0f, 1.0f) * 65535.0f) / 65535.0f;
  }
  return value;
}

Tracked round_to_store(Tracked value, StorePrecision precision) {
  switch (precision) {
    case StorePrecision::kSingle: return value;
    // A GL may truncate instead of rounding to nearest, so the error is up to a whole step instead of half of one.
    case StorePrecision::kHalf:
      if (std::abs(value.value) + value.bound > kLargestHalf) return {value.value, HUGE_VAL};
      return {value.value, value.bound + 0x1p-10 * (std::abs(value.value) + value.bound) + 0x1p-24};
    case StorePrecision::kUnorm16: return {value.value, value.bound + 1.0 / 65535.0};
  }
  return value;
}

}  // namespace shadowbench::filters
