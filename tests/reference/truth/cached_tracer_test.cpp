// What decides whether a view is traced again: geometry, receivers, light, kernel, texel size and seed; nothing else.

#include "reference/truth/cached_tracer.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace shadowbench::truth {
namespace {

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
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("shadowbench.tracer." + std::to_string(getpid()));
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// The number of results that were traced, and not found in the cache.
  int count_traced(const Meshes& meshes, const std::function<void(CachedTracer&)>& work, std::uint32_t seed = 1) {
    TruthCache cache(
        folder_, [](const std::string& message) { FAIL() << message; });
    CachedTracer tracer([&] { return meshes; }, cache, seed);
    work(tracer);
    return cache.traced();
  }

  std::filesystem::path folder_;
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
  Meshes changed = make_meshes();
  changed[0].positions[3].y = std::nextafter(1.0f, 2.0f);
  EXPECT_EQ(count_traced(changed, view), 1) << "a vertex moved by one step";
  changed = make_meshes();
  changed[0].indices = {0, 1, 2};
  EXPECT_EQ(count_traced(changed, view), 1) << "a triangle less";
  changed = make_meshes();
  changed[0].cut_out = make_holes();
  EXPECT_EQ(count_traced(changed, view), 1) << "holes";
  changed[0].cut_out->cutoff = 0.25f;
  EXPECT_EQ(count_traced(changed, view), 1) << "other holes";
  changed[0].cut_out->base_alpha = 0.75f;
  EXPECT_EQ(count_traced(changed, view), 1) << "another factor";
  changed[0].cut_out->alpha[1] = 1;
  EXPECT_EQ(count_traced(changed, view), 1) << "another alpha";
  changed[0].cut_out->uvs[3].x += 0.25f;
  EXPECT_EQ(count_traced(changed, view), 1) << "the texture elsewhere";
  changed[0].cut_out->dims = true;
  EXPECT_EQ(count_traced(changed, view), 1) << "dimmed by the same texture";
  changed[0].cut_out->base_alpha = 0.5f;
  EXPECT_EQ(count_traced(changed, view), 1) << "dimmed otherwise";
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

}  // namespace
}  // namespace shadowbench::truth
