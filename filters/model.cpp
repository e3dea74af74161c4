#include "filters/model.h"

namespace shadowbench::filters {

std::unique_ptr<Model> make_model(const std::string& id) {
  for (const ModelEntry& entry : model_table())
    if (entry.id == id) return entry.make();
  return nullptr;
}

}  // namespace shadowbench::filters
