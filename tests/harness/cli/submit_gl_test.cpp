// A sweep that is submitted, with no scheduler: its scripts, its tasks done by hand, and their report. tests/cluster
// has a real one.

#include "tests/harness/cli/sweep.h"

namespace shadowbench::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kDry = "submit e.toml --gpu none --engine slurm --dry-run --out out ";

class Submit : public Sweep {
 protected:
  /// Does a task as its job would.
  Outcome do_task(const std::string& task, const std::string& more = "") const {
    const std::string out = (folder() / "out").string();
    return run("run e.toml --no-grids --cache '" + out + "/cache' --out '" + out + "' --task '" + out + "/" + task +
               "' " + more);
  }
};

TEST_F(Submit, TasksDoneByHand_AndMerged_EqualTheWhole) {
  ASSERT_EQ(run("run e.toml --out whole").exit_code, 0);
  const Outcome outcome = run(std::string(kDry) + "--tasks 5");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("5 tasks of " + std::to_string(kCells) + " cells"));
  for (const char* task : {"truth/1", "truth/2"}) ASSERT_EQ(do_task(task).exit_code, 0) << task;
  EXPECT_TRUE(std::filesystem::is_empty(folder() / "out" / "cells")) << "truth alone";
  for (const char* task : {"tasks/3", "tasks/1", "tasks/5", "tasks/2"}) ASSERT_EQ(do_task(task).exit_code, 0) << task;
  const Outcome early = run("merge out");
  EXPECT_EQ(early.exit_code, 1);
  EXPECT_THAT(early.err, HasSubstr("not all cells are measured"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "out" / "results.json"));
  const json status = json::parse(run("status out --json").out);
  EXPECT_EQ(status["tasks"][3]["state"], "waiting");
  EXPECT_EQ(status["tasks"][4]["state"], "finished");
  ASSERT_EQ(do_task("tasks/4").exit_code, 0);
  ASSERT_EQ(run("merge out").exit_code, 0);
  expect_same("whole", "out");
  for (const json& cell : results()["cells"]) {
    const std::string image = cell["images"]["picture"];
    EXPECT_EQ(read_text(folder() / "out" / image), read_text(folder() / "whole" / image)) << image;
  }
  EXPECT_EQ(results()["work"]["truths_traced"], results("whole")["work"]["truths_traced"]) << "each is traced once";
  EXPECT_THAT(run(kDry).out, ::testing::StartsWith("nothing is left to do\n"));
}

TEST_F(Submit, WithoutANumberOfTasks_HasTwiceTheSquareRootOfItsCells) {
  static_assert(kCells == 48);
  EXPECT_THAT(run(kDry).out, HasSubstr("14 tasks of 48 cells\n"));
}

TEST_F(Submit, ATaskGoesOnWhereItStopped) {
  ASSERT_EQ(run(std::string(kDry) + "--tasks 2").exit_code, 0);
  ASSERT_EQ(do_task("tasks/1").exit_code, 0);
  const auto before = cell_times();
  std::filesystem::remove(folder() / "out" / "cells" / before.begin()->first);
  std::filesystem::remove(folder() / "out" / "tasks" / "1" / "result.json");
  const Outcome again = do_task("tasks/1");
  EXPECT_THAT(again.err, HasSubstr(std::to_string(before.size() - 1) + " of them finished before"));
  const auto after = cell_times();
  for (const auto& [name, time] : before)
    if (name != before.begin()->first) EXPECT_EQ(after.at(name), time) << name << " was measured twice";
  EXPECT_EQ(after.size(), before.size());
}

/// What one task has compiled, another takes: its own driver, which is none, is not asked.
TEST_F(Submit, TasksShareWhatTheyCompile) {
  const std::string words = "e.toml --gpu navi21 ";
  ASSERT_EQ(run("submit " + words + "--engine slurm --dry-run --out out --tasks 4").exit_code, 0);
  const auto do_it = [&](const std::string& task, const std::string& environment) {
    const std::string out = (folder() / "out").string();
    return run("run " + words + "--no-grids --cache out/cache --out '" + out + "' --task out/tasks/" + task,
               environment);
  };
  const Outcome first = do_it("1", "");
  ASSERT_EQ(first.exit_code, 0) << first.err;
  if (first.err.find("no costs on navi21") != std::string::npos) GTEST_SKIP() << "there is no driver";
  const Outcome second = do_it("2", "VK_DRIVER_FILES=/nowhere VK_ICD_FILENAMES=/nowhere");
  ASSERT_EQ(second.exit_code, 0) << second.err;
  EXPECT_THAT(second.err, Not(HasSubstr("no costs on navi21")));
  EXPECT_EQ(cell_times().size(), kCells / 2);
  for (const auto& [name, time] : cell_times())
    EXPECT_FALSE(json::parse(read_text(folder() / "out" / "cells" / name))["cell"]["gpu"]["navi21"]["facts"].empty())
        << name;
}

/// A job that was cancelled before its process showed itself leaves a line of its scheduler, and no task undone.
TEST_F(Submit, WhatPrintedAndIsInNoQueue_IsSubmittedAgain_AndWhatShowsThatItRunsIsNot) {
  ASSERT_EQ(run(std::string(kDry) + "--tasks 3").exit_code, 0);
  ASSERT_EQ(do_task("tasks/1").exit_code, 0);
  write("out/tasks/2/log.txt", "slurmstepd: error: *** JOB 29 ON node1 CANCELLED ***\n");
  write("out/tasks/3/alive", "7 another-machine\n");
  const Outcome status = run("status out --json");
  EXPECT_EQ(json::parse(status.out)["tasks"][1]["state"], "running") << "it may yet begin";
  EXPECT_EQ(json::parse(status.out)["tasks"][2]["state"], "running");
  const Outcome outcome = run(kDry);
  EXPECT_THAT(outcome.out, HasSubstr("1 task of "));
  EXPECT_THAT(read_text(folder() / "out" / "submit.sbatch"), HasSubstr("#SBATCH --array=2\n"));
  EXPECT_THAT(outcome.err, HasSubstr("not submitted"));
  EXPECT_THAT(outcome.err, HasSubstr("in no queue: task 3;"));
}

/// A cancelled job stays in the queue until its processes have ended.
TEST_F(Submit, JobsThatAreEnding_AreWaitedFor) {
  const std::filesystem::path bin = folder() / "bin";
  const auto write_tool = [&](const char* name, const std::string& text) {
    std::filesystem::create_directories(bin);
    write(std::string("bin/") + name, "#!/bin/sh\n" + text + "\n");
    std::filesystem::permissions(bin / name, std::filesystem::perms::owner_all);
  };
  write_tool("sbatch", "echo 77");
  write_tool("scancel", "");
  write_tool("squeue", "echo asked >> '" + bin.string() + "/asked'; test $(grep -c . '" + bin.string() +
                           "/asked') -gt 2 || echo 2 COMPLETING");
  const std::string words = "submit e.toml --gpu none --engine slurm --tasks 3 --out out";
  const std::string path = "PATH='" + bin.string() + "':/usr/bin:/bin";
  EXPECT_THAT(run(words, path).out, HasSubstr("job 77: 3 tasks of"));
  EXPECT_FALSE(std::filesystem::exists(bin / "asked"));
  EXPECT_THAT(run(words, path).out, HasSubstr("job 77: 3 tasks of")) << "of those none is in the queue any more";
  write_tool("squeue", "echo '2 PENDING'; echo squeue: warning: 3 of it");
  EXPECT_THAT(run(words, path).out, HasSubstr("job 77: 2 tasks of"));
}

TEST_F(Submit, ATaskOfSomethingElse_Fails_AndStatusSaysWhy) {
  ASSERT_EQ(run(std::string(kDry) + "--tasks 2").exit_code, 0);
  EXPECT_EQ(do_task("tasks/1", "--seed 2").exit_code, 3);
  EXPECT_EQ(do_task("tasks/2", "--map-size 32").exit_code, 3);
  const Outcome status = run("status out");
  EXPECT_EQ(status.exit_code, 1);
  EXPECT_THAT(status.out, HasSubstr("task 1 failed: exit code 3: the experiment is no longer what was submitted"));
  EXPECT_THAT(status.out, HasSubstr("task 2 failed"));
  ASSERT_EQ(do_task("tasks/1").exit_code, 0);
  EXPECT_THAT(run("status out").out, Not(HasSubstr("task 1 ")));
}

TEST_F(Submit, TheFolderOfASweep_IsItsOwn) {
  ASSERT_EQ(run(std::string(kDry) + "--tasks 2").exit_code, 0);
  EXPECT_EQ(run("run e.toml --out out").exit_code, 2);
  EXPECT_THAT(read_text(folder() / "stderr.txt"), HasSubstr("a sweep was submitted into this folder"));
  EXPECT_EQ(run(std::string(kDry) + "--tasks 3 --map-size 16").exit_code, 0) << "nobody had submitted it";
  ASSERT_EQ(do_task("tasks/1", "--map-size 16").exit_code, 0);
  EXPECT_EQ(run(kDry).exit_code, 2);
  EXPECT_THAT(read_text(folder() / "stderr.txt"), HasSubstr("the sweep in this folder is of another experiment"));
}

/// Grids are the experiment's wish, and no task's.
TEST_F(Submit, GridsOfAnExperiment_AreLeftOut) {
  write("e.toml", "scene = 'cubes'\nmap_size = 16\nsize = '16x9'\nrounds = 1\ngrids = true\nfilters = 'none'\n");
  const Outcome outcome = run(kDry);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(read_text(folder() / "out" / "submit.sbatch"), HasSubstr(" --no-grids "));
}

TEST_F(Submit, BadWords_AreRefused) {
  expect_refusal("submit e.toml --out out", 2, {"--engine is required"});
  expect_refusal("submit e.toml --engine slurm", 2, {"--out is required"});
  expect_refusal("submit e.toml --engine pbs --out out", 2, {"'pbs'", "slurm, parallel"});
  expect_refusal("submit e.toml --engine slurm --tasks 0 --out out", 2, {"--tasks", "'0'"});
  expect_refusal("submit e.toml --engine slurm --grids --out out", 2, {"--grids"});
  expect_refusal("submit e.toml --engine slurm --shard 1/2 --out out", 2, {"--shard"});
  expect_refusal("submit e.toml --engine slurm --until-different none,vsm --out out", 2, {"--until-different"});
  expect_refusal("submit e.toml --engine slurm --out out -- --array=1-9%4", 2, {"--array", "arraytaskthrottle"});
  expect_refusal("submit e.toml --engine slurm --out out -- -a1-9", 2, {"-a", "arraytaskthrottle"});
  expect_refusal("submit e.toml --engine parallel --time 3 --out out", 2, {"--time", "--engine slurm"});
  expect_refusal("status nosuch", 3, {"nosuch/tasks.json"});
  expect_refusal("status out --silent-after 0", 2, {"--silent-after"});
  expect_refusal("merge nosuch", 2, {"'nosuch'", "--out"});
  EXPECT_FALSE(std::filesystem::exists(folder() / "out"));
}

/// Without Slurm, or where it refuses, nothing is queued, and the same command goes on.
TEST_F(Submit, WithoutItsEngine_IsRefused) {
  const std::string words = "submit e.toml --gpu none --out out --engine ";
  for (const char* engine : {"slurm", "parallel"}) {
    const Outcome outcome = run(words + engine, "PATH=/nowhere");
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(std::string("--engine ") + engine));
    EXPECT_EQ(run("status out").exit_code, 0);
  }
}

/// No line of options can hold some characters.
TEST_F(Submit, WhatSlurmCannotBeTold_IsRefused_OrReplaced) {
  const Outcome outcome = run("submit e.toml --gpu none --dry-run --engine slurm --out 'a \"b\"'");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("double quote"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "a \"b\"")) << "nothing was planned there";
  std::filesystem::copy_file(folder() / "e.toml", folder() / "my \"e\".toml");
  EXPECT_EQ(run("submit 'my \"e\".toml' --gpu none --dry-run --engine slurm --out out").exit_code, 0);
  EXPECT_THAT(read_text(folder() / "out" / "submit.sbatch"), HasSubstr("#SBATCH --job-name=\"my _e_-tasks\"\n"));
}

TEST_F(Submit, Scripts_TakeOddFoldersAndPassWordsOn) {
  const Outcome outcome =
      run("submit e.toml --gpu none --dry-run --engine slurm --tasks 3 --time 1:30 --partition fast "
          "--gres gpu:1 --cache 'my cache' --out \"it's 100%\" -- --comment='two words' --qos low");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("'--comment=two words' --qos low"));
  EXPECT_THAT(outcome.out, HasSubstr("--dependency=afterok:TRUTH"));
  EXPECT_THAT(outcome.out, HasSubstr("--dependency=afterany:CELLS"));
  const std::filesystem::path out = folder() / "it's 100%";
  const std::string script = read_text(out / "submit.sbatch");
  for (const char* line :
       {"#SBATCH --array=1-3\n", "#SBATCH --time=1:30\n", "#SBATCH --partition=fast\n", "#SBATCH --gres=gpu:1\n",
        "it's 100%%/tasks/%a/log.txt\"\n", "/my cache'", "'\\''s 100%/tasks'/\"$SLURM_ARRAY_TASK_ID\"\n"})
    EXPECT_THAT(script, HasSubstr(line));
  EXPECT_THAT(script, Not(HasSubstr("--qos"))) << "that is for sbatch";
  // The last line, with the number that Slurm gives, does a task.
  const std::string last = script.substr(script.rfind("exec "));
  EXPECT_EQ(std::system(("cd '" + folder().string() + "' && SLURM_ARRAY_TASK_ID=2 sh -c \"$(cat <<'END'\n" + last +
                         "END\n)\" 2>/dev/null")
                            .c_str()),
            0);
  EXPECT_TRUE(std::filesystem::exists(out / "tasks" / "2" / "result.json"));
}

}  // namespace
}  // namespace shadowbench::test
