#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "base/toml.h"
#include "filters/catalogue.h"
#include "filters/kernel.h"
#include "filters/model.h"
#include "harness/cli/arguments.h"
#include "harness/cli/commands.h"
#include "harness/cli/terminal.h"
#include "harness/gpu/gpu.h"
#include "harness/options/options.h"
#include "harness/run/gpu_costs.h"
#include "harness/scene/load.h"
#include "report/records/format.h"
#include "report/records/json_io.h"

namespace shadowbench::cli {
namespace {

using filters::FilterSpec;
using filters::ParamSpec;

struct ListArguments {
  bool json = false;
  bool check = false;
  bool measure = false;  ///< gone
  std::string backend = "auto";
};

std::string describe_range(const ParamSpec& param) {
  std::vector<std::string> choices;
  for (const auto& choice : param.choices) choices.push_back(filters::to_string(choice));
  if (!choices.empty()) return fmt::format("{}", fmt::join(choices, " | "));
  if (std::holds_alternative<bool>(param.default_value)) return "true | false";
  return fmt::format("{} .. {}{}", *param.min, *param.max, param.integer ? ", whole" : "");
}

/// What the encoded map holds; empty where the front matter does not tell.
std::string describe_stored(const FilterSpec& spec) {
  std::vector<std::string> parts;
  if (spec.holds_moments) parts.push_back("moments");
  if (!spec.variance_floor.empty()) parts.push_back("variances raised to " + spec.variance_floor);
  if (!spec.exponent.empty()) parts.push_back("exponents that grow with " + spec.exponent);
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// The kernel of a filter at its defaults.
records::KernelRecord find_kernel(const FilterSpec& spec) {
  return records::make_kernel_record(filters::find_kernel_sigma(spec, filters::default_values(spec)));
}

void print_filter(const FilterSpec& spec) {
  print("{}  {}\n  kind {}{}{}{}\n  kernel: {}\n  source: {}\n", spec.id, spec.title, name_of(spec.kind),
        spec.bound_at_zero.empty() ? "" : ", with " + spec.bound_at_zero + "=0", spec.teaching ? ", for teaching" : "",
        filters::find_model(spec) ? "" : ", without a model", records::describe_kernel(find_kernel(spec)), spec.source);
  if (const std::string stored = describe_stored(spec); !stored.empty()) print("  its map holds: {}\n", stored);
  for (const ParamSpec& param : spec.params) {
    print("  {:<16} {} [{}]{}\n  {:<16} {}\n", param.name, describe_range(param),
          filters::to_string(param.default_value), param.unit.empty() ? "" : " " + param.unit, "", param.text);
  }
  print("\n");
}

nlohmann::json to_json(const filters::ParamValue& value) {
  return std::visit([](const auto& v) { return nlohmann::json(v); }, value);
}

nlohmann::json to_json(const ParamSpec& param) {
  nlohmann::json json = {{"name", param.name},
                         {"default", to_json(param.default_value)},
                         {"integer", param.integer},
                         {"const", param.is_const},
                         {"unit", param.unit},
                         {"text", param.text},
                         {"min", nullptr},
                         {"max", nullptr},
                         {"choices", nlohmann::json::array()}};
  if (param.min) json["min"] = *param.min;
  if (param.max) json["max"] = *param.max;
  for (const auto& choice : param.choices) json["choices"].push_back(to_json(choice));
  return json;
}

nlohmann::json to_json(const records::KernelRecord& kernel) {
  nlohmann::json json = {{"sigma_texels", nullptr}, {"class", nullptr}};
  if (kernel.sigma_texels) json["sigma_texels"] = *kernel.sigma_texels;
  if (kernel.width_class) json["class"] = *kernel.width_class;
  return json;
}

nlohmann::json to_json(const FilterSpec& spec) {
  nlohmann::json params = nlohmann::json::array();
  for (const ParamSpec& param : spec.params) params.push_back(to_json(param));
  return {{"id", spec.id},
          {"title", spec.title},
          {"source", spec.source},
          {"kind", name_of(spec.kind)},
          {"claims", spec.claims},
          {"teaching", spec.teaching},
          {"kernel", to_json(find_kernel(spec))},
          {"model", filters::find_model(spec) != nullptr},
          {"params", params},
          {"moments", spec.holds_moments},
          {"exponent", spec.exponent},
          {"variance_floor", spec.variance_floor},
          {"bound_at_zero", spec.bound_at_zero}};
}

int list_filters(const ListArguments& arguments) {
  const filters::Catalogue catalogue(options::find_resources().filters);
  nlohmann::json json = nlohmann::json::array();
  for (const FilterSpec& spec : catalogue.filters())
    if (arguments.json)
      json.push_back(to_json(spec));
    else
      print_filter(spec);
  if (arguments.json)
    fmt::print("{}\n", json.dump(2));
  else
    print("A kernel is as wide as its standard deviation along an axis, here at the defaults. Classes: {}.\n",
          filters::describe_classes());
  return 0;
}

void print_preset(const filters::Preset& preset) {
  const std::string options = filters::write_bias_options(preset);
  print("@{}  {}\n", preset.name, preset.title);
  const auto print_line = [](const char* key, const std::string& text) { print("  {:<8} {}\n", key, text); };
  print_line("filter", preset.filter);
  print_line("differs", preset.differs);
  print_line("bias", preset.bias);
  print_line("", options.empty() ? "no --bias is the same" : options);
  print_line("version", preset.version);
  for (const std::string& source : preset.sources)
    print_line(&source == &preset.sources.front() ? "source" : "", source);
  print("\n");
}

nlohmann::json to_json(const filters::Preset& preset) {
  return {{"name", preset.name},       {"title", preset.title},    {"filter", preset.filter},
          {"differs", preset.differs}, {"bias", preset.bias},      {"bias_options", preset.bias_options},
          {"version", preset.version}, {"sources", preset.sources}};
}

int list_presets(const ListArguments& arguments) {
  const filters::Catalogue catalogue(options::find_resources().filters);
  nlohmann::json json = nlohmann::json::array();
  for (const filters::Preset& preset : catalogue.presets())
    if (arguments.json)
      json.push_back(to_json(preset));
    else
      print_preset(preset);
  if (arguments.json) fmt::print("{}\n", json.dump(2));
  return 0;
}

int list_scenes(const ListArguments& arguments) {
  const std::filesystem::path folder = options::find_resources().scenes;
  nlohmann::json json = nlohmann::json::array();
  const auto show = [&](const std::vector<scene::SceneInfo>& scenes, bool teaching) {
    for (const scene::SceneInfo& info : scenes)
      if (arguments.json)
        json.push_back({{"name", info.name}, {"title", info.title}, {"teaching", teaching}});
      else
        print("{:<8} {}\n", info.name, info.title);
  };
  show(scene::list_scenes(folder), false);
  if (!arguments.json) print("\nFor teaching, run only where --scene names them:\n");
  show(scene::list_teaching_scenes(folder), true);
  if (arguments.json) fmt::print("{}\n", json.dump(2));
  return 0;
}

int list_lessons(const ListArguments& arguments) {
  nlohmann::json json = nlohmann::json::array();
  for (const TomlTable& lesson : read_toml(options::find_resources().lessons, "the lessons").tables("lesson"))
    if (arguments.json)
      json.push_back({{"name", lesson.string("name")}, {"title", lesson.string("title")}});
    else
      print("{:<14} {}\n", lesson.string("name"), lesson.string("title"));
  if (arguments.json) fmt::print("{}\n", json.dump(2));
  return 0;
}

int list_metrics(const ListArguments& arguments) {
  fmt::print("{}", arguments.json ? records::make_metric_json() : records::make_metric_text());
  return 0;
}

int list_gpus(const ListArguments& arguments) {
  nlohmann::json json = nlohmann::json::array();
  for (const gpu::Gpu& gpu : gpu::load_gpus(options::find_resources().gpus)) {
    nlohmann::json& each = json.emplace_back(nlohmann::json{{"name", gpu.name}, {"title", gpu.title}});
    const auto family = arguments.check ? run::find_family(gpu) : std::nullopt;
    if (arguments.check) each["driver"] = family ? nlohmann::json(*family) : nlohmann::json();
    if (!arguments.json)
      print("{}  {}{}\n", gpu.name, gpu.title,
            !arguments.check ? ""
            : family         ? ": compiled for by this machine's Vulkan driver"
                             : ": left out, since no Vulkan driver of this machine compiles for it");
    gpu::visit_constants(gpu, [&](const char* key, const gpu::Constant& constant) {
      each[key] = {{"value", constant.value}, {"source", constant.source}};
      if (!arguments.json) print("  {:<19} {:<6} {}\n", key, constant.value, constant.source);
    });
  }
  if (arguments.json)
    fmt::print("{}\n", json.dump(2));
  else
    print("Not listed: {}.\n", gpu::kOtherGpus);
  return 0;
}

int list_gl(const ListArguments& arguments) {
  const gl::ContextChoice choice = gl::create_context(parse_name<gl::Backend>(arguments.backend, "GL back end"));
  for (const std::string& reason : choice.refused) print("not used: {}\n", reason);
  const gl::GlInfo& info = choice.context->info();
  print("{}: {}, OpenGL {}, maps up to {} x {}\n", info.backend, info.renderer, info.version, info.max_texture_size,
        info.max_texture_size);
  return 0;
}

}  // namespace

Command make_list_command() {
  Command command{"list", "List filters, engine presets, scenes, lessons, metrics, GPUs, or the OpenGL context"};
  auto a = std::make_shared<ListArguments>();
  const auto add = [&](const char* name, const char* title, int (*show)(const ListArguments&)) {
    Command& sub = command.commands.emplace_back(Command{name, title});
    sub.action = [a, show](const CommandLine&) { return show(*a); };
    if (show != list_gl) add_json_option(sub, a->json);
  };
  add("filters", "Filters with parameters, ranges, units and source", list_filters);
  add("presets", "Filters as engines ship them, with bias and known differences", list_presets);
  add("scenes", "Built-in scenes", list_scenes);
  add("lessons", "Lessons of 'view --lesson': faults, in a state that shows them", list_lessons);
  add("metrics", "Metrics with unit, range and definition", list_metrics);
  add("gpus", "GPUs whose costs a run can estimate", list_gpus);
  command.commands.back().add("--check", &a->check, "also ask this machine's Vulkan driver which it compiles for");
  add("gl", "The OpenGL context of a run", list_gl);
  command.commands.back().add("--measure", &a->measure, "").gone("a run measures what its rounding bounds need");
  add_backend_option(command.commands.back(), a->backend);
  return command;
}

}  // namespace shadowbench::cli
