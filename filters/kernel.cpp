#include "filters/kernel.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "filters/model.h"
#include "filters/random.h"

namespace shadowbench::filters {
namespace {

/// Inverts the distribution of the unit tent on [-1,1].
double sample_tent(double u) { return u < 0.5 ? std::sqrt(2.0 * u) - 1.0 : 1.0 - std::sqrt(2.0 * (1.0 - u)); }

double sample_atoms(const std::vector<Kernel::Atom>& atoms, double u) {
  double sum = 0.0;
  for (const Kernel::Atom& atom : atoms) {
    sum += atom.weight;
    if (u < sum) return atom.offset;
  }
  return atoms.back().offset;
}

/// The half-width of what a reconstruction adds to a shape.
double half_width_of(Reconstruction reconstruction) {
  switch (reconstruction) {
    case Reconstruction::kNearest: return 0.0;
    case Reconstruction::kBilinear: return 1.0;
    case Reconstruction::kTexel: return 0.5;
  }
  return 0.0;
}

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

Kernel Kernel::make_point(Reconstruction reconstruction) { return make_grid({{0.0, 1.0}}, reconstruction); }

Kernel Kernel::make_grid(std::vector<Atom> atoms, Reconstruction reconstruction) {
  assert(!atoms.empty());
  Kernel kernel;
  kernel.atoms_ = std::move(atoms);
  kernel.reconstruction_ = reconstruction;
  return kernel;
}

Kernel Kernel::make_box(int taps, Reconstruction reconstruction) {
  std::vector<Atom> atoms;
  for (int i = 0; i < taps; ++i) atoms.push_back({i - 0.5 * (taps - 1), 1.0 / taps});
  return make_grid(std::move(atoms), reconstruction);
}

Kernel Kernel::make_gaussian(int radius_texels, Reconstruction reconstruction) {
  const std::vector<float> weights = gaussian_weights(radius_texels);
  std::vector<Atom> atoms;
  for (int i = -radius_texels; i <= radius_texels; ++i) {
    atoms.push_back(
        {static_cast<double>(i), static_cast<double>(weights[static_cast<std::size_t>(i + radius_texels)])});
  }
  return make_grid(std::move(atoms), reconstruction);
}

Kernel Kernel::make_disk(double radius_texels) {
  if (radius_texels <= 0.0) return make_point(Reconstruction::kBilinear);
  Kernel kernel;
  kernel.disk_radius_ = radius_texels;
  kernel.reconstruction_ = Reconstruction::kBilinear;
  return kernel;
}

Kernel Kernel::make_triangle(double half_width_texels) {
  assert(half_width_texels > 0.0);
  Kernel kernel;
  kernel.triangle_ = half_width_texels;
  kernel.reconstruction_ = Reconstruction::kTexel;
  return kernel;
}

glm::dvec2 Kernel::sample_shape(const glm::dvec2& u) const {
  if (triangle_ > 0.0) return triangle_ * glm::dvec2(sample_tent(u.x), sample_tent(u.y));
  if (atoms_.empty()) return disk_radius_ * map_to_disk(u);
  return {sample_atoms(atoms_, u.x), sample_atoms(atoms_, u.y)};
}

glm::dvec2 Kernel::sample(const glm::dvec2& shape, const glm::dvec2& between) const {
  const glm::dvec2 position = sample_shape(shape);
  if (reconstruction_ == Reconstruction::kNearest) return position;
  if (reconstruction_ == Reconstruction::kTexel) return position + between - 0.5;
  return position + glm::dvec2(sample_tent(between.x), sample_tent(between.y));
}

double Kernel::half_width() const {
  const double grid = atoms_.empty() ? 0.0 : std::max(-atoms_.front().offset, atoms_.back().offset);
  return grid + disk_radius_ + triangle_ + half_width_of(reconstruction_);
}

double Kernel::sigma_texels() const {
  // Variances add under convolution; those of a disk along an axis, of a triangle, of the unit tent and of a texel:
  double variance = 0.25 * disk_radius_ * disk_radius_ + triangle_ * triangle_ / 6.0;
  variance += reconstruction_ == Reconstruction::kBilinear ? 1.0 / 6.0 : 1.0 / 12.0;
  for (const Atom& atom : atoms_) variance += atom.weight * atom.offset * atom.offset;
  return std::sqrt(variance);
}

bool Kernel::is_point() const { return half_width() == 0.0; }

std::string Kernel::name() const {
  if (triangle_ > 0.0) return fmt::format("texel * triangle {}", triangle_);
  std::string text = reconstruction_ == Reconstruction::kBilinear ? "tent" : "point";
  if (atoms_.empty()) return text + fmt::format(" * disk {}", disk_radius_);
  for (const Atom& atom : atoms_) text += fmt::format(" {}:{}", atom.offset, atom.weight);
  return text;
}

std::vector<float> gaussian_weights(int radius_texels) {
  if (radius_texels == 0) return {1.0f};
  std::vector<double> exact;
  double sum = 0.0;
  for (int i = -radius_texels; i <= radius_texels; ++i) {
    const double deviations = 2.0 * i / radius_texels;
    exact.push_back(std::exp(-0.5 * deviations * deviations));
    sum += exact.back();
  }
  std::vector<float> weights;
  for (const double weight : exact) weights.push_back(static_cast<float>(weight / sum));
  return weights;
}

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
  return parse_number(width);
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
               name ? fmt::format("{}; set '{}' itself", explain_no_kernel(spec, values), *name)
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
