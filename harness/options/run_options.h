#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "harness/options/options.h"
#include "harness/scene/lights/light.h"

namespace shadowbench::options {

/// What the value of an option names, as far as a shell can complete it.
enum class ValueKind { kOther, kFile, kFolder, kScene, kFilters };

/// Where the value of an option is stored. Flags are bool; an int counts how often a flag was given, --no-FLAG as -1.
using Variable = std::variant<bool*, int*, std::string*, std::optional<std::string>*, std::vector<std::string>*,
                              double*, std::optional<double>*, std::uint32_t*>;

/// One option of a command. A vector takes one value each time that the option is given.
struct Option {
  std::string name;  ///< "--scene"; a name without dashes is an argument without an option
  Variable variable;
  std::string help;
  ValueKind kind = ValueKind::kOther;
  std::vector<std::string> choices = {};  ///< any other value is refused; empty: none is
  bool required = false;
  bool hidden = false;            ///< the help does not show it
  bool opposite = false;          ///< the flag can be taken back with --no-FLAG
  std::string not_empty = {};     ///< what to give in place of an empty value, which no option takes
  std::string instead = {};       ///< of an option that is gone: what to use instead, which refuses every value
  std::string other_name = {};    ///< a spelling that is understood, and that the help does not show
  std::string group = "Options";  ///< the heading in the help
  bool rare = false;              ///< only --help-all shows it
  std::string value = {};         ///< the word for the value in the help, such as "FOLDER"

  Option& names(ValueKind what) { return kind = what, *this; }
  Option& in(std::string heading) { return group = std::move(heading), *this; }
  Option& rarely() { return rare = true, *this; }
  Option& takes(std::string what) { return value = std::move(what), *this; }
  /// Refuses all values but these.
  Option& one_of(std::vector<std::string> values) { return choices = std::move(values), *this; }
  Option& require() { return required = true, *this; }
  Option& hide() { return hidden = true, *this; }
  Option& with_opposite() { return opposite = true, *this; }
  Option& also_called(std::string what) { return other_name = std::move(what), *this; }
  Option& gone(std::string what) { return instead = std::move(what), hide(); }
  Option& never_empty(std::string what) { return not_empty = std::move(what), *this; }

  bool is_flag() const { return variable.index() < 2; }
  bool is_argument() const { return name.front() != '-'; }
  bool is_repeatable() const { return std::holds_alternative<std::vector<std::string>*>(variable); }
  /// The word for the value in the help: as told by takes(), the choices, or by the kind.
  std::string value_name() const;
  /// The value before the command line is read; empty where there is none.
  std::string default_value() const;
};

// The reading of values. All throw Error(kUsage), with the option's name.

/// Refuses what an option was told.
[[noreturn]] void fail(const std::string& message);

/// Requires more than the one and at most the other; `unit` follows the numbers in the message.
void require_in_range(const char* option, double value, double more_than, double most, const char* unit = "");

/// Parses a whole number, 1 or more.
int parse_count(const std::string& text, const char* option);

/// Parses the WIDTHxHEIGHT of `--size`, in pixels.
std::pair<int, int> parse_picture_size(const std::string& text);

/// Parses the AZIMUTH,ELEVATION of `--light`, in degrees.
scene::SkyAngles parse_light(const std::string& text);

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
