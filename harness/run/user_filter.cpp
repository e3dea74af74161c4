#include "harness/run/user_filter.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "filters/base/error.h"
#include "filters/base/temporary_files.h"
#include "harness/gl/pixel_format.h"
#include "harness/run/task_images.h"
#include "harness/run/worker_process.h"
#include "report/images/picture_io.h"
#include "report/records/json_io.h"

namespace shadowbench::run {
namespace {

std::string request_text(const filters::FilterRequest& request) {
  std::string text = request.spec.id;
  char separator = ':';
  for (const std::string& name : request.set_by_user) {
    text += separator + name + "=" + filters::to_string(request.values.at(name));
    separator = ',';
  }
  return text;
}

std::vector<std::string> round_arguments(const options::RoundLimits& limits) {
  if (limits.is_fixed()) return {"--rounds", fmt::format("{}", limits.most)};
  return {"--precision", fmt::format("{}", limits.precision), "--budget", fmt::format("{}", 1e-3 * limits.budget_ms)};
}

std::vector<std::string> worker_arguments(const options::RunOptions& options, const measure::SceneTask& task,
                                          const filters::FilterRequest& request, const std::string& scene_argument,
                                          const std::string& backend, const std::filesystem::path& folder) {
  std::vector<std::string> arguments = {"run",           "--worker",
                                        "--scene",       scene_argument,
                                        "--filter-file", request.spec.path,
                                        "--filters",     "none," + request_text(request),
                                        "--map-size",    fmt::format("{}", task.map_size),
                                        "--size",        fmt::format("{}x{}", options.width, options.height),
                                        "--seed",        fmt::format("{}", options.seed),
                                        "--phases",      fmt::format("{}", options.phases),
                                        "--fit",         scene::describe_fit(options.fit),
                                        "--snap",        options.snap ? "on" : "off",
                                        "--map-format",  std::string(gl::pixel_format(options.map.format).name),
                                        "--pad-texels",  fmt::format("{}", measure::padding_texels(options)),
                                        "--border",      filters::to_string(options.range.border),
                                        "--far-test",    options.range.far_test ? "on" : "off",
                                        "--behind-test", options.range.behind_test ? "on" : "off",
                                        "--gl",          backend,
                                        "--out",         folder.string()};
  const auto add = [&](std::vector<std::string> more) { std::ranges::move(more, std::back_inserter(arguments)); };
  add(round_arguments(options.rounds));
  std::vector<std::string> gpus;
  for (const gpu::Gpu& gpu : options.gpus) gpus.push_back(gpu.name);
  add({"--gpu", gpus.empty() ? "none" : fmt::format("{}", fmt::join(gpus, ","))});
  if (options.ground) add({"--ground"});
  if (!task.scene->light.name.empty()) add({"--light-name", task.scene->light.name});
  if (options.stability) add({"--stability"});
  if (options.uncertainty) add({"--uncertainty"});
  if (options.map.curve.reversed) add({"--reversed-depth"});
  if (!options.map.curve.is_linear()) add({"--perspective-depth", fmt::format("{}", options.map.curve.far_over_near)});
  if (options.light) add({"--light", measure::describe_light(*options.light)});
  if (!options.lights.empty()) add({"--lights", fmt::format("{}", fmt::join(options.lights, ","))});
  for (const std::string& bias : options.bias_texts) add({"--bias", bias});
  return arguments;
}

measure::MeasuredCell failed_cell(const options::RunOptions& options, const measure::SceneTask& task,
                                  const filters::FilterRequest& request, const WorkerOutcome& outcome) {
  measure::MeasuredCell cell;
  cell.record = measure::make_record(options, task, request);
  cell.request = request;
  cell.label = request.label();
  if (outcome.timed_out) {
    cell.record.status = records::CellStatus::kTimeout;
    cell.record.message = fmt::format("not finished after {:g} s (--cell-timeout)", options.cell_timeout_s);
  } else {
    cell.record.status = records::CellStatus::kCrashed;
    cell.record.message =
        outcome.signal
            ? fmt::format("killed by signal {} ({})", outcome.signal, strsignal(outcome.signal))
            : fmt::format("ended with exit code {}: {}", *outcome.exit_code, clean_message(outcome.error_text));
  }
  for (const char* group :
       {"time_ms", "ratio_to_none", "lights", "cost", "receivers", "nan", "stability", "images", "gpu"})
    cell.record.absent[group] = cell.record.message;
  return cell;
}

measure::MeasuredCell read_cell(const options::RunOptions& options, const measure::SceneTask& task,
                                const filters::FilterRequest& request, const std::filesystem::path& folder) {
  measure::MeasuredCell cell;
  cell.request = request;
  cell.label = request.label();
  cell.record = records::read_cell(folder, measure::make_record(options, task, request).key);
  cell.record.images = {};
  options::RunOptions of_worker = options;
  of_worker.map_sizes = {task.map_size};
  of_worker.sizes = {{options.width, options.height}};
  of_worker.fits = {options.fit};
  cell.phases.resize(static_cast<std::size_t>(options.phases) - 1);
  images::ExrFile file = images::read_exr(folder / exr_name(of_worker, task));
  take_float_images(cell, file.parts);
  return cell;
}

}  // namespace

measure::MeasuredCell measure_user_filter(const options::RunOptions& options, const measure::SceneTask& task,
                                          const filters::FilterRequest& request, const std::string& scene_argument,
                                          const std::string& backend) {
  const ScratchFolder folder(make_temporary_folder_path(options.out, "worker"));
  const WorkerOutcome outcome = run_worker(
      worker_arguments(options, task, request, scene_argument, backend, folder.path()), options.cell_timeout_s);
  if (outcome.exit_code == 0) return read_cell(options, task, request, folder.path());
  const int code = outcome.exit_code.value_or(0);
  if (code >= static_cast<int>(ErrorKind::kUsage) && code <= static_cast<int>(ErrorKind::kOutput))
    throw Error(static_cast<ErrorKind>(code), clean_message(outcome.error_text));
  return failed_cell(options, task, request, outcome);
}

}  // namespace shadowbench::run
