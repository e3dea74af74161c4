#include "filters/model.h"

#include "filters/front_matter.h"

namespace shadowbench::filters {

std::unique_ptr<ScalarModel> make_model(const std::string& id) {
  for (const ModelEntry& entry : model_table())
    if (entry.id == id) return entry.make();
  return nullptr;
}

std::unique_ptr<ScalarModel> make_model(const FilterSpec& spec) {
  return make_model(spec.copy_of.empty() ? spec.id : spec.copy_of);
}

std::optional<Kernel> find_kernel(const FilterSpec& spec, const ParamValues& values) {
  if (spec.kernel) return make_kernel(*spec.kernel, values);
  const auto model = make_model(spec);
  return model ? model->kernel(values) : std::nullopt;
}

const char* explain_no_kernel(const FilterSpec& spec) {
  return make_model(spec) ? "the filter's kernel differs from pixel to pixel"
                          : "the filter declares no kernel, and has no scalar model that knows it";
}

}  // namespace shadowbench::filters
