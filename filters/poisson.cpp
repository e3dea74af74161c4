#include "filters/model.h"
#include "filters/penumbra.h"
#include "filters/random.h"

namespace shadowbench::filters {
namespace {

template <class T>
class Poisson {
  using P = Position<T>;

 public:
  explicit Poisson(const ModelInput& input)
      : map_(input),
        bail_(input.values),
        points_(bail_.order(generate_disk_points(input.spec, input.values, "disk_points"))),
        radius_(static_cast<P>(number(input.values, "radius"))),
        rotation_(text_or(input.values, "rotation", "none")),
        seed_(input.seed) {}

  static Kernel kernel(const ParamValues& values) { return Kernel::make_disk(number(values, "radius")); }

  T visibility(const Receiver& r, Tally& tally) const {
    const DiskTurn<T> turn(rotation_, r, seed_);
    return bail_.template average<T>(points_, tally, [&](const glm::vec2& point) {
      return map_.compare_2x2(r, turn.place(radius_, point), r.depth, tally);
    });
  }

 private:
  DepthReader<T> map_;
  EarlyBail bail_;
  std::vector<glm::vec2> points_;
  P radius_;
  std::string rotation_;
  std::uint32_t seed_;
};

}  // namespace

ScalarModel make_poisson_model() { return make_templated_model<Poisson>(); }

}  // namespace shadowbench::filters
