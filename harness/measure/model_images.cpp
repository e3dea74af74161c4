#include "harness/measure/model_images.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <functional>
#include <memory>

#include "filters/percentage_closer.h"

namespace shadowbench::measure {

ModelImages evaluate_model(const filters::FilterRequest& request, const filters::DepthMap& map,
                           const ModelReceivers& receivers, double plane_max_tangent, std::uint32_t seed, int width,
                           int height) {
  const std::unique_ptr<filters::Model> model = filters::make_model(request.spec.id);
  const filters::ModelInput input{request.spec, request.values, map, {}, seed, plane_max_tangent};
  const std::unique_ptr<filters::Lookup> lookup = model->prepare(input, filters::Precision::kDouble);
  const filters::PercentageCloser closer(model->kernel(request.values), map, plane_max_tangent);
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  ModelImages images{std::vector<double>(pixels, 1.0), std::vector<double>(pixels, 1.0), 0};
  const auto evaluate = [&](const tbb::blocked_range<std::size_t>& range, std::int64_t excused) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const filters::Receiver& r = receivers.filter[i];
      const auto pixel = static_cast<std::size_t>((height - 1 - r.pixel.y) * width + r.pixel.x);
      const filters::ModelResult result = lookup->at(r);
      images.model[pixel] = result.visibility;
      images.closer[pixel] = closer.at(receivers.closer[i]);
      excused += result.excused ? 1 : 0;
    }
    return excused;
  };
  images.excused = tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, receivers.filter.size(), 1024),
                                        std::int64_t{0}, evaluate, std::plus<>());
  return images;
}

}  // namespace shadowbench::measure
