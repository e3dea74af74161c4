#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/view/view_state.h"

namespace shadowbench::view {

/// What `shadowbench view` is told.
struct ViewOptions {
  options::RunOptions run;  ///< its `out` is where files are saved
  std::string scene = "cubes";
  std::string lesson;                                        ///< by name, in place of scene, sides and map; empty: none
  std::string light_name;                                    ///< of the one that shines; empty: the first
  std::array<std::string, kSides> sides = {"", kTruthName};  ///< as make_side() takes them; empty: a usual filter
  std::vector<std::filesystem::path> filter_files;
  bool keeps_size = false;     ///< the picture does not follow the window's size
  double scale = 0.0;          ///< of text and widgets; 0: as the screen asks for
  std::string log;             ///< its file; empty: none
  double close_after_s = 0.0;  ///< 0: never
};

/// Opens the window, and returns when it is closed. Throws Error(kContext) where there is no display, and otherwise as
/// a run does.
void run_view(const ViewOptions& options);

}  // namespace shadowbench::view
