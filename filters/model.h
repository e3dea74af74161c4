#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "filters/kernel.h"
#include "filters/map_reader.h"
#include "filters/receiver.h"

namespace shadowbench::filters {

/// The arithmetic a model runs in.
enum class Precision {
  kFloat,     ///< as the GL does it
  kDouble,    ///< the reference
  kExtended,  ///< the reference where differences of nearly equal numbers leave double little: long double, 64 bits of
              ///< significand on x86
  kTracked,   ///< double, with a bound on what single precision can make of it
};

/// A model's result for one receiver.
struct ModelResult {
  double visibility = 1.0;
  double bound = 0.0;    ///< Precision::kTracked: |GL - visibility| cannot exceed this
  bool excused = false;  ///< a tap lies within one depth ULP of a tie or 4 ULP of a texel border: rounding decides
  /// Where the filter's kernel differs from receiver to receiver: that of this one, a uniform disk of this radius read
  /// through 2x2 texels; 0 for one fetch, and where the filter averages nothing.
  double disk_radius_texels = 0.0;
  double screen_value = 0.0;  ///< handed on to screen passes
  double screen_bound = 0.0;  ///< as `bound`, of that
};

class ScreenPicture;

/// A model with its map prepared: encoded and blurred where the filter does that.
class Lookup {
 public:
  virtual ~Lookup() = default;
  virtual ModelResult at(const Receiver& receiver) const = 0;
};

/// The scalar model of a filter: the same arithmetic as `<id>.glsl`, without a GL.
struct ScalarModel {
  /// Cost: one pass over the map for filters that encode, two more for the prefilter; none otherwise.
  std::unique_ptr<Lookup> (*prepare)(const ModelInput& input, Precision precision);

  /// Names the kernel that the filter averages with, for these complete parameter values; none where it differs from
  /// receiver to receiver, and is ModelResult::disk_radius_texels wide.
  std::optional<Kernel> (*kernel)(const ParamValues& values);

  /// What a step of a screen pass makes of a pixel that takes part; null where the filter has none.
  ModelResult (*screen)(const ScreenPicture& picture, glm::ivec2 pixel, int step, Precision precision) = nullptr;
};

/// The models of filters by their ids; CMake lists one for each `<id>.cpp` that stands beside its `<id>.glsl`.
const std::map<std::string, ScalarModel>& model_table();

/// The model of a built-in filter; null where there is none.
const ScalarModel* find_model(const std::string& id);

/// A filter's model, that of the filter it copies included; null where it has none (a user's file).
const ScalarModel* find_model(const FilterSpec& spec);

/// Why a filter without a model has none.
inline constexpr const char* kNoModel = "the filter has no scalar model";

/// A filter's kernel: the one that it declares, or its model's; none where it has neither, or none that all receivers
/// share.
std::optional<Kernel> find_kernel(const FilterSpec& spec, const ParamValues& values);

/// Why a filter has no kernel.
const char* explain_no_kernel(const FilterSpec& spec, const ParamValues& values);

// What filters' sources instantiate.

inline double value_of(float x) { return static_cast<double>(x); }
inline double value_of(double x) { return x; }
inline double value_of(long double x) { return static_cast<double>(x); }
inline double value_of(const Tracked& x) { return x.value; }
template <class T>
double bound_of(const T&) {
  return 0.0;
}
inline double bound_of(const Tracked& x) { return x.bound; }

template <class Filter>
class TemplatedLookup final : public Lookup {
 public:
  explicit TemplatedLookup(const ModelInput& input) : filter_(input) {}

  ModelResult at(const Receiver& receiver) const override {
    Tally tally;
    const auto visibility = filter_.visibility(receiver, tally);
    return {value_of(visibility),     bound_of(visibility), tally.excused,
            tally.disk_radius_texels, tally.screen_value,   tally.screen_bound};
  }

 private:
  Filter filter_;
};

/// Calls `use` with the type of that arithmetic.
auto with_type(Precision precision, const auto& use) {
  switch (precision) {
    case Precision::kFloat: return use.template operator()<float>();
    case Precision::kExtended: return use.template operator()<long double>();
    case Precision::kTracked: return use.template operator()<Tracked>();
    default: return use.template operator()<double>();
  }
}

template <template <class> class Filter>
std::unique_ptr<Lookup> prepare_templated(const ModelInput& input, Precision precision) {
  return with_type(
      precision,
      [&]<class T>() -> std::unique_ptr<Lookup> { return std::make_unique<TemplatedLookup<Filter<T>>>(input); });
}

template <template <class> class Filter>
ModelResult screen_templated(const ScreenPicture& picture, glm::ivec2 pixel, int step, Precision precision) {
  return with_type(
      precision, [&]<class T>() { return Filter<T>::screen(picture, pixel, step); });
}

/// Wraps `Filter<T>`, a class made from a ModelInput with `T visibility(const Receiver&, Tally&) const`, as a
/// ScalarModel; with `static Kernel kernel(const ParamValues&)` where all receivers share one, and
/// `static ModelResult screen(const ScreenPicture&, glm::ivec2 pixel, int step)` where it has a screen pass.
template <template <class> class Filter>
ScalarModel make_templated_model() {
  ScalarModel model{&prepare_templated<Filter>, [](const ParamValues&) { return std::optional<Kernel>(); }};
  if constexpr (requires { &Filter<double>::kernel; })
    model.kernel = [](const ParamValues& values) { return std::optional<Kernel>(Filter<double>::kernel(values)); };
  if constexpr (requires { &Filter<double>::screen; }) model.screen = &screen_templated<Filter>;
  return model;
}

}  // namespace shadowbench::filters
