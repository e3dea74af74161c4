#include "harness/engines/alignment.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>

#include "base/error.h"
#include "report/records/format.h"

namespace shadowbench::engines {
namespace {

using images::Image;
using Mask = std::vector<std::uint8_t>;

constexpr double kLeastShareOfDepth = 1e-4;  // 1 / depth is exact but for its rounding
constexpr double kLeastShareOfEdges = 0.03;  // pixels of an edge are off by up to half a pixel each
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Sums of a least-squares fit of a shift s to e = -g.s, where e is what theirs has more than ours and g our gradient.
class ShiftFit {
 public:
  void add(const glm::dvec2& gradient, double difference) {
    products_ += glm::outerProduct(gradient, gradient);
    right_ -= difference * gradient;
  }

  /// What gradients of one direction alone leave open along the other is taken to be 0: where their squares there sum
  /// to less than `least_share` of those of the first. Nothing where there are none.
  std::optional<glm::dvec2> solve(double least_share) const {
    const double half_trace = 0.5 * (products_[0][0] + products_[1][1]);
    const double radius = std::hypot(0.5 * (products_[0][0] - products_[1][1]), products_[0][1]);
    const double largest = half_trace + radius, least = half_trace - radius;
    if (!(largest > 0.0)) return std::nullopt;
    if (least >= least_share * largest) return glm::inverse(products_) * right_;
    const glm::dvec2 across(products_[0][1], largest - products_[0][0]),
        other(largest - products_[1][1], products_[0][1]);
    const glm::dvec2 axis = glm::normalize(glm::length(across) > glm::length(other) ? across : other);
    return axis * (glm::dot(axis, right_) / largest);
  }

 private:
  glm::dmat2 products_{0.0};
  glm::dvec2 right_{0.0};
};

/// Two fields of one view, and the pixels in which they say where it lies.
struct Fields {
  const Image& ours;
  const Image& theirs;
  std::function<bool(std::size_t pixel, const glm::dvec2& gradient)> is_used;
  double least_share;  ///< see ShiftFit::solve()
};

/// How far apart two fields are.
struct ShiftFound {
  std::optional<glm::dvec2> shift;
  std::vector<double> distances;  ///< of each pixel, along the gradient
  std::size_t far = 0;            ///< pixels in which they have nothing to do with each other
};

ShiftFound find_shift(const Fields& fields) {
  const auto& [ours, theirs, is_used, least_share] = fields;
  ShiftFit fit;
  ShiftFound found;
  for (std::size_t i = 0; i < ours.texels.size(); ++i) {
    const auto left = step(i, -1, 0, ours.width, ours.height), right = step(i, 1, 0, ours.width, ours.height),
               up = step(i, 0, -1, ours.width, ours.height), down = step(i, 0, 1, ours.width, ours.height);
    if (!left || !right || !up || !down) continue;
    const auto at = [&](std::size_t pixel) { return static_cast<double>(ours.texels[pixel]); };
    const glm::dvec2 gradient(0.5 * (at(*right) - at(*left)), 0.5 * (at(*down) - at(*up)));
    const double length = glm::length(gradient);
    if (!(length > 0.0) || !is_used(i, gradient)) continue;
    const double difference = static_cast<double>(theirs.texels[i]) - at(i);
    constexpr double kFarthest = 3.0;  // pixels; beyond, theirs is another surface
    if (!(std::abs(difference) <= kFarthest * length)) {
      ++found.far;
      continue;
    }
    fit.add(gradient, difference);
    found.distances.push_back(std::abs(difference) / length);
  }
  found.shift = fit.solve(least_share);
  return found;
}

/// 1 / depth is linear over a plane's picture; 0 where nothing is.
Image invert_depth(const Image& depth) {
  Image inverse = depth;
  for (float& value : inverse.texels) value = std::isfinite(value) && value > 0.0f ? 1.0f / value : 0.0f;
  return inverse;
}

/// Nothing is found from what is no depth of this view, and that is said.
Alignment align_by_depth(const Image& depth, const OwnView& own, std::vector<Finding>& findings) {
  const Image ours = invert_depth(own.depth), theirs = invert_depth(depth);
  const auto is_plane = [&](std::size_t i, const glm::dvec2& gradient) {
    constexpr double kMostBend = 0.05;  // second over first difference
    const auto bend = [&](int dx, int dy) {
      const std::size_t before = *step(i, -dx, -dy, ours.width, ours.height),
                        after = *step(i, dx, dy, ours.width, ours.height);
      if (ours.texels[before] == 0.0f || ours.texels[after] == 0.0f) return 1e9;
      return std::abs(static_cast<double>(ours.texels[before]) + static_cast<double>(ours.texels[after]) -
                      2.0 * static_cast<double>(ours.texels[i]));
    };
    // Single precision leaves depth uncertain by so much, which a surface across the view has as its whole gradient.
    const double rounding = 1e-5 * static_cast<double>(ours.texels[i]);
    const double length = glm::length(gradient);
    return ours.texels[i] != 0.0f && length > rounding && bend(1, 0) <= kMostBend * length &&
           bend(0, 1) <= kMostBend * length;
  };
  ShiftFound fit = find_shift({ours, theirs, is_plane, kLeastShareOfDepth});
  if (fit.far > fit.distances.size()) {
    findings.push_back(
        {false, fmt::format("its depth is not that of our surfaces at {} of the pixels: metres along the "
                            "camera's axis are wanted, positive, and no depth of a projection",
                            records::format_rate(static_cast<double>(fit.far) /
                                                 static_cast<double>(fit.far + fit.distances.size())))});
    return {};
  }
  if (fit.distances.empty()) return {};
  const auto place =
      fit.distances.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(fit.distances.size() - 1));
  std::nth_element(fit.distances.begin(), place, fit.distances.end());
  return {"depth", fit.shift, *place};
}

/// Weights 1 2 1 along both axes: the edge of a mask becomes a ramp, whose shift shows in every pixel.
Image blur(const Mask& mask, int width, int height) {
  Image blurred(width, height, 1);
  for (std::size_t i = 0; i < mask.size(); ++i) {
    float sum = 0.0f;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (const auto n = step(i, dx, dy, width, height))
          sum += static_cast<float>((2 - std::abs(dx)) * (2 - std::abs(dy)) * mask[*n]);
    blurred.texels[i] = sum / 16.0f;
  }
  return blurred;
}

/// Which pixels theirs covers, and which ours: receivers by unlit, or else surfaces by depth; empty without either.
std::array<Mask, 2> find_coverage(const ExternalImages& images, const OwnView& own) {
  Mask theirs;
  const float least = images.unlit ? least_light(*images.unlit) : 0.0f;
  if (images.unlit)
    for (const float value : images.unlit->texels) theirs.push_back(value > least ? 1 : 0);
  else if (images.depth)
    for (const float value : images.depth->texels) theirs.push_back(std::isfinite(value) && value > 0.0f ? 1 : 0);
  else
    return {};
  return {images.unlit ? own.counts : own.is_surface, theirs};
}

/// A mistake in how a picture was drawn: where the pixel that ours shows at a place lies in theirs, both from the
/// middle of the picture in units of half its width and height.
struct Mistake {
  const char* text;
  std::function<glm::dvec2(const glm::dvec2&)> place;
};

std::vector<Mistake> list_mistakes(double aspect) {
  return {{"it is upside down: rows are to run from top to bottom, and OpenGL reads them from the bottom",
           [](const glm::dvec2& p) { return glm::dvec2(p.x, -p.y); }},
          {"it is mirrored from left to right: a left-handed engine, or the x axis of a position, was flipped",
           [](const glm::dvec2& p) { return glm::dvec2(-p.x, p.y); }},
          {"it is turned by 180 degrees: rows and columns run the wrong way", [](const glm::dvec2& p) { return -p; }},
          {"rows and columns are exchanged", [](const glm::dvec2& p) { return glm::dvec2(p.y, p.x); }},
          {"it is too wide: the camera's aspect is 1, and not width / height",
           [=](const glm::dvec2& p) { return glm::dvec2(p.x * aspect, p.y); }},
          {"it is too narrow: the camera's aspect is height / width, or was applied twice",
           [=](const glm::dvec2& p) { return glm::dvec2(p.x / aspect, p.y); }},
          {"it is magnified: the vertical field of view was taken as the horizontal one",
           [=](const glm::dvec2& p) { return p * aspect; }}};
}

/// The share of pixels that one covers and the other does not, where theirs was drawn with that mistake.
double measure_disagreement(const std::array<Mask, 2>& coverage, int width, int height, const Mistake& mistake) {
  const auto& [ours, theirs] = coverage;
  const glm::dvec2 half(0.5 * width, 0.5 * height);
  double compared = 0.0, apart = 0.0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const glm::dvec2 middle(static_cast<double>(i % static_cast<std::size_t>(width)) + 0.5,
                            static_cast<double>(i / static_cast<std::size_t>(width)) + 0.5);
    const glm::dvec2 place = mistake.place((middle - half) / half) * half + half;
    if (!(place.x >= 0.0 && place.y >= 0.0 && place.x < width && place.y < height)) continue;
    compared += 1.0;
    apart +=
        ours[i] !=
        theirs[static_cast<std::size_t>(place.y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(place.x)];
  }
  return compared > 0.0 ? apart / compared : 1.0;
}

void check_orientation(const std::array<Mask, 2>& coverage, int width, int height, std::vector<Finding>& findings) {
  constexpr double kAlike = 0.02, kMuchLess = 0.35, kMost = 0.1;
  const Mistake none{"", [](const glm::dvec2& p) { return p; }};
  const double apart = measure_disagreement(coverage, width, height, none);
  if (apart <= kAlike) return;
  double least = apart;
  std::string cause;
  for (const Mistake& mistake : list_mistakes(static_cast<double>(width) / height)) {
    const double own = measure_disagreement(coverage, width, height, mistake);
    if (own < least) least = own, cause = mistake.text;
  }
  if (least < kMuchLess * apart)
    findings.push_back({true, fmt::format("{} of the pixels show something else than ours: {} (then {})",
                                          records::format_rate(apart), cause, records::format_rate(least))});
  else if (apart > kMost)
    findings.push_back({true, fmt::format("{} of the pixels show something else than ours: the camera, the model or "
                                          "the light's direction is another one",
                                          records::format_rate(apart))});
}

void check_shift(const Alignment& found, std::vector<Finding>& findings) {
  if (!found.shift) {
    findings.push_back({false, "whether it lies on our pixels is not known: give --depth, or --unlit"});
    return;
  }
  const double length = glm::length(*found.shift), farthest = std::max(length, found.p99.value_or(0.0));
  if (farthest <= kWarnedShift) return;
  if (length < 0.5 * farthest) {
    findings.push_back({farthest > kMostShift,
                        fmt::format("it is scaled, turned or bent against ours: {:.2f} pixels apart at the 99th "
                                    "percentile, and {:.2f} as a whole: another field of view, aspect or tilt",
                                    farthest, length)});
    return;
  }
  const bool is_half = std::abs(length - 0.5) < 0.15 || std::abs(length - std::sqrt(0.5)) < 0.15;
  findings.push_back(
      {farthest > kMostShift,
       fmt::format("it lies {:.2f} pixels right and {:.2f} down of ours, found from {}: {}", found.shift->x,
                   found.shift->y, found.by,
                   is_half ? "half a pixel, as where a picture is resampled, or pixels' corners are taken for their "
                             "middles"
                           : "a jittered or another camera, another field of view, or a picture that was resampled")});
}

/// Turns lit and unlit into visibility, and says what is wrong with the pair.
Image make_visibility(const ExternalImages& images, const OwnView& own, std::vector<Finding>& findings) {
  if (!images.lit || !images.unlit) return *images.visibility;
  const Image &lit = *images.lit, &unlit = *images.unlit;
  Image visibility(lit.width, lit.height, 1);
  double receivers = 0.0, brighter = 0.0, darker = 0.0, lights = 0.0;
  for (std::size_t i = 0; i < visibility.texels.size(); ++i) {
    const float a = lit.texels[i], b = unlit.texels[i];
    visibility.texels[i] = b > 0.0f && std::isfinite(a) && std::isfinite(b) ? a / b : kNaN;
    if (!own.counts[i]) continue;
    receivers += 1.0;
    lights += a != 0.0f || b != 0.0f;
    const float allowed = 1e-3f * std::max(std::abs(a), std::abs(b));
    brighter += a > b + allowed;
    darker += a < b - allowed;
  }
  if (lights == 0.0)
    fail_input("lit and unlit are black at every receiver: the light is off, or nothing was drawn", images.names);
  constexpr double kFew = 1e-3;
  if (brighter == 0.0 && darker == 0.0)
    findings.push_back({true,
                        "lit equals unlit at every receiver: there are no shadows; casters, receivers or the "
                        "light's map are switched off"});
  else if (brighter > kFew * receivers && darker <= kFew * receivers)
    findings.push_back({true, "lit is brighter than unlit, and nowhere darker: the two files are exchanged"});
  else if (brighter > kFew * receivers)
    findings.push_back({false, fmt::format("lit is brighter than unlit at {} of the receivers: tone mapping, other "
                                           "light or noise is in the pictures",
                                           records::format_rate(brighter / receivers))});
  return visibility;
}

/// Surfaces that are seen from behind and are not in their picture, where hardly anything else is missing; said. Empty:
/// there are none.
Mask find_culled(const ExternalImages& images, const OwnView& own, std::vector<Finding>& findings) {
  const std::array<Mask, 2> coverage = find_coverage(images, own);
  if (own.is_back.empty() || coverage[0].empty()) return {};
  const Mask inside = find_inside(own, own.is_surface);
  double surfaces = 0.0, backs = 0.0, missing = 0.0, missing_backs = 0.0;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    if (!inside[i]) continue;
    constexpr float kAlike = 0.01f;
    const bool is_missing =
        coverage[0][i] != coverage[1][i] ||
        (images.depth && !(std::abs(images.depth->texels[i] / own.depth.texels[i] - 1.0f) <= kAlike));
    surfaces += 1.0;
    backs += own.is_back[i];
    missing += is_missing;
    missing_backs += is_missing && own.is_back[i];
  }
  // Without their depth, a surface before another that is as lit is not missed.
  constexpr double kFewest = 0.001, kOfMissing = 0.8, kOfBacks = 0.3;
  if (!(missing_backs > std::max({kFewest * surfaces, kOfMissing * missing, kOfBacks * backs}))) return {};
  findings.push_back(
      {false, fmt::format("{} of our surfaces are seen from behind, and are not in its picture: it culls "
                          "back faces. They are left out; draw both sides of every material",
                          records::format_rate(backs / surfaces))});
  return own.is_back;
}

/// What is seen without the surfaces that were culled: there theirs decides what is covered.
OwnView leave_out(OwnView own, const Mask& culled, const ExternalImages& images) {
  const Mask theirs = find_coverage(images, own)[1];
  for (std::size_t i = 0; i < culled.size(); ++i) {
    if (!culled[i]) continue;
    own.counts[i] = own.is_surface[i] = theirs[i];
    own.depth.texels[i] = own.direct.texels[i] = 0.0f;
    own.normals_ws[i] = glm::vec3(0.0f);
  }
  return own;
}

/// Says where shadows of open casters are missing, because faces of one side alone are in the map.
void check_casters(const Image& visibility, const OwnView& own, std::vector<Finding>& findings) {
  double shaded = 0.0, lit = 0.0;
  std::array<double, 4> shaded_by{}, lit_by{};  // by faces that block the light
  for (std::size_t i = 0; i < own.casters.size(); ++i) {
    if (own.casters[i] == 0 || !std::isfinite(visibility.texels[i])) continue;
    constexpr float kLit = 0.9f;
    const double is_lit = visibility.texels[i] > kLit;
    shaded += 1.0, shaded_by[own.casters[i]] += 1.0;
    lit += is_lit, lit_by[own.casters[i]] += is_lit;
  }
  constexpr double kFewest = 0.01, kMost = 0.8;
  const auto explains = [&](std::uint8_t faces) {
    return lit > kFewest * shaded && lit_by[faces] > kMost * shaded_by[faces] && lit_by[faces] > kMost * lit;
  };
  for (const auto& [faces, missing, kept] :
       {std::tuple(kFrontsCast, "front", "back"), std::tuple(kBacksCast, "back", "front")}) {
    if (!explains(faces)) continue;
    findings.push_back(
        {false, fmt::format("{} of what is wholly in shadow is lit, nearly all of it where only {} faces "
                            "block the light: its shadow map holds {} faces alone. Let both sides of "
                            "every material cast",
                            records::format_rate(lit / shaded), missing, kept)});
  }
}

}  // namespace

CheckedImages check_images(const ExternalImages& images, const OwnView& own) {
  const Image& any = images.visibility ? *images.visibility : *images.lit;
  if (any.width != own.depth.width || any.height != own.depth.height) {
    const bool is_turned = any.width == own.depth.height && any.height == own.depth.width;
    fail_input(fmt::format("it has {} x {} pixels, and the run's picture has {} x {}: {}", any.width, any.height,
                           own.depth.width, own.depth.height,
                           is_turned ? "width and height are exchanged"
                                     : "draw it in the size that scene.json says, without scaling for the display"),
               images.names);
  }
  CheckedImages checked;
  const Mask culled = find_culled(images, own, checked.findings);
  checked.visibility = make_visibility(images, own, checked.findings);
  for (std::size_t i = 0; i < culled.size(); ++i)
    if (culled[i]) checked.visibility.texels[i] = kNaN;
  check_casters(checked.visibility, own, checked.findings);
  std::int64_t receivers = 0;
  for (std::size_t i = 0; i < own.counts.size(); ++i) {
    if (!own.counts[i]) continue;
    ++receivers;
    if (std::isfinite(checked.visibility.texels[i])) continue;
    checked.visibility.texels[i] = kNaN;
    ++checked.undefined;
  }
  if (checked.undefined == receivers) fail_input("no receiver has a visibility: all are NaN, or not lit", images.names);
  constexpr double kMany = 0.01;
  const double share = static_cast<double>(checked.undefined) / static_cast<double>(receivers);
  if (share > kMany)
    checked.findings.push_back({false, fmt::format("{} of the receivers have no visibility (NaN, or unlit is 0): they "
                                                   "are left out",
                                                   records::format_rate(share))});
  const OwnView seen = leave_out(own, culled, images);
  const std::array<Mask, 2> coverage = find_coverage(images, seen);
  if (!coverage[0].empty()) {
    check_orientation(coverage, any.width, any.height, checked.findings);
    const Image ours = blur(coverage[0], any.width, any.height), theirs = blur(coverage[1], any.width, any.height);
    if (images.depth) checked.alignment = align_by_depth(*images.depth, seen, checked.findings);
    if (!checked.alignment.shift)
      checked.alignment = {
          "coverage", find_shift({ours, theirs, [](auto, const auto&) { return true; }, kLeastShareOfEdges}).shift, {}};
  }
  check_shift(checked.alignment, checked.findings);
  check_light(images, seen, checked.findings);
  return checked;
}

std::optional<std::size_t> step(std::size_t pixel, int dx, int dy, int width, int height) {
  const int x = static_cast<int>(pixel) % width + dx, y = static_cast<int>(pixel) / width + dy;
  if (x < 0 || y < 0 || x >= width || y >= height) return std::nullopt;
  return static_cast<std::size_t>(y * width + x);
}

std::vector<std::uint8_t> find_inside(const OwnView& own, const std::vector<std::uint8_t>& which) {
  std::vector<std::uint8_t> inside = which;
  const int width = own.depth.width, height = own.depth.height;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        constexpr float kBend = 0.97f, kJump = 0.05f;  // of normals, and of depths in a pixel
        const auto n = step(i, dx, dy, width, height);
        if (!n || !own.is_surface[*n] || glm::dot(own.normals_ws[i], own.normals_ws[*n]) < kBend ||
            std::abs(own.depth.texels[*n] / own.depth.texels[i] - 1.0f) > kJump)
          inside[i] = 0;
      }
    }
  }
  return inside;
}

}  // namespace shadowbench::engines
