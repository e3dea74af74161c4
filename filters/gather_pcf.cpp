#include "filters/texel_pairs.h"

namespace shadowbench::filters {
namespace {

/// What chooses among the kernels of texel_pairs.h.
struct Shape {
  int radius = 2;
  bool is_triangle = true;

  explicit Shape(const ParamValues& values)
      : radius(static_cast<int>(number(values, "radius"))), is_triangle(text_or(values, "shape", "") == "triangle") {}

  /// Gives `use` the kernel as a type.
  template <class Use>
  auto visit(Use use) const {
    switch (radius) {
      case 1: return is_triangle ? use(TrianglePairs<2>()) : use(SlidingPairs<1, 2, 1>());
      case 2: return is_triangle ? use(TrianglePairs<3>()) : use(SlidingPairs<1, 3, 4, 3, 1>());
      default: return is_triangle ? use(TrianglePairs<4>()) : use(SlidingPairs<1, 5, 12, 16, 12, 5, 1>());
    }
  }
};

template <class T>
class GatherPcf {
  using P = Position<T>;

 public:
  explicit GatherPcf(const ModelInput& input) : map_(input), shape_(input.values) {}

  static Kernel kernel(const ParamValues& values) {
    return Shape(values).visit([](auto pairs) { return pairs.kernel(); });
  }

  T visibility(const Receiver& r, Tally& tally) const {
    const Axis x = place(r.uv.x), y = place(r.uv.y);
    T sum{};
    for (std::size_t row = 0; row < y.weights.size(); row += 2) {
      for (std::size_t column = 0; column < x.weights.size(); column += 2) {
        const Offset<T> offset{x.first + static_cast<P>(column), y.first + static_cast<P>(row)};
        const auto lit = map_.gather_compare(r, offset, r.depth, tally);
        const T low = x.weights[column] * lit[3] + x.weights[column + 1] * lit[2];
        const T high = x.weights[column] * lit[0] + x.weights[column + 1] * lit[1];
        sum = sum + y.weights[row] * low + y.weights[row + 1] * high;
      }
    }
    return minimum(sum + make_uncertain<T>(0, bound_pair_placement(map_.grid().size())), T(P(1)));
  }

 private:
  struct Axis {
    P first{};               ///< offset of the first gather
    std::vector<T> weights;  ///< of texels
  };

  DepthReader<T> map_;
  Shape shape_;

  Axis place(float uv) const {
    const P t = map_.grid().fraction(uv);
    Axis axis{P(0.5) - static_cast<P>(shape_.radius) - t, {}};
    shape_.visit([&](auto pairs) {
      for (const P weight : pairs.template weigh<P>(t)) axis.weights.push_back(T(weight));
    });
    return axis;
  }
};

}  // namespace

ScalarModel make_gather_pcf_model() { return make_templated_model<GatherPcf>(); }

}  // namespace shadowbench::filters
