#include "filters/model.h"

namespace shadowbench::filters {

std::unique_ptr<Model> make_model(const std::string& id) {
  for (const ModelEntry& entry : model_table())
    if (entry.id == id) return entry.make();
  return nullptr;
}

std::optional<Kernel> find_kernel(const std::string& id, const ParamValues& values) {
  const auto model = make_model(id);
  return model ? model->kernel(values) : std::nullopt;
}

}  // namespace shadowbench::filters
