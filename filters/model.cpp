#include "filters/model.h"

#include <tbb/parallel_for.h>

#include "filters/encoded_map.h"
#include "filters/front_matter.h"
#include "filters/screen.h"

namespace shadowbench::filters {

const ScalarModel* find_model(const std::string& id) {
  const auto found = model_table().find(id);
  return found == model_table().end() ? nullptr : &found->second;
}

const ScalarModel* find_model(const FilterSpec& spec) {
  return find_model(spec.copy_of.empty() ? spec.id : spec.copy_of);
}

std::optional<Kernel> find_kernel(const FilterSpec& spec, const ParamValues& values) {
  if (spec.kernel) return make_kernel(*spec.kernel, values);
  const ScalarModel* model = find_model(spec);
  return model ? model->kernel(values) : std::nullopt;
}

const char* explain_no_kernel(const FilterSpec& spec, const ParamValues& values) {
  if (!list_screens(spec, values).empty()) return "a part of the filter's kernel is on the screen, in pixels";
  return find_model(spec) ? "the filter's kernel differs from pixel to pixel"
                          : "the filter declares no kernel, and has no scalar model that knows it";
}

void visit_rows(int rows, const std::function<void(int row)>& visit) { tbb::parallel_for(0, rows, visit); }

void ScreenPicture::add(const Receiver& receiver, const ModelResult& result) {
  Pixel& pixel = pixels_[static_cast<std::size_t>(receiver.pixel.y * size_.x + receiver.pixel.x)];
  const double share = static_cast<double>(receiver.layer_share);
  pixel.position_ws = receiver.position_ws;
  pixel.normal_ws = receiver.normal_ws;
  pixel.share += receiver.layer_share;
  pixel.result.visibility += share * result.visibility;
  pixel.result.bound += share * result.bound;
  pixel.result.screen_value += share * result.screen_value;
  pixel.result.screen_bound += share * result.screen_bound;
  pixel.result.excused = pixel.result.excused || result.excused;
}

void ScreenPicture::filter(const ScalarModel& model, const FilterSpec& spec, const ParamValues& values,
                           Precision precision) {
  for (const ScreenSpec& screen : list_screens(spec, values)) {
    for (int step = 0; step < screen.steps; ++step) {
      std::vector<Pixel> next = pixels_;
      for (int i = 0; Pixel & pixel : next) {
        const glm::ivec2 place(i % size_.x, i / size_.x);
        if (pixel.takes_part()) pixel.result = model.screen(*this, place, step, precision);
        ++i;
      }
      pixels_ = std::move(next);
    }
  }
}

}  // namespace shadowbench::filters
