#include "harness/measure/model_images.h"

#include <tbb/parallel_for_each.h>

#include <atomic>
#include <cmath>
#include <map>
#include <memory>

#include "filters/percentage_closer.h"
#include "harness/measure/receiver_pixels.h"

namespace shadowbench::measure {

namespace {

constexpr float kRadiiPerTexel = 16.0f;  // of disks that differ from pixel to pixel

/// Compares every receiver with a disk of its own radius, one radius after the other: each has a table of weights.
void compare_disks(ModelImages& images, const ModelLayer& layer, const ModelView& view) {
  std::map<float, std::vector<std::size_t>> same_radius;
  for (std::size_t i = 0; i < layer.closer.size(); ++i)
    same_radius[images.disk_radii_texels.back()[find_pixel(layer.closer[i], view.width, view.height)]].push_back(i);
  tbb::parallel_for_each(same_radius, [&](const auto& entry) {
    const auto kernel = filters::Kernel::make_disk(static_cast<double>(entry.first));
    const filters::PercentageCloser closer(kernel, layer.map, view.plane_max_tangent,
                                           filters::PercentageCloser::Owner::kFewReceivers);
    visit_in_parallel(entry.second.size(), [&](std::size_t k) {
      const filters::Receiver& receiver = layer.closer[entry.second[k]];
      put_share(images.closer[find_pixel(receiver, view.width, view.height)], receiver, closer.at(receiver));
    });
  });
}

}  // namespace

ModelImages evaluate_model(const filters::FilterRequest& request, const std::vector<ModelLayer>& layers,
                           const ModelView& view) {
  const std::unique_ptr<filters::ScalarModel> model = filters::make_model(request.spec);
  const auto kernel = filters::find_kernel(request.spec, request.values);
  const std::size_t pixels = static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
  ModelImages images;
  images.closer.assign(pixels, 1.0);
  if (model) images.model.assign(pixels, 1.0);
  std::atomic<std::int64_t> excused = 0;
  for (const ModelLayer& layer : layers) {
    const filters::ModelInput input{.spec = request.spec,
                                    .values = request.values,
                                    .map = layer.map,
                                    .seed = view.seed,
                                    .plane_max_tangent = view.plane_max_tangent};
    const auto lookup = model ? model->prepare(input, filters::Precision::kDouble) : nullptr;
    const auto closer =
        kernel ? std::optional<filters::PercentageCloser>(std::in_place, *kernel, layer.map, view.plane_max_tangent)
               : std::nullopt;
    if (!kernel) images.disk_radii_texels.emplace_back(pixels, 0.0f);
    visit_in_parallel(layer.filter.size(), [&](std::size_t i) {
      const filters::Receiver& receiver = layer.filter[i];
      const std::size_t pixel = find_pixel(receiver, view.width, view.height);
      if (closer) put_share(images.closer[pixel], receiver, closer->at(layer.closer[i]));
      if (!lookup) return;
      const filters::ModelResult result = lookup->at(receiver);
      put_share(images.model[pixel], receiver, result.visibility);
      if (!closer)
        images.disk_radii_texels.back()[pixel] =
            std::round(kRadiiPerTexel * static_cast<float>(result.disk_radius_texels)) / kRadiiPerTexel;
      if (result.excused) ++excused;
    });
    if (!closer) compare_disks(images, layer, view);
  }
  images.excused = excused;
  return images;
}

}  // namespace shadowbench::measure
