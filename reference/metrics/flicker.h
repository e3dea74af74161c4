#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace shadowbench::metrics {

/// A visibility goes back and forth where it turns and comes back by more than this.
inline constexpr float kReturn = 0.05f;

/// How the visibility of fixed receivers changes from frame to frame, and how that differs from how the truth changes.
/// Source: derived; with d and e the changes of image and truth from one frame to the next, at one receiver.
struct FlickerStats {
  std::int64_t receivers = 0;  ///< pixels of the mask
  std::int64_t not_finite =
      0;  ///< pairs of a receiver and a step that are left out, because the image is NaN or infinite there
  double change = 0.0;              ///< root mean square of d, over receivers and steps
  double truth_change = 0.0;        ///< root mean square of e
  double flicker = 0.0;             ///< root mean square of d - e: change that the image has too much or too little
  double returning = 0.0;           ///< share of the receivers that went back and forth by more than kReturn
  double truth_returning = 0.0;     ///< the same share for the truth
  std::vector<double> step_change;  ///< of each step, the root mean square of d over receivers
  std::vector<double> truth_step_change;  ///< of each step, that of e
  std::vector<float> by_pixel;            ///< root mean square of d - e over the steps; 0 outside the mask
};

/// How much images of the same receivers differ that are independent of each other.
struct Change {
  double value = 0.0;                ///< root mean square over receivers and pairs of images
  std::optional<double> reach = {};  ///< half-width of its 95 % interval, by the jackknife; none for two groups
};

/// The `change` between frames that are independent of each other, where the truth has none. Every `group` images that
/// follow each other are no such frames, being chosen to differ: only pairs of two groups count, so that the result
/// does not depend on how large the groups are. `mask` is not 0 where a pixel counts; a receiver that is not finite in
/// one image is left out. Nothing for fewer than two groups or where no receiver is left.
/// Source: the mean over pairs is Hoeffding's U-statistic; its interval is Arvesen's (1969, Jackknifing U-Statistics,
/// Annals of Mathematical Statistics 40(6)).
std::optional<Change> measure_change(std::span<const std::span<const float>> images, std::size_t group,
                                     std::span<const std::uint8_t> mask);

/// Takes frames one by one and keeps no more than the last.
class FlickerMeter {
 public:
  /// `mask` is not 0 where a pixel counts in every frame.
  explicit FlickerMeter(std::vector<std::uint8_t> mask);

  /// Takes the next frame. Requires spans of the mask's length, and a finite truth where it counts.
  void add(std::span<const float> image, std::span<const float> truth);

  /// Gives nothing where no receiver counts or there are fewer than two frames.
  std::optional<FlickerStats> finish() const;

 private:
  /// Follows one value's turns.
  struct Turn {
    float farthest = 0.0f;  ///< the farthest value since the last turn
    std::int8_t way = 0;    ///< 1 up, -1 down, 0: no way yet
    bool returned = false;
    void follow(float value);
  };

  /// The sums and turns that are kept of an image, or of the truth.
  struct Track {
    std::vector<float> last;
    std::vector<Turn> turns;
    std::vector<double> step_change;
    double squares = 0.0;
    std::int64_t steps = 0;  ///< counted receiver by receiver
  };

  std::vector<std::uint8_t> mask_;
  Track image_, truth_;
  std::vector<double> excess_;              ///< by pixel, sums of squares
  std::vector<std::int32_t> excess_steps_;  ///< by pixel
  std::int64_t not_finite_ = 0;
  int frames_ = 0;

  void begin(Track& track, std::span<const float> values) const;
  void step(Track& track, std::span<const float> values) const;
  void compare(std::span<const float> image, std::span<const float> truth);
  double share_returned(const Track& track) const;
};

}  // namespace shadowbench::metrics
