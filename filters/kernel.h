#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

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

}  // namespace shadowbench::filters
