#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "harness/options/option.h"
#include "harness/options/options.h"

namespace shadowbench::options {

/// A run of more filters draws grids only where it is told to, because nobody could read them.
inline constexpr int kFiltersOfAGrid = 16;

/// What an option was told, before it is read.
using Told =
    std::variant<bool, int, std::string, std::vector<std::string>, double, std::optional<double>, std::uint32_t>;

/// What an option decides.
enum class Decides {
  kWay,      ///< where and how a run is made: it is no key of experiments
  kCells,    ///< which cells there are; their keys say it, or their scenes
  kContent,  ///< what is measured of a cell, and its key does not say
};

/// An option of `shadowbench run`: from this one description follow the command line and its help, what experiments may
/// say and how they are written, and which cells are alike.
struct RunOption : Option {
  Decides decides;
  Told told;                                           ///< its default before anything is told
  std::function<void(RunOptions&, const Told&)> read;  ///< none where other rooms must be asked
  std::function<Told(const RunOptions&)> write;        ///< none where it is not written, or elsewhere

  /// The key of experiments: "map_size" for "--map-size".
  std::string key() const;
};

/// All options of a run, as its help lists them.
std::vector<RunOption> list_run_options();

/// What the option of that name is told.
template <class T>
T& find_told(std::vector<RunOption>& all, std::string_view name) {
  for (RunOption& option : all)
    if (option.name == name) return std::get<T>(option.told);
  throw std::logic_error("no such option");
}

/// What was told in words of the command line: none, one, or several.
std::vector<std::string> list_texts(const Told& told);

/// Reads what was told, all but filters and grids, which depend on them, into `options`, whose `resources` must be
/// there. Throws Error(kUsage), with the option's name, for a value that it cannot have.
void read_run_options(const std::vector<RunOption>& all, RunOptions& options);

/// Refuses options that do not go together. Throws Error(kUsage).
void check_run_options(const RunOptions& options);

}  // namespace shadowbench::options
