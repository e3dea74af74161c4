#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "filters/kernel.h"
#include "filters/model_input.h"
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
};

/// A model with its map prepared: encoded and blurred where the filter does that.
class Lookup {
 public:
  virtual ~Lookup() = default;
  virtual ModelResult at(const Receiver& receiver) const = 0;
};

/// The scalar model of a filter: the same arithmetic as `<id>.glsl`, without a GL.
class Model {
 public:
  virtual ~Model() = default;
  /// Cost: one pass over the map for filters that encode, two more for the prefilter; none otherwise.
  virtual std::unique_ptr<Lookup> prepare(const ModelInput& input, Precision precision) const = 0;

  /// Names the kernel that the filter averages with, for these complete parameter values; none where it differs from
  /// receiver to receiver.
  virtual std::optional<Kernel> kernel(const ParamValues& values) const = 0;
};

/// Makes the model of a filter; CMake lists one for each `<id>.cpp` that stands beside its `<id>.glsl`.
struct ModelEntry {
  std::string id;
  std::unique_ptr<Model> (*make)();
};
const std::vector<ModelEntry>& model_table();

/// A filter's model, null where it has none (a user's file).
std::unique_ptr<Model> make_model(const std::string& id);

/// Why a filter with a model may have no kernel.
inline constexpr const char* kKernelDiffers = "the filter's kernel differs from pixel to pixel";

/// A filter's kernel; none where it has no model, or none that all receivers share.
std::optional<Kernel> find_kernel(const std::string& id, const ParamValues& values);

/// Wraps `Filter<T>`, a class made from a ModelInput with `T visibility(const Receiver&, Tally&) const` and
/// `static Kernel kernel(const ParamValues&)`, or an optional one, as a Model.
template <template <class> class Filter>
std::unique_ptr<Model> make_templated_model();

}  // namespace shadowbench::filters

#include "filters/model_impl.h"
