#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "filters/filter_spec.h"

namespace shadowbench::filters {

/// How a filter reads between the texels of a map.
enum class Reconstruction {
  kNearest,   ///< the texel that holds the position: a point of the continuous kernel
  kBilinear,  ///< the four texels around it: the unit tent per axis
  kTexel,     ///< every texel by the part of the shape that lies over it: the unit box per axis
};

/// The weights of the prefilter for texels -radius .. radius; they sum to 1.
///
/// A Gaussian with a standard deviation of half the radius, so that the outermost weight is e^-2 of the middle one;
/// radius 0 is one texel. Shared by the shaders (as a uniform) and the models.
std::vector<float> gaussian_weights(int radius_texels);

/// The kernel that a filter averages the map with, in texels around the receiver: a shape convolved with the
/// reconstruction. It has two faces: weights on the texel grid for a receiver somewhere between texels (K), and a
/// continuous density (k) that rays can sample. Both sum to 1 and are symmetric.
class Kernel {
 public:
  /// One position of a shape on one axis.
  struct Atom {
    double offset = 0.0;  ///< texels
    double weight = 1.0;
  };

  /// The receiver's own position.
  static Kernel make_point(Reconstruction reconstruction);

  /// The same atoms along both axes, as a product. Requires weights that sum to 1, offsets that ascend.
  static Kernel make_grid(std::vector<Atom> atoms, Reconstruction reconstruction);

  /// As many equal weights along both axes, a texel apart.
  static Kernel make_box(int taps, Reconstruction reconstruction = Reconstruction::kBilinear);

  /// The weights of the Gaussian prefilter; see gaussian_weights().
  static Kernel make_gaussian(int radius_texels, Reconstruction reconstruction);

  /// A uniform disk, read bilinearly.
  static Kernel make_disk(double radius_texels);

  /// The same triangle along both axes, as a product, integrated over each texel. Requires a half-width over 0.
  static Kernel make_triangle(double half_width_texels);

  /// A point of the continuous kernel, in texels; `shape` and `between` in [0,1)^2, equal areas for equal weights.
  glm::dvec2 sample(const glm::dvec2& shape, const glm::dvec2& between) const;

  /// The half-width of the square outside which the continuous kernel is 0, in texels.
  double half_width() const;

  /// The standard deviation along an axis, in texels. A nearest read counts as the texel that it stands for: averaged
  /// over the receiver's place between texels, it spreads an edge over one.
  double sigma_texels() const;

  /// Whether the continuous kernel is a single point.
  bool is_point() const;

  Reconstruction reconstruction() const { return reconstruction_; }
  const std::vector<Atom>& atoms() const { return atoms_; }  ///< per axis; empty for other shapes
  double disk_radius() const { return disk_radius_; }        ///< texels; 0 for other shapes
  double triangle() const { return triangle_; }              ///< half-width in texels; 0 for other shapes

  /// A name that no other kernel has.
  std::string name() const;

 private:
  std::vector<Atom> atoms_;
  double disk_radius_ = 0.0;
  double triangle_ = 0.0;
  Reconstruction reconstruction_ = Reconstruction::kNearest;

  glm::dvec2 sample_shape(const glm::dvec2& u) const;
};

// How wide a filter's kernel is: its standard deviation along an axis, reconstruction included, in texels. Filters are
// compared where their kernels are about equally wide; otherwise a comparison of filters would be one of widths.

/// Kernels that are about equally wide.
struct WidthClass {
  std::string_view name;
  double sigma_texels = 0.0;   ///< the width that it stands for
  double widest_texels = 0.0;  ///< the widest kernel that belongs to it
};

/// The classes, narrow before wide. *Sharp* is as wide as one hardware 2x2 fetch, *medium* as the 3x3 tent of four, and
/// *soft* as a disk with a radius of 3 texels, the customary one of Poisson-disk filters. A kernel belongs to the class
/// whose width is nearest to its own in ratio; soft ends where a class as far above it as it is above medium would
/// begin.
const std::array<WidthClass, 3>& width_classes();

/// The class of a kernel of this width; null where it is wider than the widest class reaches.
const WidthClass* find_width_class(double sigma_texels);

/// In place of a class: the width that a scene's light asks for, in each map. Filters of that width are compared with
/// each other and with those that have no width to choose, however wide they are.
inline constexpr std::string_view kLightWidth = "light";

/// The names of the classes, narrow before wide, and kLightWidth.
std::vector<std::string> list_width_names();

/// The standard deviation of the kernel that does to an edge what a light does whose penumbra has this width. A light's
/// disk, projected through the edge, is a disk as wide as the penumbra, with which the edge is convolved; a disk of
/// radius R has a standard deviation of R / 2 along an axis: a quarter of its width.
inline double sigma_of_penumbra(double width) { return 0.25 * width; }

/// Lists the classes with their widths and limits: "sharp 0.41 texels, up to 0.51; ...".
std::string describe_classes();

/// The width of a filter's kernel; empty where find_kernel() finds none.
std::optional<double> find_kernel_sigma(const FilterSpec& spec, const ParamValues& values);

/// The texels that the name of a class or a number stands for; empty for any other text, and why that is none.
std::optional<double> find_width(const std::string& width);
std::string explain_no_width(const std::string& width);

/// The parameter that a width sets, where a filter has one; null without, and where the filter's kernel is not known.
const std::string* find_width_param(const FilterSpec& spec, const ParamValues& values);

/// The same. Throws Error(kUsage) as solve_radius() where the filter has none.
const std::string& require_width_param(const FilterSpec& spec, const ParamValues& values, const std::string& width);

/// Finds the radius whose kernel is nearest to so many texels in ratio: the narrowest or the widest where none reaches
/// them. Requires a find_width_param().
double find_nearest_radius(const FilterSpec& spec, const ParamValues& values, double sigma_texels);

/// Finds the radius with which a filter's kernel is as wide as asked for, the other parameters being as in `values`.
/// `width` is the name of a class or a number of texels. Of whole-numbered radii, and of choices, it is the one whose
/// width is nearest in ratio, within the class where one is named; others are found to a thousandth of a texel.
/// Throws Error(kUsage) where the filter has no radius or no kernel, for a width that is neither, and, with the range
/// that can be reached, for one that no radius gives.
double solve_radius(const FilterSpec& spec, const ParamValues& values, const std::string& width);

}  // namespace shadowbench::filters
