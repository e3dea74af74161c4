#pragma once

#include <map>
#include <optional>
#include <string>

#include "filters/model.h"
#include "harness/measure/scene_assets.h"
#include "harness/measure/scene_measurement.h"
#include "harness/measure/scene_truth.h"
#include "harness/measure/view_receivers.h"
#include "reference/metrics/artefacts.h"
#include "reference/metrics/error_stats.h"

namespace shadowbench::measure {

/// What rays say of the squares around a view's receivers.
struct Surroundings {
  double half_width_texels = 0.0;
  std::vector<float> visibility;
  std::vector<std::uint8_t> settled;  ///< 1 where all rays of the square agree, and those of its neighbours' squares
};

/// A filter with an ideal map and an ideal bias.
struct KernelTruth {
  std::vector<float> visibility;
  std::vector<float> variance;  ///< as an estimate; empty: none
};

/// Traces the surroundings of a view's receivers, `widest_kernel_texels` and a little more, or takes them from the
/// cache. Requires a truth.
Surroundings trace_surroundings(truth::CachedTracer& tracer, const std::vector<TracedLayer>& layers,
                                const SceneTruth& truth, double widest_kernel_texels);

/// Notes the parts of a cell's error in its record, or why there are none, and leaves them as images.
void note_attribution(MeasuredCell& cell, metrics::Attribution attribution);

/// Finds where artefacts can occur in a view: the guard around a receiver is `widest_kernel_texels` and a little more.
/// Requires a truth. Cost: that of the surroundings.
metrics::ArtefactMasks find_artefact_masks(truth::CachedTracer& tracer, const std::vector<TracedLayer>& layers,
                                           const SceneTruth& truth, double widest_kernel_texels);

/// Says why the cells of one task are wrong: takes their errors apart, and counts the artefacts a person sees.
class CellAnalyser {
 public:
  /// The truth must outlive this object, too. Reads the depth map back and traces the receivers' surroundings.
  CellAnalyser(const TaskRig& rig, const SceneTruth& truth);

  /// Notes attribution and artefacts in the cell's record, or why there are none, and leaves the parts as images.
  /// Cost: the filter's scalar model, where it has one, and its brute-force percentage-closer filter for every
  /// receiver, and its kernel traced once for all cells that share it.
  void analyse(MeasuredCell& cell);

  /// Notes how wrong each cascade of the cell is, over all phases of the map's grid, which are not needed any more
  /// then; nothing of a light without cascades. Safe to call from many threads, each with its own cell.
  void note_cascades(MeasuredCell& cell) const;

  /// The masks of the artefacts; nothing where there is no truth.
  const std::optional<metrics::ArtefactMasks>& masks() const { return masks_; }

 private:
  TaskRig rig_;
  const SceneTruth& truth_;
  LightMap& light_;
  ModelView view_;
  std::vector<TracedLayer> layers_;
  Surroundings around_;
  std::optional<metrics::ArtefactMasks> masks_;
  /// What a cascade serves the most of.
  struct CascadeMasks {
    std::vector<std::uint8_t> receivers;
    metrics::ArtefactMasks artefacts;
  };
  std::vector<CascadeMasks> cascades_;          ///< none without cascades, or without a truth
  std::map<std::string, KernelTruth> kernels_;  ///< by name

  /// What many filters are compared with.
  struct Closer {
    std::string kernel;
    std::vector<render::Bias> biases;  ///< of the map's layers
    std::vector<double> image;
  };
  std::vector<Closer> closers_;

  KernelTruth trace_unsettled(double half_width_texels, const LayerTrace& trace);
  const KernelTruth& kernel_truth(const filters::Kernel& kernel);
  KernelTruth disks_truth(const std::vector<std::vector<float>>& radii_texels);
  std::vector<ModelLayer> read_layers(const std::vector<render::Bias>& biases) const;
  const std::vector<double>& compare(const filters::Kernel& kernel, const std::vector<render::Bias>& biases,
                                     const std::vector<ModelLayer>* layers);
  bool has_cascades() const;
  CascadeMasks mask_cascade(std::size_t cascade) const;
  void count_artefacts(MeasuredCell& cell) const;
  std::optional<double> measure_seam(MeasuredCell& cell) const;
  ModelImages evaluate(const MeasuredCell& cell);
  void attribute(MeasuredCell& cell);
};

}  // namespace shadowbench::measure
