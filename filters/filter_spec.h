#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/error.h"

namespace shadowbench::filters {

/// The value of a filter's parameter. Integers are kept as doubles; ParamSpec::integer tells them apart.
using ParamValue = std::variant<double, bool, std::string>;

/// Every parameter of one filter with its value, by name.
using ParamValues = std::map<std::string, ParamValue>;

/// The largest radius in texels of the shared Gaussian prefilter.
inline constexpr int kMaxPrefilterRadius = 64;

/// Which contract a filter keeps, and so which tests apply to it.
enum class FilterKind { kComparison, kStochastic, kBound, kOther };
constexpr auto names_of(FilterKind) { return std::array{"comparison", "stochastic", "bound", "other"}; }

/// One parameter, as the front matter declares it.
struct ParamSpec {
  std::string name;
  ParamValue default_value;
  bool integer = false;             ///< numbers only
  bool is_const = false;            ///< becomes a #define instead of a uniform
  std::optional<double> min;        ///< numbers only; inclusive
  std::optional<double> max;        ///< numbers only; inclusive
  std::vector<ParamValue> choices;  ///< the only values allowed; empty: any
  std::string unit;
  std::string text;  ///< help: what too little and too much do

  bool operator==(const ParamSpec&) const = default;
};

/// Asks for a table of points in the unit disk, given to the GLSL as `const vec2 <name>[]`.
struct DiskTable {
  std::string name;
  std::string count;  ///< name of the integer parameter that gives the number of points
  unsigned seed = 1;
  std::string pattern = "vogel";  ///< one of disk_patterns(), or the name of the parameter that chooses one

  bool operator==(const DiskTable&) const = default;
};

/// What a pass of a filter's own is drawn for: once; once, along u, and along v; once, and for the strides 1, 4, 16,
/// ... of prefix sums along u and then along v; or for every mip level.
enum class PassSteps { kOnce, kAxes, kPrefix, kLevels };

/// A pass of a filter's own, between the encoded map and the lookup. Its map and the GLSL function that writes it have
/// one name.
struct PassSpec {
  std::string name;
  std::string store;  ///< format, one of pass_formats()
  PassSteps steps = PassSteps::kOnce;
  bool half = false;   ///< has half the depth map's texels along each axis
  int anisotropy = 1;  ///< the most fetches that fetch_NAME_grad lays along a footprint
  int line = 1;        ///< of the filter's file

  bool is_integer() const { return store.ends_with("ui"); }
  const char* texel_type() const { return is_integer() ? "uvec4" : "vec4"; }
  bool operator==(const PassSpec&) const = default;
};

/// A pass over the picture that the lookup drew: the GLSL function of its name makes each pixel of its neighbours.
struct ScreenSpec {
  std::string name;
  std::variant<double, std::string> reach = 0.0;  ///< pixels, along either axis: a number or a parameter's name
  int steps = 1;                                  ///< how often it is drawn
  int line = 1;                                   ///< of the filter's file

  bool operator==(const ScreenSpec&) const = default;
};

/// The farthest that a screen pass may read, pixels.
inline constexpr int kMaxScreenReach = 64;

enum class KernelShape { kTent, kBox, kDisk, kGaussian, kWeights };

/// A kernel that the front matter declares; make_kernel() makes it.
struct DeclaredKernel {
  KernelShape shape = KernelShape::kWeights;
  std::variant<double, std::string> size = 0.0;  ///< texels: a number or a parameter's name; not of weights
  std::vector<double> weights;                   ///< one texel apart, centred on the receiver; they sum to 1
  bool reads_nearest = false;                    ///< instead of the four texels around a tap

  bool operator==(const DeclaredKernel&) const = default;
};

/// Everything the front matter of `<id>.glsl` says, and the GLSL that follows it.
struct FilterSpec {
  std::string id;    ///< file stem
  std::string path;  ///< for messages
  std::string title;
  std::string source;  ///< citation
  FilterKind kind = FilterKind::kOther;
  std::vector<std::string> claims;
  bool teaching = false;  ///< shows a mistake: drawn where it is named, and never advised
  std::variant<double, std::string> radius_texels = 0.0;  ///< kernel half-width: a number or a parameter's name
  std::variant<double, std::string> bias_texels = 0.0;    ///< half-width over which one depth stands for the receiver
  std::vector<ParamSpec> params;  ///< the lists `store`, `combine`, `sample`, `samples` included
  std::vector<DiskTable> disks;
  std::vector<PassSpec> passes;          ///< in the order in which they run
  std::vector<ScreenSpec> screens;       ///< likewise; see list_screens()
  std::optional<DeclaredKernel> kernel;  ///< none: only a scalar model knows it
  std::string copy_of;                   ///< a user's file: the built-in filter that it copies; empty: none
  std::string front_matter;              ///< as it is written
  std::string body;                      ///< GLSL after the front matter
  int body_first_line = 1;               ///< line of the file at which `body` begins
  int samples_line = 1;                  ///< line of the file at which `samples` stands
  bool has_encode = false;               ///< stores something else than depth
  bool uses_samplers = false;            ///< reads the map past the counted functions: its fetch count is unknown
  bool reads_unwritten = false;          ///< reads the encoded map, and has no encode() that writes it
  bool has_prefilter = false;            ///< `combine` is given: the map is blurred with radius `radius_texels`
  bool holds_moments = false;            ///< channels in pairs: a mean, and the mean of its square
  std::string exponent;                  ///< parameter that the exponents of what is stored grow with; empty: none
  std::string variance_floor;            ///< parameter that variances are raised to; empty: none
  std::string bound_at_zero;             ///< parameter that a bound holds without, at 0 only; empty: it always holds

  const ParamSpec* find_param(const std::string& name) const;
  bool operator==(const FilterSpec&) const = default;
};

/// Writes a value as the command line would take it.
std::string to_string(const ParamValue& value);

/// The least and the greatest value that a numeric parameter may take, by its range or by its choices.
struct Ends {
  double smallest;
  double largest;
};
Ends ends_of(const ParamSpec& param);

/// A numeric parameter's value. Requires that the parameter exists and is a number.
double number(const ParamValues& values, const std::string& name);

/// A number that the front matter gives itself, or the value of the parameter that it names.
double number_or_param(const std::variant<double, std::string>& value, const ParamValues& values);

/// A text parameter's value, `fallback` where the filter has no such parameter.
std::string text_or(const ParamValues& values, const std::string& name, const std::string& fallback);

/// Whether the filter promises never to be darker than the percentage-closer filter of its kernel.
bool promises_bound(const FilterSpec& spec, const ParamValues& values);

/// The kernel's half-width in texels for these parameter values.
double radius_texels(const FilterSpec& spec, const ParamValues& values);

/// How far a filter's comparisons reach on each axis, in texels from the receiver to the centre of the farthest texel
/// that counts: what a depth bias has to cover. A half-width that is a number in the front matter is the whole reach.
/// One that is a parameter says where taps lie, and each of them reads a texel further. Never less than half a texel,
/// the distance to the centre of the receiver's own.
double reach_texels(const FilterSpec& spec, const ParamValues& values);

/// The same, of the part for which one depth stands for the receiver: `bias_texels` in place of `radius_texels`.
double bias_reach_texels(const FilterSpec& spec, const ParamValues& values);

/// Whether the encoded map holds logarithms, which the prefilter adds as log-sum-exp.
bool combines_logs(const ParamValues& values);

/// Whether fetches of the encoded map read its nearest texel, and not the four around a point.
bool reads_nearest(const ParamValues& values);

/// The screen passes that these values ask for: all, or where a text parameter is called `screen` the one that it
/// names.
std::vector<ScreenSpec> list_screens(const FilterSpec& spec, const ParamValues& values);

/// How far a screen pass says that it reads, pixels.
int reach_pixels(const ScreenSpec& screen, const ParamValues& values);

/// The radius in texels of the Gaussian prefilter, 0 where the filter has none.
int prefilter_radius_texels(const FilterSpec& spec, const ParamValues& values);

/// The samples of depth a texel that encode() is asked for, and whose mean is stored: 1, or what `samples` says.
int depth_samples(const ParamValues& values);

/// A filter whose file cannot be used, and why.
struct FilterMistake {
  std::string id;
  std::string file;
  std::string message;  ///< with file and line
};

/// All the filters of a run that cannot be used.
class FilterErrors : public Error {
 public:
  /// Requires one mistake at least.
  explicit FilterErrors(std::vector<FilterMistake> mistakes)
      : Error(ErrorKind::kFilter, describe(mistakes)), mistakes_(std::move(mistakes)) {}

  const std::vector<FilterMistake>& mistakes() const { return mistakes_; }

 private:
  std::vector<FilterMistake> mistakes_;

  static std::string describe(const std::vector<FilterMistake>& mistakes) {
    if (mistakes.size() == 1) return mistakes.front().message;
    std::string text = std::to_string(mistakes.size()) + " filters have mistakes";
    for (const FilterMistake& mistake : mistakes) text += "\n" + mistake.message;
    return text;
  }
};

}  // namespace shadowbench::filters
