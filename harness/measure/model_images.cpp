#include "harness/measure/model_images.h"

#include <atomic>
#include <memory>

#include "filters/percentage_closer.h"
#include "harness/measure/receiver_pixels.h"

namespace shadowbench::measure {

ModelImages evaluate_model(const filters::FilterRequest& request, const filters::DepthMap& map,
                           const ModelReceivers& receivers, double plane_max_tangent, std::uint32_t seed, int width,
                           int height) {
  const std::unique_ptr<filters::Model> model = filters::make_model(request.spec);
  const filters::ModelInput input{request.spec, request.values, map, {}, seed, plane_max_tangent};
  const auto lookup = model ? model->prepare(input, filters::Precision::kDouble) : nullptr;
  const filters::PercentageCloser closer(*filters::find_kernel(request.spec, request.values), map, plane_max_tangent);
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  ModelImages images{std::vector<double>(lookup ? pixels : 0, 1.0), std::vector<double>(pixels, 1.0), 0};
  std::atomic<std::int64_t> excused = 0;
  visit_in_parallel(receivers.filter.size(), [&](std::size_t i) {
    const std::size_t pixel = find_pixel(receivers.filter[i], width, height);
    images.closer[pixel] = closer.at(receivers.closer[i]);
    if (!lookup) return;
    const filters::ModelResult result = lookup->at(receivers.filter[i]);
    images.model[pixel] = result.visibility;
    if (result.excused) ++excused;
  });
  images.excused = excused;
  return images;
}

}  // namespace shadowbench::measure
