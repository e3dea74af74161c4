#include "harness/view/background_truth.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <exception>
#include <new>
#include <stop_token>
#include <utility>

namespace shadowbench::view {
namespace {

constexpr int kCoarsest = 8;
constexpr std::chrono::milliseconds kBetweenTiles(100);

}  // namespace

/// What the threads that trace write of one job and the window reads. A member below is written once, before the stage
/// that announces it, or is written by atomic operations alone.
struct BackgroundTruth::Picture {
  std::stop_source stop;
  std::atomic<int> stages = 0;  ///< how often something was announced
  std::atomic<double> part = 0.0;
  std::atomic<std::size_t> pixels = 0;  ///< of tiles that were traced: all of the image once for every picture
  std::size_t pixels_of_image = 0;
  images::Image visibility;
  std::atomic<bool> has_visibility = false, has_coverage = false, has_truth = false, has_failed = false;
  measure::MapCoverage coverage;
  measure::SceneTruth truth;
  std::string error;

  void announce(std::atomic<bool>& what) {
    what = true;
    ++stages;
  }

  void fail(std::string message) {
    error = std::move(message);
    announce(has_failed);
  }

  /// Shows those pixels of a tile that count.
  void write(const truth::TracedTile& tile, const std::vector<std::uint8_t>& counts) {
    for (int y = tile.y; y < tile.y + tile.height; ++y) {
      for (int x = tile.x; x < tile.x + tile.width; ++x) {
        const auto i =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(visibility.width) + static_cast<std::size_t>(x);
        if (counts[i]) std::atomic_ref(visibility.texels[i]).store(tile.visibility[i], std::memory_order_relaxed);
      }
    }
    const std::size_t traced = pixels += static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height);
    if (traced % pixels_of_image == 0) announce(has_visibility);
  }

  images::Image read() {
    images::Image copy(visibility.width, visibility.height, 1);
    for (std::size_t i = 0; i < copy.texels.size(); ++i)
      copy.texels[i] = std::atomic_ref(visibility.texels[i]).load(std::memory_order_relaxed);
    return copy;
  }
};

struct BackgroundTruth::Request {
  TruthJob job;
  std::shared_ptr<Picture> picture;    ///< of the job; null: there is none
  std::shared_ptr<Picture> forgotten;  ///< an earlier one: to free it takes milliseconds, which the window has not
};

BackgroundTruth::BackgroundTruth(truth::CachedTracer::MeshList list_meshes, truth::TruthCache& cache,
                                 std::uint32_t seed)
    : tracer_(std::move(list_meshes), cache, seed), thread_([this] { work(); }) {}

BackgroundTruth::~BackgroundTruth() {
  ends_ = true;
  stop();
  thread_.join();
  const std::unique_ptr<Request> not_taken(waiting_.load());
}

void BackgroundTruth::put(Request request) {
  const std::unique_ptr<Request> replaced(waiting_.exchange(new Request(std::move(request))));
  ++rings_;
  rings_.notify_one();
}

std::shared_ptr<BackgroundTruth::Picture> BackgroundTruth::forget() {
  if (picture_) picture_->stop.request_stop();
  stages_seen_ = 0;
  pixels_seen_ = 0;
  return std::move(picture_);
}

void BackgroundTruth::start(TruthJob job) {
  std::shared_ptr<Picture> forgotten = forget();
  picture_ = std::make_shared<Picture>();
  put({std::move(job), picture_, std::move(forgotten)});
}

void BackgroundTruth::stop() { put({{}, nullptr, forget()}); }

std::optional<BackgroundTruth::Shown> BackgroundTruth::take() {
  if (!picture_) return std::nullopt;
  const int stages = picture_->stages;
  const std::size_t pixels = picture_->pixels;
  const auto now = std::chrono::steady_clock::now();
  const bool shows_tiles = pixels_seen_ != 0 && pixels != pixels_seen_ && now - shown_ >= kBetweenTiles;
  if (stages == stages_seen_ && !shows_tiles) return std::nullopt;
  stages_seen_ = stages;
  if (picture_->has_visibility) pixels_seen_ = pixels;
  shown_ = now;
  Shown shown;
  shown.part = picture_->part;
  if (picture_->has_coverage) shown.coverage = {picture_, &picture_->coverage};
  if (picture_->has_truth) shown.truth = {picture_, &picture_->truth};
  if (shown.truth)
    shown.visibility = shown.truth->area;
  else if (picture_->has_visibility)
    shown.visibility = picture_->read();
  if (picture_->has_failed) shown.error = picture_->error;
  return shown;
}

void BackgroundTruth::work() {
  give_way_to_others();
  for (int heard = 0; !ends_; heard = rings_) {
    if (const std::unique_ptr<Request> request{waiting_.exchange(nullptr)}; request && request->picture)
      serve(*request);
    rings_.wait(heard);
  }
}

void BackgroundTruth::serve(const Request& request) {
  try {
    run_on_quiet_threads([&] { trace(request); });
  } catch (const truth::TracingStopped&) {
  } catch (const std::bad_alloc&) {
    request.picture->fail("the memory is too small to trace this view; show it in fewer pixels");
  } catch (const std::exception& error) {
    request.picture->fail(fmt::format("this view cannot be traced: {}", error.what()));
  }
}

void BackgroundTruth::trace(const Request& request) {
  Picture& picture = *request.picture;
  const std::stop_token stop = picture.stop.get_token();
  measure::ViewReceivers receivers = measure::make_view_receivers(*request.job.surfaces, request.job.light);
  if (const auto& map = request.job.map) {
    picture.coverage = measure::measure_coverage(receivers, map->camera, map->layers, map->linear_depth);
    picture.announce(picture.has_coverage);
  }
  if (stop.stop_requested()) return;
  picture.visibility = receivers.to_image(std::vector<float>(receivers.image.points.size(), 1.0f));
  picture.pixels_of_image = receivers.image.points.size();
  tracer_.heed(stop);
  tracer_.listen([&](double part) { picture.part = part; });
  tracer_.show(kCoarsest,
               [&picture, counts = receivers.mask()](const truth::TracedTile& tile) { picture.write(tile, counts); });
  picture.truth = measure::trace_scene(tracer_, request.job.light, std::move(receivers));
  picture.part = 1.0;
  picture.announce(picture.has_truth);
}

void give_way_to_others() {
  const sched_param none{};
  pthread_setschedparam(pthread_self(), SCHED_IDLE, &none);
}

void run_on_quiet_threads(const std::function<void()>& work) {
  const int threads = tbb::info::default_concurrency();
  const auto helpers = static_cast<std::size_t>(threads - 1);
  // All places are reserved for threads that enter by themselves.
  tbb::task_arena arena(threads, static_cast<unsigned>(threads));
  // A helper waits for a group that nothing ends but the end of the work, and meanwhile takes part in the arena's
  // loops.
  std::vector<tbb::task_group> groups(helpers);
  std::vector<std::jthread> waiting;
  std::vector<tbb::task_handle> held;
  for (tbb::task_group& group : groups) {
    held.push_back(group.defer([] {}));
    waiting.emplace_back([&] { arena.execute([&] { group.wait(); }); });
  }
  arena.execute(work);
}

}  // namespace shadowbench::view
