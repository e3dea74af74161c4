#pragma once

// The part of model.h that filters' sources instantiate; include model.h.

#include <utility>

#include "filters/map_reader.h"
#include "filters/model.h"

namespace shadowbench::filters {

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
    return {value_of(visibility), bound_of(visibility), tally.excused, tally.disk_radius_texels};
  }

 private:
  Filter filter_;
};

template <template <class> class Filter>
class TemplatedModel final : public Model {
 public:
  std::unique_ptr<Lookup> prepare(const ModelInput& input, Precision precision) const override {
    switch (precision) {
      case Precision::kFloat: return std::make_unique<TemplatedLookup<Filter<float>>>(input);
      case Precision::kDouble: return std::make_unique<TemplatedLookup<Filter<double>>>(input);
      case Precision::kExtended: return std::make_unique<TemplatedLookup<Filter<long double>>>(input);
      case Precision::kTracked: return std::make_unique<TemplatedLookup<Filter<Tracked>>>(input);
    }
    return nullptr;
  }

  std::optional<Kernel> kernel(const ParamValues& values) const override { return Filter<double>::kernel(values); }
};

template <template <class> class Filter>
std::unique_ptr<Model> make_templated_model() {
  return std::make_unique<TemplatedModel<Filter>>();
}

}  // namespace shadowbench::filters
