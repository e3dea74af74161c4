#include "filters/format/kernel_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "filters/base/nearest_name.h"

namespace shadowbench::filters {
namespace {

constexpr double kWidestRadius = kMaxPrefilterRadius;
constexpr double kMostTaps = 2.0 * kWidestRadius + 1.0;  // along an axis
constexpr double kWeightsSlack = 1e-6;                   // of the sum

/// A shape with what its size may be.
struct Shape {
  const char* name;
  KernelShape shape;
  Ends size;  ///< texels
  bool whole;
};

constexpr Shape kShapes[] = {{"tent", KernelShape::kTent, {0.5, kWidestRadius}, false},
                             {"box", KernelShape::kBox, {1.0, kMostTaps}, true},
                             {"disk", KernelShape::kDisk, {0.0, kWidestRadius}, false},
                             {"gaussian", KernelShape::kGaussian, {0.0, kWidestRadius}, true}};

const Shape& find_shape(const FrontMatterReader& reader, const toml::node& node, const std::string& name) {
  std::vector<std::string> known;
  for (const Shape& each : kShapes) {
    if (each.name == name) return each;
    known.emplace_back(each.name);
  }
  reader.fail(&node,
              fmt::format("'kernel' has the shape '{}', which is unknown{}", name, did_you_mean_or_known(name, known)));
}

/// "tent:2": a shape, and its size as a number or a parameter's name.
void read_shape(const FrontMatterReader& reader, const toml::node& node, const FilterSpec& spec,
                DeclaredKernel& kernel) {
  const auto text = node.value_exact<std::string>();
  const std::size_t colon = text ? text->find(':') : std::string::npos;
  if (colon == std::string::npos)
    reader.fail(&node, "a kernel's shape must be a text such as \"tent:2\" or \"disk:radius\"");
  const Shape& shape = find_shape(reader, node, text->substr(0, colon));
  const std::string size = text->substr(colon + 1);
  kernel.shape = shape.shape;
  double number = 0.0;
  const auto [end, error] = std::from_chars(size.data(), size.data() + size.size(), number);
  const bool is_number = error == std::errc() && end == size.data() + size.size() && std::isfinite(number);
  const ParamSpec* param = spec.find_param(size);
  if (!is_number && (!param || !std::holds_alternative<double>(param->default_value)))
    reader.fail(&node, fmt::format("'kernel' names '{}', which is neither a number nor a numeric parameter", size));
  const Ends ends = is_number ? Ends{number, number} : ends_of(*param);
  const bool is_whole = is_number ? number == std::floor(number) : param->integer;
  if (!(ends.smallest >= shape.size.smallest && ends.largest <= shape.size.largest) || (shape.whole && !is_whole)) {
    reader.fail(&node,
                fmt::format("the size of a {} must {} within {} .. {} texels, and '{}' is not", shape.name,
                            shape.whole ? "be a whole number" : "lie", shape.size.smallest, shape.size.largest, size));
  }
  if (is_number)
    kernel.size = number;
  else
    kernel.size = size;
}

/// Whole numbers are shares of their sum; others must sum to 1 themselves.
std::vector<double> read_weights(const FrontMatterReader& reader, const toml::node& node) {
  const toml::array* list = node.as_array();
  if (!list || list->empty() || static_cast<double>(list->size()) > kMostTaps)
    reader.fail(&node, fmt::format("'weights' must be a list of 1 .. {} numbers", kMostTaps));
  std::vector<double> weights;
  for (const toml::node& item : *list) {
    const auto weight = item.is_number() ? item.value<double>() : std::nullopt;
    if (!weight || !std::isfinite(*weight) || *weight < 0.0)
      reader.fail(&item, "'weights' must hold finite numbers of 0 or more");
    weights.push_back(*weight);
  }
  if (!std::equal(weights.begin(), weights.end(), weights.rbegin()))
    reader.fail(&node, "'weights' must be symmetric about the receiver");
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  const bool are_shares = list->is_homogeneous<std::int64_t>();
  if (are_shares ? sum == 0.0 : std::abs(sum - 1.0) > kWeightsSlack)
    reader.fail(&node, fmt::format("'weights' sum to {}, not to 1; whole numbers are divided by their sum", sum));
  for (double& weight : weights) weight /= sum;
  return weights;
}

}  // namespace

DeclaredKernel read_kernel(const FrontMatterReader& reader, const toml::node& node, const FilterSpec& spec) {
  DeclaredKernel kernel;
  const toml::table* table = node.as_table();
  if (!table) {
    read_shape(reader, node, spec, kernel);
    return kernel;
  }
  reader.check_keys(*table, {"shape", "weights", "read"}, "'kernel'");
  if (table->contains("shape") == table->contains("weights"))
    reader.fail(table, "'kernel' needs either 'shape' or 'weights'");
  if (const toml::node* weights = table->get("weights"))
    kernel.weights = read_weights(reader, *weights);
  else
    read_shape(reader, *table->get("shape"), spec, kernel);
  kernel.reads_nearest = reader.choose<bool>(*table, "read", {{"bilinear", false}, {"nearest", true}});
  if (table->contains("read") && (kernel.shape == KernelShape::kTent || kernel.shape == KernelShape::kDisk))
    reader.fail(table->get("read"), "'read' is for taps at whole texels: a box, a gaussian, or weights");
  return kernel;
}

}  // namespace shadowbench::filters
