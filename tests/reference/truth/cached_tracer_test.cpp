#include "reference/truth/cached_tracer.h"

#include <sys/stat.h>

#include <chrono>

#include "tests/test_files.h"

namespace shadowbench::truth {
namespace {

// Traced images are kept between runs, and taken only where they are whole and follow from the very same content.

constexpr std::size_t kValues = 32;

std::optional<Layers> load(TruthCache& cache, const std::string& name) { return cache.load(name, 2, kValues); }

class Cache : public ::testing::Test {
 protected:
  TruthCache open() {
    return {folder_, [this](const std::string& message) { notes_.push_back(message); }};
  }
  std::filesystem::path file(const std::string& name) const { return folder_ / (name + ".truth"); }

  static Layers make_layers(float value) {
    std::vector<float> layer(kValues);
    for (std::size_t i = 0; i < layer.size(); ++i) layer[i] = value + static_cast<float>(i);
    return {layer, std::vector<float>(kValues, value)};
  }

  const TestFolder parent_;
  const std::filesystem::path folder_ = parent_.path() / "cache";
  std::vector<std::string> notes_;
};

TEST_F(Cache, GivesBackWhatWasStored) {
  TruthCache cache = open();
  EXPECT_FALSE(load(cache, "a"));
  cache.store("a", make_layers(0.5f));
  EXPECT_EQ(load(cache, "a"), make_layers(0.5f));
  EXPECT_EQ(cache.loaded(), 1);
  EXPECT_EQ(cache.traced(), 1);
  EXPECT_FALSE(load(cache, "b"));
}

TEST_F(Cache, AnotherContentUnderTheName_IsNotTaken) {
  TruthCache cache = open();
  cache.store("a", make_layers(0.5f));
  std::filesystem::copy(file("a"), file("b"));
  EXPECT_FALSE(load(cache, "b"));
}

/// What the file holds is whole; only the checksum in its first line says that something else was stored.
TEST_F(Cache, OtherValuesUnderTheSameFirstLine_AreNotTaken) {
  TruthCache cache = open();
  cache.store("a", make_layers(0.5f));
  const std::string first_line = read_text(file("a")).substr(0, read_text(file("a")).find('\n'));
  cache.store("a", make_layers(0.75f));
  const std::string other = read_text(file("a"));
  std::ofstream(file("a"), std::ios::binary) << first_line << other.substr(other.find('\n'));
  EXPECT_FALSE(load(cache, "a"));
}

TEST_F(Cache, AnotherSize_IsNotTaken) {
  TruthCache cache = open();
  cache.store("a", make_layers(0.5f));
  EXPECT_FALSE(cache.load("a", 1, kValues));
  EXPECT_FALSE(cache.load("a", 2, kValues / 2));
  EXPECT_FALSE(cache.load("a", 4, kValues / 2));
}

TEST_F(Cache, DamagedFiles_AreNotTaken_AndCanBeReplaced) {
  TruthCache cache = open();
  cache.store("a", make_layers(0.5f));
  const auto size = std::filesystem::file_size(file("a"));
  for (const std::uintmax_t kept : {std::uintmax_t{0}, std::uintmax_t{7}, size / 2, size - 1}) {
    cache.store("a", make_layers(0.5f));
    std::filesystem::resize_file(file("a"), kept);
    EXPECT_FALSE(load(cache, "a")) << kept << " of " << size;
  }
  std::filesystem::remove(file("a"));
  ASSERT_EQ(mkfifo(file("a").c_str(), 0600), 0);
  EXPECT_FALSE(load(cache, "a"));
  cache.store("a", make_layers(0.5f));
  ASSERT_TRUE(load(cache, "a"));
}

TEST_F(Cache, AFileThatIsFarTooLong_IsNotRead) {
  TruthCache cache = open();
  cache.store("a", make_layers(0.5f));
  std::filesystem::resize_file(file("a"), std::uintmax_t{1} << 27);
  EXPECT_FALSE(load(cache, "a"));
}

TEST_F(Cache, AFlippedBit_IsNoticed) {
  TruthCache cache = open();
  int noticed = 0, tried = 0;
  cache.store("a", make_layers(0.5f));
  const auto size = std::filesystem::file_size(file("a"));
  for (std::uintmax_t at = 0; at < size; at += 3) {
    cache.store("a", make_layers(0.5f));
    std::fstream stream(file("a"), std::ios::in | std::ios::out | std::ios::binary);
    stream.seekg(static_cast<std::streamoff>(at));
    const int byte = stream.get();
    stream.seekp(static_cast<std::streamoff>(at));
    stream.put(static_cast<char>(byte ^ 4));
    stream.close();
    const auto layers = load(cache, "a");
    ++tried;
    // A bit that no value depends on may differ; values may not.
    if (!layers || *layers == make_layers(0.5f)) ++noticed;
  }
  EXPECT_GT(tried, 20);
  EXPECT_EQ(noticed, tried);
}

TEST_F(Cache, Prune_RemovesWhatWasUsedLongestAgo) {
  TruthCache cache = open();
  for (const char* name : {"a", "b", "c"}) cache.store(name, make_layers(0.5f));
  const auto now = std::filesystem::file_time_type::clock::now();
  std::filesystem::last_write_time(file("a"), now - std::chrono::hours(2));
  std::filesystem::last_write_time(file("b"), now - std::chrono::hours(3));
  std::filesystem::last_write_time(file("c"), now - std::chrono::hours(1));
  ASSERT_TRUE(load(cache, "b"));  // used just now
  cache.prune(2 * std::filesystem::file_size(file("a")));
  EXPECT_FALSE(std::filesystem::exists(file("a")));
  EXPECT_TRUE(std::filesystem::exists(file("b")));
  EXPECT_TRUE(std::filesystem::exists(file("c")));
}

/// Neither a name nor an ending nor what it begins with makes a file ours, and none makes a folder another's.
TEST_F(Cache, Prune_LeavesFilesThatAreNotOurs) {
  open().store("a", make_layers(0.5f));
  std::ofstream(folder_ / "old.exr") << std::string(1000, 'x');
  std::ofstream(folder_ / "own.truth") << std::string(1000, 'x');
  std::filesystem::copy_file(file("a"), folder_ / "copy.bin");
  std::filesystem::create_symlink("a.truth", folder_ / "link.truth");
  open().prune(0);
  EXPECT_FALSE(std::filesystem::exists(file("a")));
  for (const char* name : {"old.exr", "own.truth", "copy.bin", "link.truth"})
    EXPECT_TRUE(std::filesystem::is_symlink(folder_ / name) || std::filesystem::exists(folder_ / name)) << name;
}

TEST_F(Cache, InAFolderOfTheUser_NothingIsDeleted) {
  std::filesystem::create_directories(folder_);
  const auto own = folder_ / "own.exr", half = folder_ / "a.shadowbench-tmp-999999999.truth";
  for (const auto& each : {own, half}) std::ofstream(each) << "kept";
  TruthCache cache = open();
  cache.store("a", make_layers(0.5f));
  cache.prune(0);
  for (const auto& each : {own, half, file("a")}) EXPECT_TRUE(std::filesystem::exists(each)) << each;
  EXPECT_TRUE(load(cache, "a"));
}

/// What versions of before made has no tag.
TEST_F(Cache, AFolderOfTruthsAlone_IsOurs) {
  open().store("a", make_layers(0.5f));
  std::filesystem::remove(folder_ / "CACHEDIR.TAG");
  std::filesystem::create_directories(folder_ / "gpu");
  TruthCache cache = open();
  cache.prune(0);
  EXPECT_FALSE(std::filesystem::exists(file("a")));
}

/// A process number that is free belongs to a process that is gone.
TEST_F(Cache, WhatKilledProcessesLeft_IsRemoved) {
  std::filesystem::create_directories(folder_);
  const auto half = folder_ / "a.shadowbench-tmp-999999999.truth";
  std::ofstream(half) << "half";
  open();
  EXPECT_FALSE(std::filesystem::exists(half));
}

TEST_F(Cache, AFolderThatCannotBeWritten_IsNotedOnce_AndNothingIsLost) {
  std::ofstream(folder_) << "a file where the folder should be";
  TruthCache cache = open();
  EXPECT_FALSE(load(cache, "a"));
  cache.store("a", make_layers(0.5f));
  cache.store("b", make_layers(0.5f));
  ASSERT_EQ(notes_.size(), 1u);
  EXPECT_THAT(notes_[0], HasSubstr(folder_.string()));
  EXPECT_THAT(notes_[0], HasSubstr("--cache"));
}

TEST_F(Cache, WithoutAFolder_KeepsNothing) {
  TruthCache cache({}, [](const std::string&) { FAIL(); });
  cache.store("a", make_layers(0.5f));
  EXPECT_FALSE(load(cache, "a"));
  cache.prune(0);
}

// What decides whether a view is traced again: geometry, receivers, light, kernel, texel size and seed; nothing else.

using Meshes = std::vector<OccluderMesh>;

/// A roof over the left half of a floor that is seen from above.
Meshes make_meshes() {
  OccluderMesh roof;
  roof.positions = {{-2, 1, -2}, {0, 1, -2}, {-2, 1, 2}, {0, 1, 2}};
  roof.indices = {0, 1, 2, 2, 1, 3};
  return {roof};
}

CutOut make_holes() {
  return {.uvs = {{-1, -1}, {0, -1}, {-1, 1}, {0, 1}}, .width = 2, .height = 1, .alpha = {255, 0}};
}

ReceiverImage make_receivers() {
  ReceiverImage receivers{32, 4, {}, "receivers"};
  for (int i = 0; i < 128; ++i) {
    receivers.points.push_back(
        {{-1.0f + 2.0f * (static_cast<float>(i % 32) + 0.5f) / 32.0f, 0.0f, 0.1f * static_cast<float>(i / 32)},
         {0.0f, 1.0f, 0.0f},
         true});
  }
  return receivers;
}

AreaLight make_light() { return AreaLight::make_sun({0.0, 1.0, 0.0}, 2.0); }

class Tracer : public ::testing::Test {
 protected:
  /// The number of results that were traced, and not found in the cache.
  int count_traced(const Meshes& meshes, const std::function<void(CachedTracer&)>& work, std::uint32_t seed = 1) {
    TruthCache cache(
        folder_, [](const std::string& message) { FAIL() << message; });
    CachedTracer tracer([&] { return meshes; }, cache, seed);
    work(tracer);
    return cache.traced();
  }

  const TestFolder parent_;
  const std::filesystem::path folder_ = parent_.path() / "cache";
};

TEST_F(Tracer, ASecondRun_DoesNotTraceAgain_AndSeesTheSame) {
  ViewRays first, second;
  EXPECT_EQ(count_traced(
                make_meshes(), [&](CachedTracer& t) { first = t.trace_view(make_receivers(), make_light()); }),
            1);
  EXPECT_EQ(
      count_traced(make_meshes(), [&](CachedTracer& t) { second = t.trace_view(make_receivers(), make_light()); }), 0);
  EXPECT_EQ(first.area.visibility, second.area.visibility);
  EXPECT_EQ(first.area.standard_error, second.area.standard_error);
  EXPECT_EQ(first.area.unanimous, second.area.unanimous);
  EXPECT_EQ(first.area.rays, second.area.rays);
  EXPECT_EQ(first.hard, second.hard);
  EXPECT_EQ(first.first_blockers_ws, second.first_blockers_ws);
  EXPECT_EQ(first.hard.front(), 0.0f);
  EXPECT_EQ(first.hard.back(), 1.0f);
  EXPECT_NEAR(first.first_blockers_ws.front(), 1.0f, 1e-5f);
}

TEST_F(Tracer, WhatTheTruthFollowsFrom_TracesAgain) {
  const auto view = [](CachedTracer& t) { t.trace_view(make_receivers(), make_light()); };
  ASSERT_EQ(count_traced(make_meshes(), view), 1);
  OccluderMesh roof = make_meshes()[0];
  const std::pair<const char*, std::function<void()>> changes[] = {
      {"a vertex moved by one step", [&] { roof.positions[3].y = std::nextafter(1.0f, 2.0f); }},
      {"a triangle less",
       [&] {
         roof.indices = {0, 1, 2};
       }},
      {"holes", [&] { roof.cut_out = make_holes(); }},
      {"other holes", [&] { roof.cut_out->cutoff = 0.25f; }},
      {"another factor", [&] { roof.cut_out->base_alpha = 0.75f; }},
      {"another alpha", [&] { roof.cut_out->alpha[1] = 1; }},
      {"the texture elsewhere", [&] { roof.cut_out->uvs[3].x += 0.25f; }},
      {"dimmed by the same texture", [&] { roof.cut_out->dims = true; }},
      {"dimmed otherwise", [&] { roof.cut_out->base_alpha = 0.5f; }}};
  for (const auto& [what, change] : changes) {
    change();
    EXPECT_EQ(count_traced({roof}, view), 1) << what;
  }
  EXPECT_EQ(count_traced({}, view), 1) << "no caster";
  ReceiverImage other = make_receivers();
  other.content = "other receivers";
  EXPECT_EQ(count_traced(make_meshes(), [&](CachedTracer& t) { t.trace_view(other, make_light()); }), 1);
  for (const AreaLight& light : {AreaLight::make_sun({0.0, 1.0, 0.0}, 2.1), AreaLight::make_sun({0.1, 1.0, 0.0}, 2.0)})
    EXPECT_EQ(count_traced(make_meshes(), [&](CachedTracer& t) { t.trace_view(make_receivers(), light); }), 1);
  const AreaLight disk = AreaLight::make_disk({0.0, 1.0, 0.0}, {0.0, -1.0, 0.0}, 0.1),
                  sphere = AreaLight::make_sphere({0.0, 1.0, 0.0}, 0.1);
  for (const AreaLight& light : {disk, sphere, AreaLight::make_rectangle({0.0, 1.0, 0.0}, disk.half_u(), disk.half_v()),
                                 AreaLight::make_rectangle({0.0, 1.0, 0.0}, sphere.half_u(), sphere.half_v())})
    EXPECT_EQ(count_traced(make_meshes(), [&](CachedTracer& t) { t.trace_view(make_receivers(), light); }), 1)
        << "another shape with the same edges";
  EXPECT_EQ(count_traced(make_meshes(), view, 2), 1) << "another seed";
  EXPECT_EQ(count_traced(make_meshes(), view), 0) << "the first is still there";
}

TEST_F(Tracer, ReceiversWithoutAName_AreNotKept) {
  ReceiverImage receivers = make_receivers();
  receivers.content.clear();
  ViewRays rays;
  count_traced(make_meshes(), [&](CachedTracer& t) { rays = t.trace_view(receivers, make_light()); });
  EXPECT_EQ(rays.hard.front(), 0.0f);
  EXPECT_FALSE(std::filesystem::exists(folder_));
}

TEST_F(Tracer, Kernels_AreTracedWithinTheirOwnError_AndKeepTheirVariance) {
  const MapGrid grid{.texel_size_ws = 0.25};
  const filters::Kernel kernel = filters::Kernel::make_disk(3.0);
  const std::vector<float> radii(make_receivers().points.size(), 3.0f);
  const Meshes meshes = make_meshes();
  const TraceSettings settings{.standard_error = kKernelStandardError};
  const TracedVisibility plain = trace_kernel(Occluders(meshes), make_receivers(), kernel, grid, settings),
                         disks = trace_disks(Occluders(meshes), make_receivers(), radii, grid, settings);
  ASSERT_GT(*std::ranges::max_element(plain.variance), 0.0f);
  for (const int traced : {2, 0}) {
    EXPECT_EQ(count_traced(
                  meshes,
                  [&](CachedTracer& t) {
                    const TracedVisibility own = t.trace_kernel(make_receivers(), kernel, grid);
                    EXPECT_EQ(own.rays, plain.rays);
                    EXPECT_EQ(own.variance, plain.variance);
                    EXPECT_EQ(t.trace_disks(make_receivers(), radii, grid).rays, disks.rays);
                  }),
              traced);
  }
}

TEST_F(Tracer, Kernels_AreKeptByKernelAndGrid) {
  using filters::Kernel;
  const MapGrid fine{.texel_size_ws = 0.05}, coarse{.texel_size_ws = 0.1},
      turned{.right = fine.up, .up = -fine.right, .texel_size_ws = 0.05},
      slanted{.to_light = {0.6, 0.8, 0.0}, .texel_size_ws = 0.05};
  const auto trace_all = [&](CachedTracer& t) {
    const Kernel tent = Kernel::make_point(filters::Reconstruction::kBilinear);
    for (const MapGrid& grid : {fine, coarse, turned, slanted}) t.trace_kernel(make_receivers(), tent, grid);
    t.trace_kernel(make_receivers(), Kernel::make_disk(3.0), fine);
    const std::size_t count = make_receivers().points.size();
    for (const float radius : {1.0f, 2.0f}) t.trace_disks(make_receivers(), std::vector<float>(count, radius), fine);
    t.trace_surroundings(make_receivers(), 4.0, fine);
  };
  EXPECT_EQ(count_traced(make_meshes(), trace_all), 8);
  EXPECT_EQ(count_traced(make_meshes(), trace_all), 0);
}

/// Lights of one shape share the points that rays go to, others do not.
TEST_F(Tracer, OneTracer_SeesEveryShapeOfLight) {
  const Occluders occluders(make_meshes());
  const glm::dvec3 centre(0.1, 3.0, 0.0), half_u(0.5, 0.0, 0.0), half_v(0.0, 0.0, 0.5);
  count_traced(make_meshes(), [&](CachedTracer& tracer) {
    for (const AreaLight& light : {make_light(), AreaLight::make_rectangle(centre, half_u, half_v),
                                   AreaLight::make_disk(centre, {0.0, -1.0, 0.0}, 0.5), make_light()})
      EXPECT_EQ(tracer.trace_view(make_receivers(), light).area.visibility,
                trace_area(occluders, make_receivers(), light, {}).visibility);
  });
}

}  // namespace
}  // namespace shadowbench::truth
