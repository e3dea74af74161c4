#pragma once

#include <chrono>
#include <optional>
#include <thread>

#include "report/images/picture_io.h"
#include "report/records/json_io.h"
#include "tests/harness/cli/program.h"

namespace shadowbench::test {

/// How a process ended.
struct Ending {
  std::optional<int> exit_code;
  int signal = 0;  ///< that killed it; 0: none
};

/// Runs the program where things go wrong, and looks at what it leaves.
class FaultTest : public ProgramTest {
 protected:
  /// Starts `shadowbench ARGUMENTS` in the test's folder and does not wait; its messages go to a file there.
  pid_t start(const std::string& arguments, const std::string& messages = "started.txt") const {
    const std::string command = "exec env XDG_CACHE_HOME='" + cache_folder().string() + "' '" SHADOWBENCH_PROGRAM "' " +
                                with_test_defaults(arguments) + " >/dev/null 2>'" + messages + "' </dev/null";
    const std::string where = folder().string();
    std::filesystem::remove(folder() / messages);  // a signal may come before the shell makes it anew
    const pid_t pid = fork();
    if (pid == 0) {
      if (chdir(where.c_str()) == 0) execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
      _exit(127);
    }
    return pid;
  }

  /// Starts a run that stays in the folder `out` until it is killed.
  pid_t start_endless() const {
    return start(
        "run --size 320x180 --map-size 64 --rounds 1 --scene cubes --filters none,endless --cell-timeout 600 --out out "
        "--filter-file " +
        user_filter("endless.glsl"));
  }

  static Ending wait_for(pid_t pid) {
    int status = 0;
    waitpid(pid, &status, 0);
    if (WIFSIGNALED(status)) return {std::nullopt, WTERMSIG(status)};
    return {WEXITSTATUS(status), 0};
  }

  /// Waits until something holds, a minute at most unless told.
  template <class Condition>
  static bool wait_until(const Condition& holds, int hundredths_s = 6000) {
    for (int i = 0; i < hundredths_s; ++i) {
      if (holds()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }

  /// Processes that work in the test's folder, or were told of a file there, with this word.
  std::vector<std::string> list_processes(const std::string& word = {}) const {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
      std::error_code gone;
      const std::string cwd = std::filesystem::read_symlink(entry.path() / "cwd", gone),
                        command = read_text(entry.path() / "cmdline");
      if ((cwd + command).find(folder().string()) != std::string::npos && command.find(word) != std::string::npos)
        found.push_back(entry.path().filename().string() + " " + command);
    }
    return found;
  }

  /// Those that are being ended are given a moment, in which nothing ends by itself.
  void expect_no_process() const {
    wait_until([&] { return list_processes().empty(); }, 200);
    EXPECT_THAT(list_processes(), IsEmpty());
  }

  std::size_t count_cells(const std::string& out = "out") const {
    std::size_t cells = 0;
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder() / out / "cells", ignored))
      cells += is_cell(entry.path()) ? 1 : 0;
    return cells;
  }

  /// The last line of a text.
  static std::string last_line(std::string text) {
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text.substr(text.rfind('\n') + 1);
  }

  /// Expects one message, at the end, with all the words.
  static void expect_one_message(const std::string& text, const std::vector<std::string>& words) {
    std::size_t count = 0;
    for (std::size_t at = text.find("shadowbench: "); at != std::string::npos; at = text.find("shadowbench: ", at + 1))
      ++count;
    EXPECT_EQ(count, 1u) << text;
    EXPECT_THAT(last_line(text), StartsWith("shadowbench: ")) << text;
    for (const std::string& word : words) EXPECT_THAT(last_line(text), HasSubstr(word));
  }

  /// Expects that no file below a folder is temporary.
  void expect_no_leftovers(const std::string& name) const {
    for (const auto& path : list_files(name))
      for (const char* mark : {"shadowbench-tmp", ".worker-", ".gpu-", ".plots-", "shadowbench-lock"})
        EXPECT_THAT(path.string(), Not(HasSubstr(mark)));
  }

  /// Expects that every file below a folder that has a name of its own can be read to its end.
  void expect_whole(const std::string& name) const {
    for (const auto& path : list_files(name)) {
      if (path.filename().string().starts_with(".shadowbench") ||
          path.string().find("shadowbench-tmp") != std::string::npos)
        continue;
      if (path.string().find("/.worker-") != std::string::npos || path.string().find("/.plots-") != std::string::npos)
        continue;
      EXPECT_EQ(find_damage(path), "") << path;
    }
  }

  /// Expects the same cells in the same order, but for times, with the same pictures.
  void expect_same(const std::string& a, const std::string& b) const {
    const json first = read_results(a), second = read_results(b);
    ASSERT_EQ(first["cells"].size(), second["cells"].size());
    for (std::size_t i = 0; i < first["cells"].size(); ++i) {
      const json& cell = first["cells"][i];
      EXPECT_EQ(without_times(cell), without_times(second["cells"][i])) << i;
      for (const char* kind : {"picture", "visibility"}) {
        const std::string image = cell["images"][kind];
        EXPECT_EQ(read_text(folder() / a / image), read_text(folder() / b / image)) << image;
      }
    }
    for (const char* key : {"experiment", "warnings", "scenes", "gl", "commit", "seed"})
      EXPECT_EQ(first[key], second[key]) << key;
  }

  /// The start of a shell command in which file systems can be mounted; nothing where they cannot.
  std::optional<std::string> find_mounting_shell() const {
    for (const char* unshare : {"unshare -m", "unshare -rm"}) {
      const std::string probe = std::string(unshare) + " sh -c 'mount -t tmpfs -o size=64k none \"" +
                                folder().string() + "\"' >/dev/null 2>&1";
      if (std::system(probe.c_str()) == 0) return unshare;
    }
    return std::nullopt;
  }

  /// Runs a script in such a shell, in the test's folder, with `shadowbench` in it; gives its exit code.
  int run_script(const std::string& shell, const std::string& script) const {
    const std::string text =
        "cd '" + folder().string() + "' || exit 99\nexport XDG_CACHE_HOME='" + cache_folder().string() +
        "'\nshadowbench() { if [ \"$1\" = run ]; then shift; set -- run --gpu none \"$@\"; fi; '" SHADOWBENCH_PROGRAM
        "' \"$@\"; }\n" +
        script;
    const int status = std::system((shell + " sh '" + write("script.sh", text).string() + "' >/dev/null 2>'" +
                                    (folder() / "script.txt").string() + "'")
                                       .c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  static json without_times(json cell) {
    for (const char* name : {"time_ms", "ratio_to_none", "measured_s"}) cell.erase(name);
    cell["images"].erase("frames");  // a file of frames is named for the cells that were drawn together
    // What a page shows first depends on all of its cells' times.
    for (const char* name : {"supersampled", "truth_supersampled", "samples"}) cell["images"].erase(name);
    return cell;
  }

  std::vector<std::filesystem::path> list_files(const std::string& name) const {
    std::vector<std::filesystem::path> files;
    if (!std::filesystem::is_directory(folder() / name)) return files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder() / name))
      if (entry.is_regular_file()) files.push_back(entry.path());
    return files;
  }

 private:
  static bool is_cell(const std::filesystem::path& path) {
    return path.extension() == ".json" && path.stem().string().size() == 16;
  }

  /// Gives what is wrong with a file; empty: nothing.
  static std::string find_damage(const std::filesystem::path& path) {
    const std::string kind = path.extension().string(), text = read_text(path);
    const auto ends_in = [&](const char* end) {
      return text.find(end, text.size() < 16 ? 0 : text.size() - 16) != std::string::npos ? "" : "cut off";
    };
    try {
      if (kind == ".exr") images::read_exr(path);
      if (kind == ".png") images::read_picture(path);
      if (kind == ".json" && !json::accept(text)) return "cut off";
      if (kind == ".json" && is_cell(path)) records::read_cell(path.parent_path().parent_path(), path.stem().string());
    } catch (const std::exception& error) {
      return error.what();
    }
    if (kind == ".html") return ends_in("</html>");
    return text.empty() ? "empty" : kind == ".csv" || kind == ".md" ? ends_in("\n") : "";
  }
};

}  // namespace shadowbench::test
