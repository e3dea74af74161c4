#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/measure/view_receivers.h"
#include "harness/options/options.h"
#include "harness/scene/lights/light.h"
#include "harness/scene/scene.h"
#include "reference/metrics/error_stats.h"
#include "reference/metrics/flip.h"
#include "reference/truth/cached_tracer.h"
#include "report/images/image.h"
#include "report/records/records.h"

namespace shadowbench::measure {

struct MeasuredCell;

/// How many of `phases` that follow each other make a group: two from eight on, where they are even, else one. The
/// groups are independent of each other; a mean over phases is as sure as means of groups agree.
std::size_t count_phases_of_group(std::size_t phases);

/// Where the map's grid stands in each of `count` phases: how far it is moved along its axes, each in [-1/2, 1/2)
/// texel. A single one is not moved. Every group begins anywhere, by `seed`, and its second phase is half a texel
/// farther along both axes, where what depends on the phase once a texel has the opposite sign. Phases of a smaller
/// count of pairs are the first of a larger one. Source: independent shifts of one set of points: Cranley and Patterson
/// 1976, Randomization of Number Theoretic Methods for Multiple Integration, SIAM Journal on Numerical Analysis 13(6);
/// antithetic pairs: Hammersley and Morton 1956.
std::vector<glm::dvec2> list_phase_shifts(int count, std::uint32_t seed);

/// Notes every metric of the table that measure_error() gives: its mean over the phases, which come in groups of
/// `group`, with the interval of the RMSE; the largest error is the largest of all.
void note_errors(records::CellRecord& record, const std::vector<metrics::ErrorStats>& phases, std::size_t group);

/// Notes how much the image changes from phase to phase, which is what moves under a turning light, as the flicker of a
/// map that does not follow the camera, and why it is not known below eight phases: at two and four it was -14 to +26 %
/// off what 8, 16 and 64 agree on within 4 %. Over 28 filters on `cubes` and `stack` it ranks them as a sun does that
/// turns by an eighth of a texel a frame, less what its traced truth changes: Spearman's rho 0.96 and 0.98.
/// Requires note_errors().
void note_flicker(records::CellRecord& record, const std::optional<metrics::Change>& change);

/// Notes how much the image changes by a step of the camera, in which the truth does not change, as the flicker of a
/// map that follows the camera.
void note_step(records::CellRecord& record, const std::optional<metrics::Change>& change);

/// Looks at a linear RGB picture as FLIP does, clamped to [0,1] as a display does. Gives nothing where a pixel is not
/// finite, which would spread over its neighbours. Requires three channels.
std::optional<metrics::FlipView> view_picture(const images::Image& picture,
                                              double pixels_per_degree = metrics::kDefaultPixelsPerDegree);

/// The mean of values over the pixels where `mask` is not 0, or over all where it is empty; nothing where none counts.
std::optional<double> find_mean(std::span<const float> values, std::span<const std::uint8_t> mask);

/// The mean LDR-FLIP of two pictures over the pixels where `mask` is not 0, or over all where it is empty; FLIP
/// itself has seen the whole pictures. Gives nothing where one of them is missing, or where no pixel counts. Requires
/// one size, and a mask of that size.
std::optional<double> measure_mean_flip(const std::optional<metrics::FlipView>& a,
                                        const std::optional<metrics::FlipView>& b,
                                        std::span<const std::uint8_t> mask = {});

/// The same of pictures that are compared only once.
std::optional<double> measure_mean_flip(const images::Image& a, const images::Image& b,
                                        std::span<const std::uint8_t> mask = {},
                                        double pixels_per_degree = metrics::kDefaultPixelsPerDegree);

/// Ray-traced visibility of one view's receivers, rows top to bottom like every report image.
struct SceneTruth {
  std::string absent;           ///< why there is none; empty where there is
  bool nothing_to_see = false;  ///< there is none, as no surface in view faces the light
  ViewReceivers receivers;
  truth::ViewRays rays;
  images::Image hard;                          ///< the light as a point: 1 seen, 0 blocked
  images::Image area;                          ///< what visibility is held against: see options::TruthWeight
  images::Image ratio;                         ///< the share of the unshadowed light that arrives
  images::Image hard_picture;                  ///< shaded with `hard`, linear RGB
  images::Image area_picture;                  ///< shaded with `ratio`, linear RGB
  std::optional<metrics::FlipView> area_seen;  ///< that picture, rounded to half as it is saved, as FLIP sees it
  std::vector<std::uint8_t> mask;              ///< 1 where a pixel counts: a surface that faces the light
  std::vector<std::uint8_t> settled;   ///< 1 where all rays above the pixel's own plane agree, and its neighbours'
  std::vector<float> penumbra_ws;      ///< width, metres: see scene::penumbra_width(); infinity where none is
  std::vector<float> standard_errors;  ///< of `area`, pixel by pixel
  double standard_error = 0.0;         ///< root mean square over the pixels that count
  double weight_rmse = 0.0;   ///< between the fraction of the light that is seen and `ratio`, over the same pixels
  double unanimous = 0.0;     ///< share of them whose rays all agree, and which therefore have no standard error
  std::int64_t lit = 0;       ///< of them: those that see any of the light
  std::int64_t penumbra = 0;  ///< of them: those that are not settled
};

/// Traces the receivers of a view; the pictures are left empty.
SceneTruth trace_scene(truth::CachedTracer& tracer, const scene::Light& light, ViewReceivers receivers,
                       options::TruthWeight weight = options::TruthWeight::kArea);

/// Measures the errors of visibility over a mask, of the first phase of the map's grid and then the others; one that is
/// empty, or of which nothing is finite, is left out. Requires a truth.
std::vector<metrics::ErrorStats> measure_phases(const images::Image& visibility,
                                                std::span<const images::Image> other_phases, const SceneTruth& truth,
                                                const std::vector<std::uint8_t>& mask);

/// Scores a cell's images against the truth and notes the errors, or why there are none, in its record: visibility over
/// the pixels that count, as the mean over the phases of the map's grid; and the mean LDR-FLIP of the picture against
/// the picture shaded with the area truth, which it leaves pixel by pixel in `flip`. Cost: about a second per
/// megapixel. Safe to call from many threads, each with its own cell.
void score(MeasuredCell& cell, const SceneTruth& truth);

/// Visibility less area truth where pixels count, 0 elsewhere; empty where there is no truth or no visibility.
images::Image make_error_image(const images::Image& visibility, const SceneTruth& truth);

/// The same to another image of truth, where the mask is 1.
images::Image make_error_image(const images::Image& visibility, const images::Image& truth,
                               const std::vector<std::uint8_t>& mask);

/// Empty unless the scene is too wide for single precision: rays of the truth start off their surfaces by a share of
/// its extent, truth::origin_offset(), and miss what is nearer. It is told from a tenth of a texel on. Measured on a
/// fence under a map of 8 m and 512 texels: by 0.15 texels the RMSE of pcf2x2 is 3 % off, by 0.6 it is 25 %.
std::string describe_wide_scene(const scene::Scene& scene, double texel_m);

}  // namespace shadowbench::measure
