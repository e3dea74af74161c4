#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace shadowbench::metrics {

// The faults that a person sees, each as a rate over a mask of receivers. Masks follow from rays, the same for all
// filters of one view and map; only the mask of noise follows from the filter's own kernel.

/// What rays say of each receiver of a view.
struct RaysAtReceivers {
  std::span<const std::uint8_t> counts;  ///< 0: background, or turned away from the light
  std::span<const float> area;           ///< fraction of the light that is seen
  std::span<const float> ratio;          ///< share of the light that arrives, of what the receiver's plane lets by
  std::span<const std::uint8_t> area_settled;  ///< all rays of the pixel and of its eight neighbours agree
  std::span<const float> surroundings;         ///< fraction of a square, wider than any kernel of the run, that is lit
  std::span<const std::uint8_t> surroundings_settled;  ///< the same for the surroundings
  std::span<const float> first_blocker_texels;  ///< of the receiver's map, along the light to the first surface there
};

/// Where each fault can occur; 1 inside.
struct ArtefactMasks {
  std::vector<std::uint8_t> acne;  ///< no surface hides any of the light, here, around and at neighbouring pixels
  std::vector<std::uint8_t>
      leak;  ///< wholly blocked, with its neighbours, by something that does not touch the receiver
  std::vector<std::uint8_t> contact_gap;  ///< wholly blocked, by something that touches the receiver
  std::vector<std::uint8_t> wide_gap;     ///< wholly blocked, by something farther: a gap only where bias lights it
};

/// The limits from which on an image has a fault that a person sees.
struct ArtefactLimits {
  double acne_below = 0.9;         ///< visibility of a wholly lit receiver, as a share of the truth's
  double guard_texels = 1.0;       ///< the surroundings reach beyond the run's widest kernel by this much
  double leak_above = 0.1;         ///< visibility of a wholly blocked receiver
  double contact_gap_above = 0.5;  ///< what bias adds to a receiver, no brighter without it, that touches its blocker
  double contact_texels = 8.0;     ///< a blocker nearer along the light touches the receiver; texels of its own map
  double seam_step = 1.0 / 160.0;  ///< of the picture's width: how far apart pixels are across which a seam is seen
  float seam_share = 1.0f / 4096.0f;  ///< shares of a layer that differ by less are the same
  double noise_above = 0.05;          ///< how far image less percentage-closer filter is from its own 3 x 3 mean
};
inline constexpr ArtefactLimits kArtefactLimits;

/// A rate over fewer receivers would say more of the view than of the filter.
inline constexpr int kFewestReceivers = 100;

ArtefactMasks make_artefact_masks(const RaysAtReceivers& rays);

/// The share of the mask's pixels that are darker than acne_below times `area`, the fraction of the light that is seen.
/// Pixels that are not finite are at fault. Gives nothing for a mask of fewer than kFewestReceivers.
std::optional<double> rate_acne(std::span<const float> image, std::span<const float> area,
                                std::span<const std::uint8_t> mask);

/// The share of the mask's pixels that are brighter than leak_above, under the same rules. Pixels that only bias lights
/// do not count: `unbiased`, the same filter without any bias, is no brighter than leak_above there, and `image` is by
/// more than that brighter. Where `unbiased` is empty, as little known, all count.
std::optional<double> rate_leak(std::span<const float> image, std::span<const float> unbiased,
                                std::span<const std::uint8_t> mask);

/// The share of wholly blocked receivers that bias lights (peter-panning): of those that something touches, and that
/// are not brighter than contact_gap_above in `unbiased`, the ones that are brighter in `image` by more than that. A
/// gap may be wider than contact_texels: receivers with a farther blocker count where bias lights kFewestReceivers of
/// them as much, and those alone. Blur lights both images alike, and so does a filter that fades towards contacts:
/// neither counts. Gives nothing where fewer than kFewestReceivers count, or where `unbiased` is empty.
std::optional<double> rate_contact_gap(std::span<const float> image, std::span<const float> unbiased,
                                       const ArtefactMasks& masks);

/// The share of a filter's penumbra that is noisy: the image less the brute-force percentage-closer filter of its
/// kernel deviates from its own mean over 3 x 3 pixels by more than noise_above. The penumbra is where the ray-traced
/// kernel lies strictly between 0 and 1 and all nine pixels count. Edges that the map draws as stairs are in image and
/// percentage-closer filter alike, and cancel. Meant for filters with random taps; others differ from their
/// percentage-closer filter by more than noise. Gives nothing where the penumbra has fewer than kFewestReceivers.
std::optional<double> rate_noise(std::span<const float> image, std::span<const double> closer,
                                 std::span<const float> kernel, std::span<const std::uint8_t> counts, int width);

/// One layer of a map: what the image would be, had it no other, NaN where the layer does not reach; and its share of
/// each pixel.
struct LayerImage {
  std::span<const float> visibility;
  std::span<const float> shares;
};

/// How much an image changes because layers of a map, such as cascades, take over from each other: the root mean
/// square, over pixels on one surface that layers share differently, seam_step of the picture's width apart (so that a
/// larger picture changes nothing), of the sum of what each of these layers shows at one of the two times the change of
/// its share. 0 where layers agree; where they do not, the wider they are blended the smaller it is. Gives nothing
/// where there are fewer than kFewestReceivers such places, all of whose layers reach them.
std::optional<double> measure_seam(std::span<const LayerImage> layers, int width,
                                   const std::function<bool(std::size_t, std::size_t)>& is_one_surface);

/// Penumbrae of an image beside those of the truth.
struct Penumbrae {
  std::span<const std::span<const float>> images;  ///< visibility, by the places of the map's grid: their mean counts
  std::span<const float> truth;                    ///< visibility of the whole light
  std::span<const std::uint8_t> mask;              ///< 1 where a pixel counts
  std::span<const float> width_ws;  ///< metres, of the penumbra that a receiver's blocker throws on it; infinity: none
  double texel_ws = 1.0;            ///< side of the map's texels, metres
  int columns = 0;                  ///< of the images
};

/// Which penumbrae tell how they grow.
struct GrowthLimits {
  int tile_pixels = 16;
  double least_texels = 2.0;   ///< narrower ones are as wide as the map's texels make them
  double most_texels = 24.0;   ///< wider ones are cut by a filter's `max_radius`, which is 12 where nobody changes it
  double least_pixels = 2.0;   ///< of penumbra in a tile
  int fewest_tiles = 12;       ///< that have so much
  double least_spread = 0.25;  ///< standard deviation of the widths' logarithms: a quarter is a factor of two and more
};
inline constexpr GrowthLimits kGrowthLimits;

/// Measures by how much the width of an image's penumbrae grows where that of the truth's grows by 1: 1 is as the
/// truth, 0 one width for all, below 0 the wrong way round.
///
/// The sum of v (1 - v) over a tile is the length of the edges in it times a sixth of their penumbrae's width, whatever
/// noise of mean 0 is in v. So the image's sum over the truth's, times the width that the blockers' distance gives, is
/// the width of its penumbrae. The growth is the slope of the line through these over the latter; each length of
/// edge weighs the same. Nothing where too little of the view tells.
std::optional<double> measure_penumbra_growth(const Penumbrae& penumbrae);

}  // namespace shadowbench::metrics
