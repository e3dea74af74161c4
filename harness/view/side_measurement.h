#pragma once

#include <array>
#include <atomic>
#include <filesystem>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "base/files.h"
#include "harness/measure/scene_measurement.h"
#include "harness/run/worker_process.h"
#include "harness/view/view_state.h"

namespace shadowbench::view {

/// What a run is to find out.
enum class Measurand {
  kTruthAlone,  ///< as rays find it
  kEverything,  ///< of the truth and both sides
};

/// What a run found out about both sides.
struct MeasuredSides {
  /// One for each filter. Of its images there are the visibility, the parts of the error and those of stability; one
  /// that does not exist is empty, and `absent` of the record says why.
  std::vector<measure::MeasuredCell> cells;
  std::array<std::optional<std::size_t>, kSides> cell_of_side;  ///< index; none where a side shows the truth
  images::Image truth;                                          ///< visibility; empty where there is none
  std::string no_truth;                                         ///< why there is none
  images::Image truth_mask;                                     ///< 1 where the truth counts, else 0

  /// What was measured of a side; null where it shows the truth.
  const measure::MeasuredCell* find_side(std::size_t side) const;
};

/// Measures what the window shows as `shadowbench run` does, in a process of its own with the lowest priority, so that
/// the window goes on. To be used from one thread, which must outlive the process: this ends with that thread.
class SideMeasurement {
 public:
  enum class State { kIdle, kRunning, kFailed, kFinished };

  /// `program` is what is started as `PROGRAM run ...`: this same program.
  explicit SideMeasurement(std::filesystem::path program = "/proc/self/exe") : program_(std::move(program)) {}
  ~SideMeasurement() { cancel(); }
  SideMeasurement(const SideMeasurement&) = delete;
  SideMeasurement& operator=(const SideMeasurement&) = delete;

  /// Starts to measure a state, in place of what is measured. The process draws the very same images where the state is
  /// settled; see settle(). The options' cache keeps traced images. Cost: writing two small files; a fork. Throws Error
  /// as save_experiment() does for its files, Error(kOutput).
  void start(const ViewState& state, Measurand measurand = Measurand::kEverything);

  /// Looks how far it is; to be called once a frame. Cost: less than a millisecond; results are read by another thread.
  State poll();

  /// What it does at present, or why it failed, as the process says it.
  const std::string& text() const { return text_; }

  /// What was found out. Requires State::kFinished.
  const MeasuredSides& results() const { return results_; }

  /// Kills the process with its children, and removes its files.
  void cancel();

 private:
  std::filesystem::path program_;
  State state_ = State::kIdle;
  std::string text_;
  MeasuredSides results_;
  std::optional<ScratchFolder> folder_;
  std::optional<run::WorkerProcess> worker_;
  std::future<MeasuredSides> reading_;
  std::future<void> opening_;               ///< of what reads images, meanwhile
  std::atomic<bool> is_cancelled_ = false;  ///< nobody waits for what is read

  void end_worker();
  void finish_reading();
  void remove_files();
};

}  // namespace shadowbench::view
