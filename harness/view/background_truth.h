#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "harness/measure/map_coverage.h"
#include "harness/measure/scene_truth.h"
#include "harness/measure/view_receivers.h"
#include "harness/scene/scene.h"
#include "reference/truth/cached_tracer.h"
#include "report/images/image.h"

namespace shadowbench::view {

/// Makes the calling thread, and those that it starts from now on, compute only where no other thread wants the
/// processor. Without effect where the system refuses.
void give_way_to_others();

/// Runs `work` with its parallel loops on this thread and on new ones of the same priority, one for each further core.
/// TBB's own threads take no part: others wait for them, and a loop that waits for a quiet thread waits long.
/// Throws what `work` throws, and std::system_error where no thread can be started.
void run_on_quiet_threads(const std::function<void()>& work);

/// What is traced: what one camera sees, under one light.
struct TruthJob {
  /// What measure_coverage() asks for beside receivers.
  struct Map {
    scene::Camera camera;
    std::vector<measure::TracedLayer> layers;
    images::Image linear_depth;
  };

  std::shared_ptr<const measure::ViewSurfaces> surfaces;  ///< may serve many jobs: they change with the camera alone
  scene::Light light;
  std::optional<Map> map = {};  ///< counts the map's texels per pixel too
};

/// Traces truth while the window goes on: a coarse picture first, then a finer one, then the truth that a run finds,
/// bit for bit, tile by tile.
///
/// All functions are for one thread, which never waits for those that trace: what they write is read without a lock,
/// since a thread that gives way to all others must hold none. What they take of the processor is what nobody else
/// wants, so a window that draws without pause never sees the truth.
class BackgroundTruth {
 public:
  /// `list_meshes` and the note of `cache` are called in another thread, and nobody else may use `cache` meanwhile.
  BackgroundTruth(truth::CachedTracer::MeshList list_meshes, truth::TruthCache& cache, std::uint32_t seed);

  /// Stops. Waits for an acceleration structure that is being built: about a second per million triangles.
  ~BackgroundTruth();

  BackgroundTruth(const BackgroundTruth&) = delete;
  BackgroundTruth& operator=(const BackgroundTruth&) = delete;

  /// Traces this from now on, and nothing that was asked for before. Cost: below a millisecond.
  void start(TruthJob job);

  /// Traces nothing any more, and forgets what was traced.
  void stop();

  /// What there is to show of the job that was started last.
  struct Shown {
    /// As the lookup pass writes it, rows top to bottom; pixels without rays have the visibility of one close by. Empty
    /// until the coarsest picture is there, and where no surface faces the light.
    images::Image visibility;
    double part = 0.0;                                 ///< of the rays, 0 .. 1, roughly
    std::shared_ptr<const measure::SceneTruth> truth;  ///< all of it, or why there is none; null until it is finished
    std::shared_ptr<const measure::MapCoverage> coverage;  ///< null until it is measured, or where it is not asked for
    std::string error;                                     ///< why nothing more comes; empty where nothing failed
  };

  /// What has changed since the last call, or nothing: tiles that were traced since then count only after a tenth of a
  /// second, because to show them costs the processor too.
  std::optional<Shown> take();

 private:
  struct Picture;
  struct Request;

  truth::CachedTracer tracer_;
  std::shared_ptr<Picture> picture_;  ///< of the job that was started last
  int stages_seen_ = 0;
  std::size_t pixels_seen_ = 0;
  std::chrono::steady_clock::time_point shown_;
  std::atomic<Request*> waiting_ = nullptr;  ///< owned; taken by the thread
  std::atomic<int> rings_ = 0;               ///< changes when there is something to do
  std::atomic<bool> ends_ = false;
  std::thread thread_;  ///< the last member: it uses the others

  void put(Request request);
  std::shared_ptr<Picture> forget();
  void work();
  void serve(const Request& request);
  void trace(const Request& request);
};

}  // namespace shadowbench::view
