#include "harness/measure/model_images.h"

#include <tbb/parallel_for_each.h>

#include <atomic>
#include <cmath>
#include <map>
#include <memory>

#include "filters/percentage_closer.h"

namespace shadowbench::measure {

namespace {

constexpr float kRadiiPerTexel = 16.0f;  // of disks that differ from pixel to pixel

/// Compares every receiver with a disk of its own radius, one radius after the other: each has a table of weights.
void compare_disks(ModelImages& images, const ModelLayer& layer, const ModelView& view) {
  std::map<float, std::vector<std::size_t>> same_radius;
  for (std::size_t i = 0; i < layer.receivers.size(); ++i)
    same_radius[images.disk_radii_texels.back()[find_pixel(layer.receivers[i], view.width, view.height)]].push_back(i);
  tbb::parallel_for_each(same_radius, [&](const auto& entry) {
    const auto kernel = filters::Kernel::make_disk(static_cast<double>(entry.first));
    const filters::PercentageCloser closer(kernel, layer.map, view.plane_max_tangent,
                                           filters::PercentageCloser::Owner::kFewReceivers);
    visit_in_parallel(entry.second.size(), [&](std::size_t k) {
      const filters::Receiver& receiver = layer.receivers[entry.second[k]];
      put_share(images.closer[find_pixel(receiver, view.width, view.height)], receiver, closer.at(receiver));
    });
  });
}

}  // namespace

ModelImages evaluate_model(const filters::FilterRequest& request, const std::vector<ModelLayer>& layers,
                           const ModelView& view) {
  const std::unique_ptr<filters::ScalarModel> model = filters::make_model(request.spec);
  ModelImages images;
  if (!model) return images;
  const bool has_disks = !filters::find_kernel(request.spec, request.values);
  const std::size_t pixels = view.pixels();
  images.model.assign(pixels, 1.0);
  if (has_disks) images.closer.assign(pixels, 1.0);
  std::atomic<std::int64_t> excused = 0;
  for (const ModelLayer& layer : layers) {
    const filters::ModelInput input{.spec = request.spec,
                                    .values = request.values,
                                    .map = layer.map,
                                    .seed = view.seed,
                                    .plane_max_tangent = view.plane_max_tangent};
    const auto lookup = model->prepare(input, filters::Precision::kDouble);
    if (has_disks) images.disk_radii_texels.emplace_back(pixels, 0.0f);
    visit_in_parallel(layer.receivers.size(), [&](std::size_t i) {
      const filters::Receiver& receiver = layer.receivers[i];
      const std::size_t pixel = find_pixel(receiver, view.width, view.height);
      const filters::ModelResult result = lookup->at(receiver);
      put_share(images.model[pixel], receiver, result.visibility);
      if (has_disks)
        images.disk_radii_texels.back()[pixel] =
            std::round(kRadiiPerTexel * static_cast<float>(result.disk_radius_texels)) / kRadiiPerTexel;
      if (result.excused) ++excused;
    });
    if (has_disks) compare_disks(images, layer, view);
  }
  images.excused = excused;
  return images;
}

std::vector<double> compare_kernel(const filters::Kernel& kernel, const std::vector<ModelLayer>& layers,
                                   const ModelView& view) {
  std::vector<double> image(view.pixels(), 1.0);
  for (const ModelLayer& layer : layers) {
    const filters::PercentageCloser closer(kernel, layer.map, view.plane_max_tangent);
    visit_in_parallel(layer.receivers.size(), [&](std::size_t i) {
      const filters::Receiver& receiver = layer.receivers[i];
      put_share(image[find_pixel(receiver, view.width, view.height)], receiver, closer.at(receiver));
    });
  }
  return image;
}

}  // namespace shadowbench::measure
