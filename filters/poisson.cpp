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
      : map_(input), bail_(input.values), taps_(input), radius_(static_cast<P>(number(input.values, "radius"))) {
    bail_.order(taps_.points);
  }

  static Kernel kernel(const ParamValues& values) { return Kernel::make_disk(number(values, "radius")); }

  T visibility(const Receiver& r, Tally& tally) const {
    const DiskTurn<T> turn(taps_, r);
    return bail_.template average<T>(taps_.points, tally, [&](const glm::vec2& point) {
      return map_.compare_2x2(r, turn.place(radius_, point), r.depth, tally);
    });
  }

 private:
  DepthReader<T> map_;
  EarlyBail bail_;
  TurnedDisk taps_;
  P radius_;
};

}  // namespace

ScalarModel make_poisson_model() { return make_templated_model<Poisson>(); }

}  // namespace shadowbench::filters
