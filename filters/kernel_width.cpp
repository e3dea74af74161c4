#include "filters/kernel_width.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/nearest_name.h"
#include "filters/model.h"

namespace shadowbench::filters {
namespace {

constexpr double kSlack = 0.005;           // of a width: what three digits round off
constexpr double kRadiiPerTexel = 1000.0;  // among those that need not be whole

std::array<WidthClass, 3> make_classes() {
  const Kernel fetch = Kernel::make_point(Reconstruction::kBilinear), disk = Kernel::make_disk(3.0);
  const Kernel tent = Kernel::make_box(2);
  const double sharp = fetch.sigma_texels(), medium = tent.sigma_texels(), soft = disk.sigma_texels();
  return {WidthClass{"sharp", sharp, std::sqrt(sharp * medium)}, WidthClass{"medium", medium, std::sqrt(medium * soft)},
          WidthClass{"soft", soft, soft * std::sqrt(soft / medium)}};
}

[[noreturn]] void refuse_width(const FilterSpec& spec, const std::string& width, const std::string& why) {
  throw Error(ErrorKind::kUsage, fmt::format("{}:width={}: {}", spec.id, width, why));
}

std::vector<std::string> list_class_names() {
  std::vector<std::string> names;
  for (const WidthClass& each : width_classes()) names.emplace_back(each.name);
  return names;
}

/// What a width stands for, in texels.
double parse_width(const FilterSpec& spec, const std::string& width) {
  for (const WidthClass& each : width_classes())
    if (each.name == width) return each.sigma_texels;
  double texels = 0.0;
  const auto [end, error] = std::from_chars(width.data(), width.data() + width.size(), texels);
  if (error != std::errc() || end != width.data() + width.size() || !std::isfinite(texels))
    refuse_width(spec, width,
                 "it is no number of texels, and no class" + did_you_mean_or_known(width, list_class_names()));
  return texels;
}

/// The radii that a parameter can be, ascending: all of them, or the two ends of a range.
std::vector<double> list_radii(const ParamSpec& param) {
  std::vector<double> radii;
  for (const ParamValue& choice : param.choices) radii.push_back(std::get<double>(choice));
  if (radii.empty() && !param.integer) radii = {*param.min, *param.max};
  if (radii.empty())
    for (double radius = *param.min; radius <= *param.max; radius += 1.0) radii.push_back(radius);
  std::ranges::sort(radii);
  return radii;
}

}  // namespace

const std::array<WidthClass, 3>& width_classes() {
  static const std::array<WidthClass, 3> classes = make_classes();
  return classes;
}

const WidthClass* find_width_class(double sigma_texels) {
  for (const WidthClass& each : width_classes())
    if (sigma_texels <= each.widest_texels) return &each;
  return nullptr;
}

std::string describe_classes() {
  std::vector<std::string> texts;
  for (const WidthClass& each : width_classes())
    texts.push_back(fmt::format("{} {:.2f} texels, up to {:.2f}", each.name, each.sigma_texels, each.widest_texels));
  return fmt::format("{}", fmt::join(texts, "; "));
}

std::optional<double> find_kernel_sigma(const FilterSpec& spec, const ParamValues& values) {
  const auto kernel = find_kernel(spec, values);
  return kernel ? std::optional(kernel->sigma_texels()) : std::nullopt;
}

double solve_radius(const FilterSpec& spec, const ParamValues& values, const std::string& width) {
  const double wanted = parse_width(spec, width);
  const auto sigma = find_kernel_sigma(spec, values);
  const auto* name = std::get_if<std::string>(&spec.radius_texels);
  if (!name)
    refuse_width(spec, width,
                 "the filter has no radius that a width could set" +
                     (sigma ? fmt::format("; its kernel is {:.3g} texels wide", *sigma) : std::string()));
  if (!sigma) refuse_width(spec, width, fmt::format("{}; set '{}' itself", explain_no_kernel(spec), *name));
  const ParamSpec& param = *spec.find_param(*name);
  auto sigma_at = [&, trial = values](double radius) mutable {
    trial[*name] = radius;
    return *find_kernel_sigma(spec, trial);
  };
  const std::vector<double> radii = list_radii(param);
  double low = radii.front(), high = radii.back();
  if (!(wanted >= sigma_at(low) * (1.0 - kSlack) && wanted <= sigma_at(high) * (1.0 + kSlack)))
    refuse_width(spec, width,
                 fmt::format("no '{}' gives this; choose a class ({}) or {:.3g} .. {:.3g} texels", *name,
                             fmt::join(list_class_names(), ", "), sigma_at(low), sigma_at(high)));
  const bool is_class = std::ranges::count(width_classes(), width, &WidthClass::name) > 0;
  const auto distance = [&](double radius) {
    const double sigma_texels = sigma_at(radius);
    const WidthClass* its_class = find_width_class(sigma_texels);
    const double strays = is_class && (!its_class || its_class->name != width) ? 1e3 : 0.0;
    return strays + std::abs(std::log(sigma_texels / wanted));
  };
  if (param.integer || !param.choices.empty()) return *std::ranges::min_element(radii, {}, distance);
  while (high - low > 0.01 / kRadiiPerTexel) {
    const double middle = 0.5 * (low + high);
    (sigma_at(middle) < wanted ? low : high) = middle;
  }
  return std::clamp(std::round(high * kRadiiPerTexel) / kRadiiPerTexel, radii.front(), radii.back());
}

}  // namespace shadowbench::filters
