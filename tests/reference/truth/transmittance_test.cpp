// Rays that surfaces dim: each crossing leaves 1 - alpha, however often it is reported.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/reference/truth/shapes.h"

namespace shadowbench::truth {
namespace {

OccluderMesh dim(OccluderMesh mesh, float alpha) {
  CutOut& pane = mesh.cut_out.emplace();
  pane.uvs.resize(mesh.positions.size());
  pane.base_alpha = alpha;
  pane.dims = true;
  return mesh;
}

OccluderMesh make_pane(double height, float alpha = 0.3f, int cells = 16) {
  return dim(make_sheet(-1.0, 1.0, -1.0, 1.0, height, cells), alpha);
}

AreaLight make_broad_sun() { return AreaLight::make_sun({0.0, 1.0, 0.0}, 4.0); }

std::vector<float> trace_hard_up(const std::vector<OccluderMesh>& meshes, const ReceiverImage& image) {
  return trace_hard(Occluders(meshes), image, AreaLight::make_sun({0.0, 1.0, 0.0}, 0.0));
}

TEST(Transmittance, OfASheetOfAlpha03_Is07_AndOfTwo049) {
  const ReceiverImage image = make_line(-0.7, 0.7, 60);
  std::vector<OccluderMesh> panes;
  for (const double expected : {0.7, 0.49}) {
    panes.push_back(make_pane(1.0 + static_cast<double>(panes.size())));
    const Occluders occluders(panes);
    for (const float hard : trace_hard(occluders, image, make_broad_sun())) ASSERT_NEAR(hard, expected, 1e-6);
    const MapGrid grid{.texel_size_ws = 0.02};
    for (const TracedVisibility& truth : {trace_area(occluders, image, make_broad_sun(), {}),
                                          trace_kernel(occluders, image, filters::Kernel::make_disk(4.0), grid, {})}) {
      for (std::size_t i = 0; i < image.points.size(); ++i) {
        ASSERT_NEAR(truth.visibility[i], expected, 3.0 * static_cast<double>(truth.standard_error[i]) + 1e-6) << i;
        ASSERT_EQ(truth.unanimous[i], 1) << "all rays agree";
        ASSERT_EQ(truth.standard_error[i], 0.0f) << i;
        ASSERT_GE(truth.rays[i], 4 * kRaysOfSettledPixel) << "no neighbour settles what is dimmed";
      }
    }
    const TracedVisibility area = trace_area(occluders, image, make_broad_sun(), {});
    for (const float ratio : area.ratio) ASSERT_NEAR(ratio, expected, 1e-5) << "and of the light that arrives";
  }
}

TEST(Transmittance, AtAnEdge_IsOneLessThePartThatIsHeldBack) {
  const ReceiverImage image = make_line(-1.2, 1.2, 120);
  const OccluderMesh sheet = make_sheet(-1.0, 1.0, -1.0, 1.0, 1.0, 16);
  const auto trace = [&](const OccluderMesh& mesh) {
    return trace_area(Occluders(std::vector<OccluderMesh>{mesh}), image, make_broad_sun(), {.standard_error = 1.0});
  };
  const TracedVisibility opaque = trace(sheet), dimmed = trace(dim(sheet, 0.3f));
  int at_edges = 0;
  for (std::size_t i = 0; i < image.points.size(); ++i) {
    const double expected = 1.0 - 0.3 * (1.0 - static_cast<double>(opaque.visibility[i]));
    const double error =
        std::hypot(0.3 * static_cast<double>(opaque.standard_error[i]), static_cast<double>(dimmed.standard_error[i]));
    ASSERT_NEAR(dimmed.visibility[i], expected, 5.0 * error + 1e-6) << i;
    if (opaque.unanimous[i]) continue;
    ++at_edges;
    EXPECT_GT(dimmed.standard_error[i], 0.0f);
    ASSERT_EQ(dimmed.rays[i], opaque.rays[i]);
    EXPECT_NEAR(dimmed.standard_error[i], 0.3f * opaque.standard_error[i], 1e-6f) << "of rays that differ by 0.3";
  }
  EXPECT_GT(at_edges, 20);
}

// Corners and diagonals belong to several triangles, and a tree may hold a triangle in several leaves.
TEST(Transmittance, ARayThroughAnEdge_IsDimmedOnce) {
  for (const int cells : {2, 16, 64}) {
    for (const double scale : {1.0, 1e4}) {
      OccluderMesh sheet = make_sheet(-1.0, 1.0, -1.0, 1.0, 1.0, cells);
      for (glm::vec3& p : sheet.positions) p = static_cast<float>(scale) * (p + glm::vec3(0.0f, 0.5f * p.x, 0.0f));
      ReceiverImage image{cells - 1, cells - 1, {}};
      for (int y = 1; y < cells; ++y)
        for (int x = 1; x < cells; ++x)
          image.points.push_back(
              {scale * glm::dvec3(2.0 * x / cells - 1.0, -1.0, 2.0 * y / cells - 1.0), {0, 1, 0}, true});
      for (const float hard : trace_hard_up({dim(sheet, 0.3f)}, image)) ASSERT_NEAR(hard, 0.7f, 1e-6f) << cells;
    }
  }
}

TEST(Transmittance, OfAClosedBody_IsThatOfBothItsSides_HoweverThin) {
  for (const double thickness : {0.1, 1e-7}) {
    OccluderMesh body = make_sheet(-1.0, 1.0, -1.0, 1.0, 1.0, 4);
    OccluderMesh roof = make_sheet(-1.0, 1.0, -1.0, 1.0, 1.0 + thickness, 4);
    const auto first = static_cast<std::uint32_t>(body.positions.size());
    body.positions.insert(body.positions.end(), roof.positions.begin(), roof.positions.end());
    for (std::size_t i = 0; i < roof.indices.size(); i += 3)  // it faces the other way
      body.indices.insert(body.indices.end(),
                          {first + roof.indices[i], first + roof.indices[i + 2], first + roof.indices[i + 1]});
    for (const float hard : trace_hard_up({dim(body, 0.3f)}, make_line(-0.9, 0.9, 50))) ASSERT_NEAR(hard, 0.49f, 1e-6f);
  }
}

TEST(Transmittance, OfManySheets_IsTheirProduct_InAnyOrder) {
  std::vector<OccluderMesh> panes;
  double expected = 1.0;
  for (int i = 0; i < 40; ++i) {
    const float alpha = 0.01f * static_cast<float>(1 + i % 5);
    panes.push_back(make_pane(1.0 + 0.1 * (i * 7 % 40), alpha, 4));
    expected *= 1.0 - static_cast<double>(alpha);
  }
  const ReceiverImage image = make_line(-0.3, 0.3, 16, 2);
  for (const float hard : trace_hard_up(panes, image)) EXPECT_NEAR(hard, expected, 1e-5);
  const TracedVisibility truth = trace_area(Occluders(panes), image, AreaLight::make_sun({0.0, 1.0, 0.0}, 0.5), {});
  for (const std::uint8_t unanimous : truth.unanimous) EXPECT_EQ(unanimous, 1) << "but for the order of factors";
}

TEST(Transmittance, ReachesBothEnds) {
  const ReceiverImage image = make_line(-0.9, 0.9, 32);
  const auto all = [&](float value) { return std::vector<float>(image.points.size(), value); };
  EXPECT_EQ(trace_hard_up({make_pane(1.0, 0.0f)}, image), all(1.0f));
  EXPECT_EQ(trace_hard_up({make_pane(1.0, 1.0f)}, image), all(0.0f));
  EXPECT_EQ(trace_hard_up({make_pane(1.0), make_sheet(-1.0, 1.0, -1.0, 1.0, 2.0, 4)}, image), all(0.0f)) << "behind it";
  OccluderMesh textured = make_pane(1.0, 1.0f);
  for (std::size_t i = 0; i < textured.positions.size(); ++i)
    textured.cut_out->uvs[i] = {0.37f * textured.positions[i].x, 0.61f * textured.positions[i].z};
  textured.cut_out->width = textured.cut_out->height = 3;
  textured.cut_out->alpha.assign(9, 255);
  EXPECT_EQ(trace_hard_up({textured}, image), all(0.0f)) << "an opaque texture, whatever its weights are rounded to";
}

TEST(Transmittance, OfATexture_IsReadAtEachPoint) {
  OccluderMesh pane = make_pane(1.0, 1.0f);
  for (std::size_t i = 0; i < pane.positions.size(); ++i)
    pane.cut_out->uvs[i] = {0.5f * (pane.positions[i].x + 1.0f), 0.5f};
  pane.cut_out->width = 2;
  pane.cut_out->height = 1;
  pane.cut_out->alpha = {51, 204};  // 0.2 and 0.8, with their centres at x = -0.5 and 0.5
  const ReceiverImage image = make_line(-0.5, 0.5, 100);
  const std::vector<float> hard = trace_hard_up({pane}, image);
  const TracedVisibility truth = trace_area(Occluders(std::vector<OccluderMesh>{pane}), image, make_broad_sun(), {});
  for (std::size_t i = 0; i < hard.size(); ++i) {
    const double x = static_cast<double>(image.points[i].position_ws.x);
    ASSERT_NEAR(hard[i], 0.5 - 0.6 * x, 1e-5) << x;
    if (std::abs(x) > 0.45) continue;  // the gradient ends within the light
    ASSERT_NEAR(truth.visibility[i], 0.5 - 0.6 * x, 4.0 * static_cast<double>(truth.standard_error[i])) << x;
    ASSERT_FALSE(truth.unanimous[i]);
  }
}

TEST(Transmittance, FirstBlockers_MeetWhatDims) {
  const std::vector<OccluderMesh> meshes = {make_pane(2.0), make_sheet(-1.0, 1.0, -1.0, 1.0, 1.0, 4)};
  for (const float distance :
       trace_first_blockers(Occluders(meshes), make_line(-0.9, 0.9, 10, 1), AreaLight::make_sun({0.0, 1.0, 0.0}, 0.0)))
    EXPECT_NEAR(distance, 2.0f, 1e-5f);
}

}  // namespace
}  // namespace shadowbench::truth
