#include "filters/model.h"
#include "filters/penumbra.h"
#include "filters/random.h"

namespace shadowbench::filters {
namespace {

template <class T>
class Smrt {
  using P = Position<T>;
  using Disk = PenumbraDisk<T>;

 public:
  explicit Smrt(const ModelInput& input)
      : map_(input),
        rays_(input),
        steps_(static_cast<int>(number(input.values, "steps"))),
        thickness_(static_cast<P>(number(input.values, "thickness"))),
        disk_(input.values) {}

  T visibility(const Receiver& r, Tally& tally) const {
    const DiskTurn<T> turn(rays_, r);
    P blocked{}, depths{};
    for (std::size_t i = 0; i < rays_.points.size(); ++i) {
      const P golden = (static_cast<P>(i) + P(0.5)) * P(0.61803399f), within = golden - std::floor(golden);
      const std::optional<float> depth = trace(r, turn.place(P(1), rays_.points[i]), within, tally);
      if (!depth) continue;
      blocked += P(1);
      depths += static_cast<P>(*depth);
    }
    Tally unused;
    if (blocked > P(0))
      tally.disk_radius_texels =
          static_cast<double>(disk_.radius(r, static_cast<P>(r.depth) - depths / blocked, unused));
    const P rays = static_cast<P>(rays_.points.size());
    return T(rays - blocked) / T(rays);
  }

 private:
  static constexpr float kRounding = 3e-7f;  // of the ends of a step, in depth

  DepthReader<T> map_;
  TurnedDisk rays_;
  int steps_;
  P thickness_;
  Disk disk_;

  P height_of(P step) const {
    const P share = step / static_cast<P>(steps_);
    return share * share;
  }

  /// The depth of the first surface that a ray crosses.
  std::optional<float> trace(const Receiver& r, const Offset<T>& point, P within, Tally& tally) const {
    for (int step = 0; step < steps_; ++step) {
      Tally unused;
      const P radius = disk_.radius(r, height_of(static_cast<P>(step) + within), unused);
      const Offset<T> offset{radius * point.x, radius * point.y};
      const P start = static_cast<P>(map_.nearest_depth(r, offset, Disk::biased(r, offset), unused));
      const auto low = static_cast<float>(start - height_of(static_cast<P>(step)));
      const auto high = static_cast<float>(start - height_of(static_cast<P>(step) + thickness_));
      const bool is_last = step == steps_ - 1;
      const auto crosses = [&](float depth) { return depth < low && (is_last || depth >= high); };
      const float depth = Disk::read_depth(map_, r, offset, crosses, tally);
      if (crosses(depth - kRounding) != crosses(depth + kRounding)) tally.excused = true;
      if (crosses(depth)) return depth;
    }
    return std::nullopt;
  }
};

}  // namespace

ScalarModel make_smrt_model() { return make_templated_model<Smrt>(); }

}  // namespace shadowbench::filters
