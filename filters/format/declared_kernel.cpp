#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "base/nearest_name.h"
#include "filters/format/front_matter.h"

namespace shadowbench::filters {
namespace {

constexpr double kWidestRadius = kMaxPrefilterRadius;
constexpr double kMostTaps = 2.0 * kWidestRadius + 1.0;  // along an axis
constexpr double kWeightsSlack = 1e-6;                   // of the sum

/// A shape with what its size may be.
struct DeclaredShape {
  const char* name;
  KernelShape shape;
  Ends size;  ///< texels
  bool whole;
};

constexpr DeclaredShape kShapes[] = {{"tent", KernelShape::kTent, {0.5, kWidestRadius}, false},
                                     {"box", KernelShape::kBox, {1.0, kMostTaps}, true},
                                     {"disk", KernelShape::kDisk, {0.0, kWidestRadius}, false},
                                     {"gaussian", KernelShape::kGaussian, {0.0, kWidestRadius}, true}};

const DeclaredShape& find_shape(const TomlValue& value, const std::string& name) {
  std::vector<std::string> known;
  for (const DeclaredShape& each : kShapes) {
    if (each.name == name) return each;
    known.emplace_back(each.name);
  }
  throw value.error(
      fmt::format("'kernel' has the shape '{}', which is unknown{}", name, did_you_mean_or_known(name, known)));
}

/// "tent:2": a shape, and its size as a number or a parameter's name.
void read_shape(const TomlValue& value, const FilterSpec& spec, DeclaredKernel& kernel) {
  const auto text = value.as<std::string>();
  const std::size_t colon = text ? text->find(':') : std::string::npos;
  if (colon == std::string::npos)
    throw value.error("a kernel's shape must be a text such as \"tent:2\" or \"disk:radius\"");
  const DeclaredShape& shape = find_shape(value, text->substr(0, colon));
  const std::string size = text->substr(colon + 1);
  kernel.shape = shape.shape;
  double number = 0.0;
  const auto [end, error] = std::from_chars(size.data(), size.data() + size.size(), number);
  const bool is_number = error == std::errc() && end == size.data() + size.size() && std::isfinite(number);
  const ParamSpec* param = spec.find_param(size);
  if (!is_number && (!param || !std::holds_alternative<double>(param->default_value)))
    throw value.error(fmt::format("'kernel' names '{}', which is neither a number nor a numeric parameter", size));
  const Ends ends = is_number ? Ends{number, number} : ends_of(*param);
  const bool is_whole = is_number ? number == std::floor(number) : param->integer;
  if (!(ends.smallest >= shape.size.smallest && ends.largest <= shape.size.largest) || (shape.whole && !is_whole)) {
    throw value.error(fmt::format("the size of a {} must {} within {} .. {} texels, and '{}' is not", shape.name,
                                  shape.whole ? "be a whole number" : "lie", shape.size.smallest, shape.size.largest,
                                  size));
  }
  if (is_number)
    kernel.size = number;
  else
    kernel.size = size;
}

/// Whole numbers are shares of their sum; others must sum to 1 themselves.
std::vector<double> read_weights(const TomlValue& value) {
  const auto list = value.as_list();
  if (!list || list->empty() || static_cast<double>(list->size()) > kMostTaps)
    throw value.error(fmt::format("'weights' must be a list of 1 .. {} numbers", kMostTaps));
  std::vector<double> weights;
  bool are_shares = true;
  for (const TomlValue& item : *list) {
    const auto weight = item.as<double>();
    if (!weight || !std::isfinite(*weight) || *weight < 0.0)
      throw item.error("'weights' must hold finite numbers of 0 or more");
    weights.push_back(*weight);
    are_shares = are_shares && item.as<std::int64_t>();
  }
  if (!std::equal(weights.begin(), weights.end(), weights.rbegin()))
    throw value.error("'weights' must be symmetric about the receiver");
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (are_shares ? sum == 0.0 : std::abs(sum - 1.0) > kWeightsSlack)
    throw value.error(fmt::format("'weights' sum to {}, not to 1; whole numbers are divided by their sum", sum));
  for (double& weight : weights) weight /= sum;
  return weights;
}

Kernel make_taps(const std::vector<double>& weights, Reconstruction reconstruction) {
  const double middle = 0.5 * (static_cast<double>(weights.size()) - 1.0);
  std::vector<Kernel::Atom> atoms;
  for (std::size_t i = 0; i < weights.size(); ++i)
    if (weights[i] > 0.0) atoms.push_back({static_cast<double>(i) - middle, weights[i]});
  return Kernel::make_grid(std::move(atoms), reconstruction);
}

}  // namespace

DeclaredKernel read_kernel(const TomlValue& value, const FilterSpec& spec) {
  DeclaredKernel kernel;
  const auto table = value.as_table("'kernel'");
  if (!table) {
    read_shape(value, spec, kernel);
    return kernel;
  }
  table->require_known_keys(front_matter_keys().at("kernel"));
  if (table->has("shape") == table->has("weights")) throw table->error("'kernel' needs either 'shape' or 'weights'");
  if (const auto weights = table->find("weights"))
    kernel.weights = read_weights(*weights);
  else
    read_shape(*table->find("shape"), spec, kernel);
  kernel.reads_nearest = table->choose<bool>("read", {{"bilinear", false}, {"nearest", true}}, "bilinear");
  if (table->has("read") && (kernel.shape == KernelShape::kTent || kernel.shape == KernelShape::kDisk))
    throw table->error("read", "'read' is for taps at whole texels: a box, a gaussian, or weights");
  return kernel;
}

Kernel make_kernel(const DeclaredKernel& declared, const ParamValues& values) {
  const Reconstruction read = declared.reads_nearest ? Reconstruction::kNearest : Reconstruction::kBilinear;
  if (declared.shape == KernelShape::kWeights) return make_taps(declared.weights, read);
  const double size = number_or_param(declared.size, values);
  switch (declared.shape) {
    case KernelShape::kTent: return Kernel::make_triangle(size);
    case KernelShape::kDisk: return Kernel::make_disk(size);
    case KernelShape::kGaussian: return Kernel::make_gaussian(static_cast<int>(size), read);
    default: return Kernel::make_box(static_cast<int>(size), read);
  }
}

}  // namespace shadowbench::filters
