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

/// What a width stands for, in texels.
double parse_width(const FilterSpec& spec, const std::string& width) {
  if (const auto texels = find_width(width)) return *texels;
  refuse_width(spec, width, explain_no_width(width));
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

/// The radii of a filter, and the width of its kernel with each.
class RadiusRange {
 public:
  RadiusRange(const FilterSpec& spec, const ParamValues& values, const std::string& name)
      : spec_(spec), values_(values), param_(*spec.find_param(name)), radii_(list_radii(param_)) {}

  double sigma_at(double radius) const {
    ParamValues trial = values_;
    trial[param_.name] = radius;
    return *find_kernel_sigma(spec_, trial);
  }
  double narrowest() const { return sigma_at(radii_.front()); }
  double widest() const { return sigma_at(radii_.back()); }

  /// The radius nearest to a width; of whole numbers and choices one within the class, where there is one.
  double find_nearest(double wanted, const WidthClass* wanted_class) const {
    if (param_.integer || !param_.choices.empty()) {
      const auto distance = [&](double radius) {
        const double sigma = sigma_at(radius);
        const double strays = wanted_class && find_width_class(sigma) != wanted_class ? 1e3 : 0.0;
        return strays + std::abs(std::log(sigma / wanted));
      };
      return *std::ranges::min_element(radii_, {}, distance);
    }
    double low = radii_.front(), high = radii_.back();
    while (high - low > 0.01 / kRadiiPerTexel) {
      const double middle = 0.5 * (low + high);
      (sigma_at(middle) < wanted ? low : high) = middle;
    }
    return std::clamp(std::round(high * kRadiiPerTexel) / kRadiiPerTexel, radii_.front(), radii_.back());
  }

 private:
  const FilterSpec& spec_;
  const ParamValues& values_;
  const ParamSpec& param_;
  std::vector<double> radii_;
};

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

std::vector<std::string> list_width_names() {
  std::vector<std::string> names;
  for (const WidthClass& each : width_classes()) names.emplace_back(each.name);
  names.emplace_back(kLightWidth);
  return names;
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

std::optional<double> find_width(const std::string& width) {
  for (const WidthClass& each : width_classes())
    if (each.name == width) return each.sigma_texels;
  double texels = 0.0;
  const auto [end, error] = std::from_chars(width.data(), width.data() + width.size(), texels);
  const bool is_number = error == std::errc() && end == width.data() + width.size() && std::isfinite(texels);
  return is_number ? std::optional(texels) : std::nullopt;
}

std::string explain_no_width(const std::string& width) {
  return "it is no number of texels, and no class" + did_you_mean_or_known(width, list_width_names());
}

const std::string* find_width_param(const FilterSpec& spec, const ParamValues& values) {
  const auto* name = std::get_if<std::string>(&spec.radius_texels);
  return name && find_kernel_sigma(spec, values) ? name : nullptr;
}

const std::string& require_width_param(const FilterSpec& spec, const ParamValues& values, const std::string& width) {
  if (const std::string* name = find_width_param(spec, values)) return *name;
  const auto sigma = find_kernel_sigma(spec, values);
  const auto* name = std::get_if<std::string>(&spec.radius_texels);
  refuse_width(spec, width,
               name ? fmt::format("{}; set '{}' itself", explain_no_kernel(spec), *name)
                    : "the filter has no radius that a width could set" +
                          (sigma ? fmt::format("; its kernel is {:.3g} texels wide", *sigma) : std::string()));
}

double find_nearest_radius(const FilterSpec& spec, const ParamValues& values, double sigma_texels) {
  const RadiusRange range(spec, values, *find_width_param(spec, values));
  return range.find_nearest(std::clamp(sigma_texels, range.narrowest(), range.widest()), nullptr);
}

double solve_radius(const FilterSpec& spec, const ParamValues& values, const std::string& width) {
  const double wanted = parse_width(spec, width);
  const std::string& name = require_width_param(spec, values, width);
  const RadiusRange range(spec, values, name);
  if (!(wanted >= range.narrowest() * (1.0 - kSlack) && wanted <= range.widest() * (1.0 + kSlack)))
    refuse_width(spec, width,
                 fmt::format("no '{}' gives this; choose a class ({}) or {:.3g} .. {:.3g} texels", name,
                             fmt::join(list_width_names(), ", "), range.narrowest(), range.widest()));
  const auto named = std::ranges::find(width_classes(), width, &WidthClass::name);
  return range.find_nearest(wanted, named == width_classes().end() ? nullptr : &*named);
}

}  // namespace shadowbench::filters
