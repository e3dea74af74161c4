#include "filters/disk_points.h"
#include "filters/model.h"
#include "filters/penumbra/early_bail.h"
#include "filters/penumbra/penumbra_disk.h"

namespace shadowbench::filters {
namespace {

template <class T>
class Poisson {
  using P = Position<T>;

 public:
  explicit Poisson(const ModelInput& input)
      : map_(input),
        points_(generate_disk_points(input.spec, input.values, "disk_points")),
        bail_(input.values),
        radius_(static_cast<P>(number(input.values, "radius"))),
        rotation_(text_or(input.values, "rotation", "none")),
        seed_(input.seed) {}

  static Kernel kernel(const ParamValues& values) { return Kernel::make_disk(number(values, "radius")); }

  T visibility(const Receiver& r, Tally& tally) const {
    const DiskTurn<T> turn(rotation_, r, seed_);
    T sum{};
    for (std::size_t i = 0; i < points_.size(); ++i) {
      sum = sum + map_.compare_2x2(r, turn.place(radius_, points_[bail_.order(i, points_.size())]), r.depth, tally);
      if (bail_.agrees(i, value_of(sum), tally)) return T(value_of(sum) > 0.0 ? P(1) : P(0));
    }
    return sum / T(static_cast<P>(points_.size()));
  }

 private:
  DepthReader<T> map_;
  std::vector<glm::vec2> points_;
  EarlyBail bail_;
  P radius_;
  std::string rotation_;
  std::uint32_t seed_;
};

}  // namespace

std::unique_ptr<ScalarModel> make_poisson_model() { return make_templated_model<Poisson>(); }

}  // namespace shadowbench::filters
