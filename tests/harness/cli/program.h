#pragma once

#include <sys/wait.h>
#include <unistd.h>
#include <wordexp.h>

#include <nlohmann/json.hpp>

#include "harness/cli/commands.h"
#include "harness/gl/survey.h"
#include "tests/filters/filtered.h"
#include "tests/test_files.h"

namespace shadowbench::test {

using nlohmann::json;

/// What a run of the program gave.
struct Outcome {
  int exit_code = -1;
  std::string out;
  std::string err;
};

/// A folder of its own for each test, removed afterwards; runs the program in it.
class ProgramTest : public ::testing::Test {
 protected:
  const std::filesystem::path& folder() const { return folder_.path(); }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    return folder_.write(name, text);
  }

  /// A file of the program's source.
  static std::string read_source(const std::string& name) {
    return read_text(std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / name);
  }

  /// Writes a built-in filter as a user's, with `lines` before its title.
  void copy_filter(const std::string& id, const std::string& name, const std::string& lines = "") const {
    std::string text = read_source("filters/" + id + ".glsl");
    write(name + ".glsl", text.insert(text.find("title ="), lines));
  }

  /// The llvmpipe of Mesa 22 ends long loops, that of Mesa 25 does not.
  static bool does_gl_end_loops() {
    const auto context = gl::create_context(gl::Backend::kSoftware).context;
    return gl::measure_loop_turns() > 0;
  }

  /// Where the program keeps traced images: a folder of each test's own.
  std::filesystem::path cache_folder() const { return folder() / "cache"; }

  /// Runs that name no GPUs compile for none, and those that ask for no grids draw none: the one would take long with
  /// an empty cache, the other is half of a small run.
  static std::string with_test_defaults(const std::string& arguments) {
    if (!arguments.starts_with("run ")) return arguments;
    const auto lacks = [&](const char* option) { return arguments.find(option) == std::string::npos; };
    return std::string("run") + (lacks("--gpu") ? " --gpu none" : "") + (lacks("grids") ? " --no-grids" : "") +
           arguments.substr(3);
  }

  /// Runs `shadowbench ARGUMENTS`, which the shell would split into words: in a process of its own where it has an
  /// `environment` of its own, as in "NAME=value NAME=value", and within this one otherwise.
  Outcome run(const std::string& arguments, const std::string& environment = "") const {
    return run_as_it_stands(with_test_defaults(arguments), environment);
  }

  Outcome run_as_it_stands(const std::string& arguments, const std::string& environment = "") const {
    return environment.empty() ? run_within(arguments) : run_process(arguments, environment);
  }

  /// Runs what must succeed.
  Outcome succeed(const std::string& arguments, const std::string& environment = "") const {
    Outcome outcome = run(arguments, environment);
    EXPECT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.err;
    return outcome;
  }

  std::string read(const std::string& name) const { return folder_.read(name); }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder() / name); }
  json read_json(const std::string& name) const { return json::parse(read(name)); }
  json read_results(const std::string& out = "out") const { return read_json(out + "/results.json"); }
  json read_cells(const std::string& out = "out") const { return read_results(out)["cells"]; }

  /// A small run on `cubes` into the folder `out`, unless the rest says otherwise.
  static std::string small(const std::string& rest) {
    std::string words = "run " + rest;
    for (const std::string usual : {" --out out", " --size 64x36", " --map-size 64", " --rounds 1", " --scene cubes"})
      if (words.find(usual.substr(0, usual.rfind(' ') + 1)) == std::string::npos) words += usual;
    return words;
  }

  /// Does one, and gives its cells.
  json measure(const std::string& rest) const {
    succeed(small(rest));
    return read_cells();
  }

  /// Expects that the results follow their schema.
  void expect_valid() const {
    const std::string out = (folder() / "out").string();
    const std::string check =
        "/usr/bin/python3 -m jsonschema -i '" + out + "/results.json' '" + out + "/results.schema.json'";
    EXPECT_EQ(std::system(check.c_str()), 0);
  }

  Outcome run_process(const std::string& arguments, const std::string& environment = "") const {
    const std::string command = "cd '" + folder().string() + "' && XDG_CACHE_HOME='" + cache_folder().string() + "' " +
                                environment + " '" SHADOWBENCH_PROGRAM "' " + arguments +
                                " >stdout.txt 2>stderr.txt </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(folder() / "stdout.txt"),
            read_text(folder() / "stderr.txt")};
  }

  /// Expects one clear message with all the words, the exit code, and that a report is as it was, or none.
  void expect_refusal(const std::string& arguments, int exit_code, const std::vector<std::string>& words) const {
    const std::string report = read("out/results.json");
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.err;
    const std::size_t begin = outcome.err.rfind("shadowbench: ");
    ASSERT_NE(begin, std::string::npos) << outcome.err;
    for (const std::string& word : words) EXPECT_NE(outcome.err.find(word, begin), std::string::npos) << outcome.err;
    EXPECT_EQ(read("out/results.json"), report);
  }

  /// Words, the exit code, and what the message holds.
  struct Refusal {
    std::string words;
    int exit_code;
    std::vector<std::string> message;
  };

  void expect_refusals(const std::vector<Refusal>& refusals) const {
    for (const auto& [words, exit_code, message] : refusals) {
      SCOPED_TRACE(words);
      expect_refusal(words, exit_code, message);
    }
  }

  /// Does a run in the first test that asks for it, and gives the others a copy of its folder.
  void draw_once(const std::string& words, const std::string& out = "out") const {
    static const TestFolder kept;
    const std::filesystem::path made = kept.path() / std::to_string(std::hash<std::string>()(words));
    std::filesystem::remove_all(folder() / out);
    if (!std::filesystem::exists(made)) {
      succeed(words + " --out " + out);
      std::filesystem::create_directories(made);
      return std::filesystem::copy(folder() / out, made, std::filesystem::copy_options::recursive);
    }
    std::filesystem::create_directories(folder() / out);
    std::filesystem::copy(made, folder() / out, std::filesystem::copy_options::recursive);
  }

  static std::string user_filter(const std::string& name) {
    return std::string(SHADOWBENCH_SOURCE_DIR) + "/tests/user_filters/" + name;
  }

 private:
  Outcome run_within(const std::string& arguments) const {
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(folder());
    setenv("XDG_CACHE_HOME", cache_folder().c_str(), 1);
    std::vector<std::string> words{SHADOWBENCH_PROGRAM};
    wordexp_t split{};
    EXPECT_EQ(wordexp(arguments.c_str(), &split, WRDE_NOCMD | WRDE_UNDEF), 0) << arguments;
    words.insert(words.end(), split.we_wordv, split.we_wordv + split.we_wordc);
    wordfree(&split);
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int exit_code = cli::run_program(words);
    const Outcome outcome{exit_code, testing::internal::GetCapturedStdout(), testing::internal::GetCapturedStderr()};
    std::filesystem::current_path(before);
    write("stdout.txt", outcome.out);
    write("stderr.txt", outcome.err);
    return outcome;
  }

  const TestFolder folder_;
};

}  // namespace shadowbench::test
