#pragma once

#include <string>
#include <vector>

#include "filters/filter_spec.h"
#include "harness/gl/objects.h"
#include "harness/view/view_log.h"

namespace shadowbench::view {

/// Dear ImGui's widgets as this window has them: each with a name that tests know it by, and help under the pointer.
/// All return whether the user has changed the value.
class Widgets {
 public:
  explicit Widgets(ViewLog& log) : log_(log) {}

  /// One of several.
  bool choose(const std::string& name, const std::string& label, const std::vector<std::string>& choices,
              std::size_t& chosen, const std::string& help = {});

  struct SliderLimits {
    double min = 0.0;
    double max = 1.0;
    bool logarithmic = false;
    bool integer = false;
    std::string unit = {};
  };

  /// A number within limits; one typed in (Ctrl and a click) stays within them.
  bool slide(const std::string& name, const std::string& label, const SliderLimits& limits, double& value,
             const std::string& help = {});

  /// Any number.
  bool drag(const std::string& name, const std::string& label, const std::string& unit, float& value, float speed);

  bool tick(const std::string& name, const std::string& label, bool& value, const std::string& help = {});

  /// A button.
  bool press(const std::string& name, const std::string& label, const std::string& help = {});

  /// A filter's parameter, by what its front matter says of it.
  bool parameter(const std::string& name, const filters::ParamSpec& spec, filters::ParamValue& value);

  /// A texture, pixel by pixel, its row 0 at the bottom.
  void show(const std::string& name, const gl::Texture& texture);

  /// To be called after a widget of another kind.
  void note(const std::string& name);

 private:
  ViewLog& log_;

  void finish(const std::string& name, const std::string& help);
};

/// Shows a text beside the pointer where the last widget is under it.
void show_help(const std::string& text);

}  // namespace shadowbench::view
