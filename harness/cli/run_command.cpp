#include <fmt/format.h>
#include <unistd.h>

#include <iostream>
#include <memory>

#include "base/error.h"
#include "base/folder_lock.h"
#include "filters/filter_spec.h"
#include "harness/cli/arguments.h"
#include "harness/cli/commands.h"
#include "harness/cli/terminal.h"
#include "harness/engines/score_run.h"
#include "harness/gpu/facts_request.h"
#include "harness/run/merge.h"
#include "harness/run/run_experiment.h"
#include "report/pages/advice_text.h"
#include "report/pages/answer.h"
#include "report/records/json_io.h"

namespace shadowbench::cli {
namespace {

void run_with_notes(const options::RunOptions& options, options::Progress& progress) {
  for (const std::string& note : options.notes) progress.note("note: " + note);
  run::run_experiment(options, progress);
}

/// Says what the experiment's commands are, and whether they may run: a file of an experiment looks like data, and may
/// be somebody else's. Throws Error(kUsage) where nobody allows them.
void require_allowed(const std::vector<options::Engine>& engines, bool is_allowed) {
  for (const options::Engine& engine : engines) {
    std::string shown = make_visible(engine.command);  // whole, and on one line, so that nothing of it is hidden
    for (std::size_t at = 0; (at = shown.find('\n', at)) != shown.npos;) shown.replace(at, 1, "\\x0a");
    fmt::print(stderr, "command of {}: {}\n", make_readable(engine.name), shown);
  }
  if (engines.empty() || is_allowed) return;
  if (isatty(STDIN_FILENO) && isatty(STDERR_FILENO)) {
    fmt::print(stderr, "Run {} of the experiment? [y/N] ", engines.size() == 1 ? "this command" : "these commands");
    std::string answer;
    if (std::getline(std::cin, answer) && (answer == "y" || answer == "yes")) return;
  }
  fail(
      "the experiment has [[engine]] tables, whose commands would run as you: read them above, and if you trust them, "
      "give --allow-commands");
}

/// Adds the rows of the experiment's other renderers to the finished report.
void run_engines(const options::RunOptions& options, const RunArguments& arguments, options::Progress& progress) {
  if (arguments.engines.empty()) return;
  engines::RunScorer scorer(options, progress);
  engines::run_engines(scorer, arguments.engines, {}, options.cell_timeout_s, progress);
}

/// What --strict asks of a report, whether it was written now or before. Throws Error(kLimit).
void require_sound_report(const std::filesystem::path& out) {
  const records::Results results = records::read_results(out / "results.json");
  std::vector<std::string> complaints = results.run.warnings;
  for (const records::CellRecord& cell : results.cells)
    if (cell.status != records::CellStatus::kOk && cell.warnings.empty())
      complaints.push_back(fmt::format("{}: {}: {}", cell.scene, cell.filter, cell.message));
  require_no_warnings(complaints, "report");
}

/// Leaves in the run's folder which filters cannot be used, for `regress`, where that is what ended the run.
void note_filter_mistakes(const RunArguments& arguments, const std::exception& caught) {
  const std::filesystem::path out = arguments.out;
  const auto* error = dynamic_cast<const Error*>(&caught);
  if (!error || error->kind() != ErrorKind::kFilter) return;
  std::vector<filters::FilterMistake> mistakes;
  if (const auto* all = dynamic_cast<const filters::FilterErrors*>(error)) {
    mistakes = all->mistakes();
  } else {
    const std::string file = error->where().substr(0, error->where().rfind(':'));
    mistakes = {{std::filesystem::path(file).stem().string(), file, error->what()}};
  }
  try {
    const FolderLock lock(out, arguments.force);
    records::write_filter_mistakes(out, mistakes);
  } catch (const Error&) {
    // What is wrong with the filters is to be told first; the folder is complained of once they are right.
  }
}

/// The run's answer, its sentence bold on a terminal.
std::string describe_answer(const std::filesystem::path& out) {
  const records::Results results = records::read_results(out / "results.json");
  std::string text;
  pages::with_first_advice(
      results.cells, [&](const analysis::Advice& advice) { text = pages::make_answer_text(results.run, advice); });
  if (!text.empty() && isatty(STDOUT_FILENO)) text.insert(text.find('\n'), "\x1b[0m").insert(0, "\x1b[1m");
  return text;
}

int run_experiment(const CommandLine& line, RunArguments& arguments) {
  const auto is_on = [&](const char* flag) { return options::find_told<bool>(arguments.told, flag); };
  if (!is_on("--truth") && is_on("--attribution") && line.has("--attribution"))
    fail(
        "--attribution takes apart the errors against traced truth, which --no-truth leaves out: leave one of them "
        "out");
  const std::string title = apply_experiment(line, arguments);
  options::RunOptions options = make_run_options(arguments, line.words());
  options.title = title;
  if (!arguments.engines.empty() && options.part.shards > 1)
    fail(
        "--shard: the experiment's [[engine]] tables would be drawn by each shard; leave them out, and score the "
        "whole");
  require_allowed(arguments.engines, arguments.allow_commands);
  if (options.part.is_worker()) {
    run_with_notes(options, *make_progress());
    return 0;
  }
  work_with_progress(
      options.out,
      [&](options::Progress& progress) {
        run_with_notes(options, progress);
        run_engines(options, arguments, progress);
      },
      "what was finished stays, and the same command goes on from there", arguments.every_step);
  print("{}report: {}\nlimits: shadowbench advise {} --max-rmse 0.03\n", describe_answer(options.out),
        (options.out / "index.html").string(), options.out.string());
  if (arguments.strict) require_sound_report(options.out);
  return 0;
}

int run(const CommandLine& line, RunArguments& arguments) {
  try {
    return run_experiment(line, arguments);
  } catch (const std::exception& error) {
    if (!arguments.worker && !arguments.check) note_filter_mistakes(arguments, error);
    throw;
  }
}

}  // namespace

Command make_run_command() {
  Command command{"run", "Render scenes with filters and write a report"};
  command.examples = {"shadowbench run --out report/mine                           # eight filters, five scenes",
                      "shadowbench run --scene model.glb --filters all             # your scene, every filter",
                      "shadowbench run --scene fence --map-size 512,1024,2048      # which map size pays"};
  auto a = std::make_shared<RunArguments>();
  add_run_options(command, *a);
  command.action = [a](const CommandLine& line) { return run(line, *a); };
  return command;
}

Command make_gpu_facts_command() {
  struct Files {
    std::string request, answers;
  };
  Command command{"gpu-facts", "Compile passes for a GPU and say what its compiler says"};
  command.hidden = true;
  auto files = std::make_shared<Files>();
  command.add("REQUEST", &files->request, "what to compile").names(ValueKind::kFile).require();
  command.add("ANSWERS", &files->answers, "where the facts go, a line for each pass").names(ValueKind::kFile).require();
  command.action = [files](const CommandLine&) {
    gpu::answer_request(files->request, files->answers);
    return 0;
  };
  return command;
}

Command make_merge_command() {
  struct Arguments {
    std::vector<std::string> folders;
    std::string out, times;
    bool force = false;
  };
  Command command{"merge", "Merge the shards of 'run' into one report"};
  command.about = "Makes one report of the folders of 'run --shard 1/N' to 'N/N'.";
  auto a = std::make_shared<Arguments>();
  command.add("DIR", &a->folders, "report folders of all shards of one experiment").names(ValueKind::kFolder).require();
  command.add("--times", &a->times, "").gone("load the file in the report's page, or give it to 'advise --times'");
  command.add("--out", &a->out, "folder of the merged report; new or empty").names(ValueKind::kFolder).require();
  add_force_option(command, a->force);
  command.action = [a](const CommandLine&) {
    {
      const Interruption interruption(a->out, kStoppedAdvice);
      run::merge_runs({a->folders.begin(), a->folders.end()}, a->out, a->force);
    }
    print("report: {}\n", (std::filesystem::path(a->out) / "index.html").string());
    return 0;
  };
  return command;
}

}  // namespace shadowbench::cli
