#pragma once

#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "harness/scene/scene.h"
#include "reference/truth/visibility.h"

namespace shadowbench::scene {

/// Chooses what the light's frustum encloses.
enum class FitMode {
  kSphere,    ///< a sphere around the scene: its size does not change when the light turns
  kTight,     ///< casters and receivers, as the light sees them
  kView,      ///< what the camera sees of the scene, with the casters between that and the light
  kCascades,  ///< slices of that, each with a layer of the map for itself
  kFocused,   ///< what the camera sees, its width and its length by themselves; see fit_warped() for this and the next
              ///< four
  kLispsm,
  kPsm,
  kTsm,
  kLogpsm,
  kParaboloid,  ///< of a point light: two halves in place of a cube's six faces
};

/// Whether the sun's map goes through a projection that follows the camera.
constexpr bool is_warped(FitMode mode) { return mode >= FitMode::kFocused && mode <= FitMode::kLogpsm; }

/// How cascades share what the camera sees.
struct CascadeRule {
  int count = 4;       ///< 2 .. 4
  double split = 0.5;  ///< 0: slices of equal depth, 1: of equal ratios of depth; between them: a mean of both
  std::vector<double> splits = {};  ///< metres, ascending: where all slices but the last end, in place of `split`
  double blend = 0.1;               ///< the last share of a slice, over which it fades into the next
  bool seen = false;                ///< split the depths that pixels show, and not those of all geometry in view
  double near_m = 0.0;              ///< where the first slice begins; 0: with what is in view
  double far_m = 0.0;               ///< where the last slice ends; 0: with what is in view

  bool operator==(const CascadeRule&) const = default;
};

/// `--fit` as it was asked for.
struct FitRule {
  FitMode mode = FitMode::kTight;
  CascadeRule cascades;  ///< FitMode::kCascades only

  /// Whether each camera has a map of its own.
  bool follows_view() const { return mode == FitMode::kView || mode == FitMode::kCascades || is_warped(mode); }
};

/// Every fit's name, as FitMode has them.
std::vector<std::string> list_fit_names();

/// The fit's name on the command line and in records.
std::string_view name_of(FitMode mode);

/// The rule as parse_fit_rule() reads it: "tight", "cascades:count=4,split=0.5,blend=0.1,depths=all",
/// "cascades:count=3,splits=5/20,blend=0.1,depths=all,far=80".
std::string describe_fit(const FitRule& rule);

/// All of these, as describe_fit() has each.
std::set<std::string> describe_fits(const std::vector<FitRule>& rules);

/// Reads a rule. Throws kUsage for a name that is no fit, or a key or value that cascades have not, with those there
/// are.
FitRule parse_fit_rule(std::string_view text);

/// Depths along a camera's axis, metres.
struct DepthSpan {
  double near_m = 0.0;
  double far_m = 0.0;
};

/// Where a camera stands, its axes, and how far it sees aside.
struct ViewAxes {
  explicit ViewAxes(const Camera& camera)
      : eye(camera.position_ws),
        forward(camera.forward_ws),
        right(glm::normalize(glm::cross(forward, glm::dvec3(camera.up_ws)))),
        up(glm::cross(right, forward)),
        half_height(0.5 * static_cast<double>(camera.orthographic_height_m)),
        tangent(std::tan(0.5 * static_cast<double>(camera.vertical_fov_rad))) {}

  glm::dvec3 eye, forward, right, up;
  double half_height;  ///< of an orthographic camera; else 0
  double tangent;      ///< of half the angle of view of another one
};

/// How far along its axis a camera sees a point, metres.
double view_depth(const Camera& camera, const glm::dvec3& point_ws);

/// The least and the greatest of these depths; without points the least is the largest number there is.
DepthSpan find_depth_span(const Camera& camera, const std::vector<glm::dvec3>& points);

/// The corners of the scene's triangles after cutting them at the sides of what a camera sees, in world space; empty
/// where it sees nothing, or nothing between the two depths of `span`. Surfaces behind others are kept. `aspect` is
/// width / height of the picture.
///
/// A perspective camera sees nothing behind itself; an orthographic one is not cut along its direction.
/// Cost: one pass over the triangles, in double.
/// Source: Sutherland and Hodgman 1974, Reentrant Polygon Clipping, CACM 17(1).
std::vector<glm::dvec3> list_visible_corners(const Scene& scene, const Camera& camera, double aspect,
                                             const std::optional<DepthSpan>& span = std::nullopt);

/// The eight corners of what a camera sees between two depths.
using ViewCorners = std::array<glm::dvec3, 8>;
ViewCorners list_view_corners(const Camera& camera, double aspect, const DepthSpan& span);

/// What a light's frustum is fitted to, and how.
struct FitRequest {
  FitMode mode = FitMode::kTight;
  int map_size = 1024;      ///< texels along a side
  double pad_texels = 0.0;  ///< stay free on every side
  bool snap = false;        ///< keep the texel grid fixed in the world while the camera or the scene's extent moves
  const Camera* camera = nullptr;  ///< for a fit that follows the view
  double aspect = 1.0;             ///< of its picture, width / height
  const Light* light = nullptr;    ///< in place of the scene's own
  glm::dvec2 shift_texels{0.0};    ///< moves the fitted map along its axes; at most half a texel, or padding is used up
  CascadeRule cascades = {};       ///< FitMode::kCascades only
  std::optional<DepthSpan> seen = {};  ///< the depths that pixels show, for cascades that split these
};

/// The depths along the camera's axis that a cascade serves, metres. It fades in and out linearly, as its neighbours
/// fade out and in: the shares of all cascades add up to 1 everywhere.
struct ViewSlice {
  double fade_in_begin = 0.0;
  double fade_in_end = 0.0;
  double fade_out_begin = 0.0;
  double fade_out_end = 0.0;
  double end_m = 0.0;  ///< what it was fitted to; the last slice also serves what lies beyond

  bool operator==(const ViewSlice&) const = default;
};

/// The directions that a face of a cube serves: those that are longest along its axis. Of directions that are as long
/// along two axes, x goes before y, and y before z.
struct CubeFace {
  int index = 0;  ///< +x, -x, +y, -y, +z, -z

  bool operator==(const CubeFace&) const = default;
};

inline constexpr int kCubeFaces = 6;
inline constexpr int kHalfSpheres = 2;

/// The directions that one of two paraboloids serves. One that is level is the first's.
struct HalfSphere {
  bool is_upper = false;  ///< the second; the first is the lower

  bool operator==(const HalfSphere&) const = default;
};

/// What a layer of a light's map serves of the receivers: all of them, or a share.
using LayerShare = std::variant<std::monostate, ViewSlice, CubeFace, HalfSphere>;

/// What the map of a light in the scene is drawn through. Depth is linear in the distance along the light's axis, as
/// all filters see it; the map stores the depth of the projection, a filters::DepthCurve with far_over_near().
struct PerspectiveMap {
  Beam beam;
  double near_m = 0.0;  ///< depth 0, metres along the axis
  double far_m = 0.0;   ///< depth 1

  double far_over_near() const { return far_m / near_m; }
  double distance(const glm::dvec3& point_ws) const { return glm::dot(point_ws - beam.position_ws, beam.axis_ws); }
};

/// How a point's place in the map follows from its place in the world; lib/map_shape.glsl does the same.
enum class MapShape {
  kPlane,        ///< a projection, that of the sun or of a lamp
  kWarped,       ///< a projection of the sun's map, with depth that stays linear
  kLogarithmic,  ///< the same, with v as the logarithm of w
  kParaboloid,   ///< half of all directions around a lamp
};

/// A map that is none of the light's own: the depths are written by the fragment shader.
inline bool is_curved(MapShape shape) { return shape != MapShape::kPlane; }

/// v = scale log(w) + offset.
struct LogCurve {
  double scale = 0.0;
  double offset = 0.0;

  bool operator==(const LogCurve&) const = default;
};

/// Where the directions of half a sphere lie in the map: in a circle.
struct Paraboloid {
  glm::dvec2 center{0.5};
  double radius = 0.5;

  bool operator==(const Paraboloid&) const = default;
};

/// The frustum of a light's square map: orthographic, over casters and receivers, or a perspective one around a cone.
struct LightFrustum {
  glm::dmat4 light_from_world{1.0};     ///< rigid; looks along -z
  glm::dmat4 clip_from_light{1.0};      ///< depth in [0,1], 0 near; of a warped map z is not divided by w
  glm::mat4 clip_from_world{1.0f};      ///< the product of both
  glm::mat4 uv_depth_from_world{1.0f};  ///< to (u, v, depth) in [0,1]; v = 0 is the map's first row, as in GL
  double width_ws = 0.0;                ///< side of the map, padding included; of a perspective one at its reference
  double texel_size_ws = 0.0;           ///< likewise: it grows with the distance
  double depth_range_ws = 0.0;          ///< from depth 0 to depth 1
  bool projective = false;  ///< uv_depth_from_world ends with a division by w, which is negative behind the light
  glm::vec3 direction_ws{0.0f, 0.0f, 1.0f};   ///< the way the light travels, unit length
  std::optional<PerspectiveMap> perspective;  ///< then u and v end with the division, and depth does not
  MapShape shape = MapShape::kPlane;
  LogCurve log_curve;     ///< MapShape::kLogarithmic only
  Paraboloid paraboloid;  ///< MapShape::kParaboloid only
  int layer = 0;          ///< of the light's map
  LayerShare share;       ///< the receivers that this layer serves

  bool is_layered() const { return !std::holds_alternative<std::monostate>(share); }
  glm::dvec3 to_light(const glm::dvec3& point_ws) const;   ///< unit length
  double texel_size_at(const glm::dvec3& point_ws) const;  ///< metres; where texels are not square, of their area
  double map_texels() const { return width_ws / texel_size_ws; }

  /// Where a point lies in the map: texels from its corner, and depth.
  glm::dvec3 place(const glm::dvec3& point_ws, int map_size) const;
};

/// World axes seen by a light, which looks along -z; rows are its x, y and z.
glm::dmat3 light_rotation(const glm::dvec3& direction);

/// The texels along a side that padding and snapping leave. Throws kUsage for none.
double count_used_texels(const FitRequest& request);

/// Sets the matrices of a perspective map whose half side is `tangent` times the distance; `shift_clip` moves it along
/// its axes.
void set_perspective(LightFrustum& frustum, double tangent, const glm::dvec2& shift_clip);

/// How the place of a point in a light's map, texels, changes with the point.
truth::TexelGradients find_gradients(const LightFrustum& frustum, const glm::dvec3& point_ws);

/// Where a filter's kernel lies in the world.
truth::MapGrid make_map_grid(const LightFrustum& frustum);

/// Fits the frustum of a light's map to a validated scene; texels are square.
///
/// `pad_texels` of the map stay free on every side, for kernels of that half-width. Depth runs from the vertex nearest
/// to the light to the farthest one, so that every receiver's depth lies inside (0,1), even in 16 bits. A light with a
/// map window gets exactly that: receivers may lie outside and beyond the far plane. FitMode::kView encloses every
/// point that the camera sees, hidden ones too, and the casters before them; FitMode::kCascades does so for each slice
/// of the view, with `snap` around a sphere that holds the slice. A camera that sees nothing gets the tight fit.
///
/// With `snap`, the map's origin lies a whole number of texels from the world's origin, and a texel's size is rounded
/// up to a power of 2^(1/8): edges do not crawl while the camera moves. That costs one texel of the map's side.
///
/// Requires a camera for a fit that follows the view. Throws kUsage where the padding leaves no texel for the scene.
/// Cost: one or two passes over the vertices.
std::vector<LightFrustum> fit_layers(const Scene& scene, const FitRequest& request);

/// Whether the light's map follows the camera. If not, one map serves all cameras.
bool follows_camera(const Light& light, const FitRule& rule);

/// Whether two fits of one light have the same texels: they differ by whole texels, which change no filter's weights,
/// and in how they share receivers out by no more than rounding.
bool has_same_grid(const LightFrustum& a, const LightFrustum& b);

/// How many layers that makes.
int count_layers(const Light& light, const FitRule& rule);

/// The same for a fit that makes one layer.
LightFrustum fit_light(const Scene& scene, const FitRequest& request);
LightFrustum fit_light(const Scene& scene, FitMode mode, int map_size, double pad_texels);

/// Distances along a perspective map's axis of what stands in the map; nothing does where `farthest` is 0. Metres.
struct AxisExtent {
  double nearest = 0.0;
  double farthest = 0.0;

  /// Both in one.
  AxisExtent joined(const AxisExtent& other) const;
};

/// Finds what a square map sees that is drawn from a place in the scene: `light_from_world` looks along -z, and half
/// the map's side is `tangent` times the distance. A triangle that crosses the plane of the light begins at it.
AxisExtent find_extent(const Scene& scene, const glm::dmat4& light_from_world, double tangent);

/// The rigid transformation to a light's space, which looks along the beam's axis.
glm::dmat4 look_along(const Beam& beam);

/// The tangent of the map's half side that leaves `tangent` to the scene, and the rest to padding and snapping.
double pad_tangent(double tangent, const FitRequest& request);

/// The frustum of such a map, whose depth runs over `extent`.
LightFrustum fit_perspective(const Beam& beam, double tangent, const AxisExtent& extent, const FitRequest& request);

/// The depths at which cascades meet, metres from the camera along its axis; the first is where they begin and the last
/// where they end. With split 0 all are as deep, with 1 each is as many times deeper than the one before; else this is
/// the mean of both, weighted by `split`.
/// Source: Zhang, Sun, Xu and Lun 2006, Parallel-Split Shadow Maps for Large-Scale Virtual Environments, VRCIA, eq. 7.
/// Requires 0 < near_m < far_m.
std::vector<double> split_depths(const CascadeRule& rule, double near_m, double far_m);

/// The layers of a sun's map: see fit_layers().
std::vector<LightFrustum> fit_sun(const Sun& sun, const MapWindow* window, const Scene& scene,
                                  const FitRequest& request);

/// An orthographic frustum over these receivers, in world space, with the casters between them and the light; without
/// any, over the whole scene.
LightFrustum fit_sun_over(const Sun& sun, const Scene& scene, const FitRequest& request,
                          const std::vector<glm::dvec3>& receivers);

/// Fits the sun's map to what the camera sees as FitMode::kView does, but with more texels where the camera is near:
/// u and v go through a projection whose lines of equal w are across the view direction. Depth stays linear along the
/// light, so that every filter works as ever. Of each method this is what makes it different:
///
/// - kFocused: none at all; the map fits the view's width and length by themselves. What the others are measured by.
/// - kLispsm: w grows along the view from n = (z_n + sqrt(z_n z_f)) / sin(gamma), where gamma is the angle between view
///   and light. Source: Wimmer, Scherzer and Purgathofer 2004, Light Space Perspective Shadow Maps, EGSR.
/// - kPsm: the projection that the camera's own perspective leads to, after which a light at infinity is a lamp; the
///   camera steps back until that lamp sees everything in view.
///   Source: Stamminger and Drettakis 2002, Perspective Shadow Maps, SIGGRAPH; the step back: Kozlov 2004, Perspective
///   Shadow Maps: Care and Feeding, GPU Gems 14.
/// - kTsm: n so that the nearest kTrapezoidFocus of the length gets four fifths of the map.
///   Source: Martin and Tan 2004, Anti-aliasing and Continuity with Trapezoidal Shadow Maps, EGSR.
/// - kLogpsm: u as in a perspective map of n = z_n / sin(gamma), v as the logarithm of w: texels grow with the distance
///   along both. Source: Lloyd, Govindaraju, Quammen, Molnar and Manocha 2008, Logarithmic Perspective Shadow Maps,
///   TOG.
///
/// Where the view is along the light, all are kFocused. Requires a camera. Throws kUsage for `snap`, which a map whose
/// texels change with the camera cannot do.
LightFrustum fit_warped(const Sun& sun, const Scene& scene, const FitRequest& request);

inline constexpr double kTrapezoidFocus = 0.25;

}  // namespace shadowbench::scene
