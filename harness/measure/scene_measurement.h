#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "harness/measure/scene_assets.h"
#include "harness/measure/scene_truth.h"
#include "harness/measure/view_receivers.h"
#include "harness/options/options.h"
#include "harness/render/filter_passes.h"
#include "harness/scene/scene.h"
#include "reference/metrics/artefacts.h"
#include "report/images/heat_figures.h"
#include "report/images/image.h"
#include "report/records/records.h"

namespace shadowbench::measure {

/// One measured cell with its images; the images are empty where the status is not ok.
struct MeasuredCell {
  records::CellRecord record;
  filters::FilterRequest request;
  std::string label;          ///< filter and the parameters that were asked for
  render::LightLayers light;  ///< what it was drawn with
  render::FilterCost cost;
  std::vector<render::DrawnPass> passes;  ///< the lookup first; none of a user's filter, whose process has them
  double map_triangles = 0.0;             ///< that reach into the map, all layers
  std::vector<double> fetched_bytes;      ///< of a receiver's lookup, the mean, by the caches of the run's GPUs; empty
                                          ///< where TrafficMeter leaves it so
  render::DrawnPass empty_lookup;         ///< reads what the lookup does of its receivers, and nothing of the map
  gl::StepPointer frame;                  ///< how the picture was drawn; null unless the renderer has a recorder
  gl::StepPointer empty_frame;            ///< the same of the empty lookup
  images::Image picture;                  ///< linear RGB
  images::Image visibility;               ///< 1 lit .. 0 blocked
  std::vector<images::Image> phases;      ///< the same, with the map's grid moved to each of the other phases
  images::Image stepped;                  ///< the same as the first, with the map after a step of the camera; empty
                                          ///< where the map does not follow it, or where no truth is wanted
  images::Image unbiased;                 ///< visibility without any depth bias; empty where no truth is wanted
  std::vector<images::Image> cascades;    ///< visibility by each cascade alone, also beyond its slice of the view;
                                          ///< none without cascades, or where no truth is wanted
  images::StabilityImages stability;      ///< where its numbers break; empty unless the run asks for it
  images::UncertaintyImages
      uncertainty;     ///< how far rounding and other seeds can move its pixels; empty unless the run asks for it
  images::Image flip;  ///< of the picture to the truth's; empty where there is no truth
  std::vector<images::Image> error_parts;  ///< in the order of metrics::ErrorPart; none without an attribution, and an
                                           ///< empty one where a part is absent
};

/// One scene seen by one camera through one shadow map, with every filter.
struct SceneMeasurement {
  std::vector<MeasuredCell> cells;
  images::Image stored_map;                     ///< [0,1], row 0 is v = 1
  images::Image depth_map;                      ///< the same, linearised
  images::Image ambient;                        ///< linear RGB without the light; only of one of several
  std::optional<metrics::ArtefactMasks> masks;  ///< where artefacts can occur; nothing without truth
  double timed_ms = 0.0;                        ///< of the passes that were timed
  double attribution_s = 0.0;                   ///< that taking the errors apart took
  double truth_s = 0.0;                         ///< that the truth took, which other cells use too
  int passes_run = 0;
  int passes_skipped = 0;  ///< encode and blur passes that no chosen filter needed
};

/// What is to be measured in one go.
struct SceneTask {
  const scene::Scene* scene = nullptr;
  const scene::Camera* camera = nullptr;
  int map_size = 1024;
  std::vector<filters::FilterRequest> filters;
};

/// What a task is drawn with. Everything must outlive whatever keeps it.
struct TaskRig {
  Renderer& renderer;
  const options::RunOptions& options;
  const SceneTask& task;
  SceneAssets& assets;

  LightMap& light() const { return assets.light_map(*task.camera, task.map_size); }
  render::GBuffer& gbuffer() const { return assets.gbuffer(*task.camera); }
  const SceneTruth& truth() const { return assets.truth(*task.camera); }
  ModelView view() const { return {options.width, options.height, options.seed, options.bias.plane_max_tangent()}; }

  /// Compiles a filter over the light's map. Throws as render::FilterPasses.
  std::unique_ptr<render::FilterPasses> make_passes(const filters::FilterRequest& request) const {
    return make_filter_passes(renderer, options, *task.scene, light(), request);
  }
};

/// Draws and times every filter of a task.
/// Throws Error(kFilter) for a filter's GLSL, Error(kUsage) for a map size that the GL cannot give.
SceneMeasurement measure_scene(
    const TaskRig& rig, const options::StepListener& listener = [](const std::string&) {});

/// Writes a light's place as the command line reads it.
std::string describe_light(const scene::SkyAngles& light);

/// The record of a cell with its settings and key, nothing measured yet.
records::CellRecord make_record(const options::RunOptions& options, const SceneTask& task,
                                const filters::FilterRequest& request);

// A wrong filter gets a score like any other. These checks mark its cell: the status is `suspect`, and a warning says
// what was found and what to do. Its pictures and errors stay.

/// Checks what needs no truth: that visibility is finite and in [0,1], that the filter reads the map, no farther than
/// it declares, and nothing that nobody wrote. Requires the cell's `nan`.
void check_drawing(MeasuredCell& cell);

/// Checks that visibility is not the same at all receivers where some are wholly lit in truth, and some wholly blocked.
void check_against_truth(MeasuredCell& cell, const SceneTruth& truth);

}  // namespace shadowbench::measure
