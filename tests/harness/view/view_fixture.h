#pragma once

#include <utility>

#include "harness/view/view_state.h"
#include "tests/harness/cli/faults.h"
#include "tests/harness/measure/stand.h"

namespace shadowbench::test {

/// A window's state without a window, in a folder of each test's own.
class ViewTest : public FaultTest {
 protected:
  options::RunOptions make_options(int width = 240, int height = 135) const {
    options::RunOptions options = make_run_options(width, height);
    options.map_sizes = {512};
    options.cache = cache_folder();
    return options;
  }

  /// A filter with parameters, of the catalogue or a user's file.
  static filters::FilterRequest request(const std::string& text, const std::filesystem::path& file = {}) {
    filters::Catalogue catalogue(options::find_resources().filters);
    if (!file.empty()) catalogue.add_user_file(file);
    return catalogue.parse_requests(text).front();
  }

  static std::array<view::Side, view::kSides> sides(const std::string& left, const std::string& right) {
    return {view::Side{request(left)}, view::Side{request(right)}};
  }

  /// What a filter makes of a scene, drawn as the window does.
  static images::Image draw(const options::RunOptions& options, const scene::Scene& scene, const scene::Camera& camera,
                            const filters::FilterRequest& request) {
    Stand stand(scene, options, measure::padding_texels(options));
    const measure::LightMap& map = stand.assets.light_map(camera, options.map_sizes.front());
    render::ImageTarget target("visibility", GL_R32F, options.width, options.height);
    const auto passes = measure::make_filter_passes(stand.renderer, options, scene, map, request);
    return measure::draw_visibility(*passes, map.map, stand.assets.gbuffer(camera), target);
  }

  static images::Image draw(const view::ViewState& state, std::size_t side) {
    return draw(state.options, state.scene, state.active_camera(), state.sides[side].filter);
  }

  /// Changes a state as the window does.
  template <class Edit>
  static void change(view::ViewState& state, const Edit& edit) {
    view::ViewSettings settings = state;
    edit(settings);
    view::settle(settings);
    view::check(settings);
    view::apply(state, std::move(settings));
  }
};

}  // namespace shadowbench::test
