#include "harness/submit/sweep_status.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/temporary_files.h"
#include "harness/submit/sign_of_life.h"
#include "report/records/json_io.h"

namespace shadowbench::submit {
namespace {

using ::testing::HasSubstr;

/// A sweep of one task that traces and four that measure two cells each.
class SweepStatusTest : public ::testing::Test {
 protected:
  SweepStatusTest() : scratch_(make_temporary_folder_path(std::filesystem::temp_directory_path(), "status")) {
    std::filesystem::create_directories(out());
    write_task(out(), {.kind = TaskKind::kTruth, .number = 1, .ranges = {{0, 8}}, .keys = {}, .content = "t"});
    for (int i = 1; i <= 4; ++i) {
      const std::string key = "000000000000000" + std::to_string(i);
      write_task(out(),
                 {.number = i, .ranges = {{2 * i - 2, 2 * i}}, .keys = {key, "f" + key.substr(1)}, .content = "c"});
    }
    write_sweep(out(), {.title = "t",
                        .settings = "s",
                        .command = {"a", "b c"},
                        .scene_cells = {8},
                        .cells = 8,
                        .truths = 1,
                        .tasks = 4,
                        .jobs = {{"slurm", "1", "2", "3"}}});
  }

  const std::filesystem::path& out() const { return scratch_.path(); }
  std::filesystem::path task(int number) const { return task_folder(out(), TaskKind::kCells, number); }
  TaskStatus status(int number, double silent_after_s = 60.0) const {
    return read_status(out(), silent_after_s).tasks[static_cast<std::size_t>(number - 1)];
  }

 private:
  ScratchFolder scratch_;
};

TEST_F(SweepStatusTest, OfFiles_ComesBackAsItWasWritten) {
  const Sweep sweep = read_sweep(out());
  EXPECT_EQ(sweep.title, "t");
  EXPECT_THAT(sweep.command, ::testing::ElementsAre("a", "b c"));
  EXPECT_THAT(sweep.scene_cells, ::testing::ElementsAre(8));
  EXPECT_EQ(sweep.jobs.at(0).cells, "2");
  const SweepTask read = read_task(task(3));
  EXPECT_EQ(read.kind, TaskKind::kCells);
  EXPECT_EQ(read.number, 3);
  EXPECT_THAT(read.ranges, ::testing::ElementsAre(options::CellRange{4, 6}));
  EXPECT_EQ(read.keys.at(1), "f000000000000003");
  EXPECT_EQ(read.content, "c");
  EXPECT_EQ(read_task(task_folder(out(), TaskKind::kTruth, 1)).kind, TaskKind::kTruth);
}

TEST_F(SweepStatusTest, OfATask_GoesFromWaitingToFinished) {
  EXPECT_EQ(status(1).state, TaskState::kWaiting);
  {
    const SignOfLife alive(task(1));
    EXPECT_EQ(status(1).state, TaskState::kRunning);
    write_text_file(records::cell_path(out(), status(1).task.keys[0]), "{}");
    EXPECT_EQ(status(1).cells, 1);
    write_text_file(records::cell_path(out(), status(1).task.keys[1]), "{}");
    write_result(task(1), {});
    EXPECT_EQ(status(1).state, TaskState::kFinished);
  }
  EXPECT_EQ(status(1).state, TaskState::kFinished);
  EXPECT_FALSE(read_status(out()).is_measured()) << "three are left";
}

TEST_F(SweepStatusTest, OfATaskThatFailed_SaysWhy_UntilItRunsAgain) {
  write_failure(task(2), {5, "mine.glsl:3: no such function"});
  EXPECT_EQ(status(2).state, TaskState::kFailed);
  EXPECT_THAT(status(2).message, HasSubstr("exit code 5: mine.glsl:3"));
  EXPECT_THAT(describe_status(read_status(out())), HasSubstr("task 2 failed: exit code 5"));
  const SignOfLife alive(task(2));
  EXPECT_EQ(status(2).state, TaskState::kRunning);
  remove_failure(task(2));
  EXPECT_FALSE(read_failure(task(2)));
}

/// Age is the file system's: no clock of a machine is asked.
TEST_F(SweepStatusTest, OfATaskThatIsSilent_IsLost) {
  const std::filesystem::path alive = task(3) / "alive";
  write_text_file(alive, "process 1 on a machine that is gone\n");
  EXPECT_EQ(status(3).state, TaskState::kRunning);
  std::filesystem::last_write_time(alive, file_system_now(out()) - std::chrono::seconds(100));
  EXPECT_EQ(status(3, 60.0).state, TaskState::kLost);
  EXPECT_EQ(status(3, 200.0).state, TaskState::kRunning);
  EXPECT_THAT(status(3, 60.0).message, HasSubstr("shown nothing for 100 s"));
  // A machine whose clock is an hour ahead wrote it: it runs.
  std::filesystem::last_write_time(alive, file_system_now(out()) + std::chrono::hours(1));
  EXPECT_EQ(status(3).state, TaskState::kRunning);
}

TEST_F(SweepStatusTest, OfATaskWhoseCellsAreGone_IsLost) {
  for (const std::string& key : status(1).task.keys) write_text_file(records::cell_path(out(), key), "{}");
  write_result(task(1), {});
  ASSERT_EQ(status(1).state, TaskState::kFinished);
  std::filesystem::remove(records::cell_path(out(), status(1).task.keys[0]));
  EXPECT_EQ(status(1).state, TaskState::kLost);
  EXPECT_THAT(status(1).message, HasSubstr("1 of its cells are gone"));
  write_text_file(records::cell_path(out(), status(1).task.keys[0]), "{}");
  write_text_file(task(1) / "result.json", "{");
  EXPECT_EQ(status(1).state, TaskState::kWaiting) << "a damaged result is none";
}

TEST_F(SweepStatusTest, OfATaskWhoseProcessHasEnded_IsLostAtOnce) {
  write_text_file(task(1) / "alive", "99999999 " + this_writer().host + "\nprocess 99999999 on this machine\n");
  EXPECT_EQ(status(1).state, TaskState::kLost);
  EXPECT_THAT(status(1).message, HasSubstr("its process has ended"));
  write_text_file(task(1) / "alive", "99999999 elsewhere\nprocess 99999999 on elsewhere\n");
  EXPECT_EQ(status(1).state, TaskState::kRunning) << "nobody here can tell";
}

TEST_F(SweepStatusTest, AsJson_HasEveryTask) {
  write_failure(task(4), {6, "the disk is full"});
  const auto json = nlohmann::json::parse(make_status_json(read_status(out())));
  EXPECT_EQ(json.at("cells"), 8);
  EXPECT_EQ(json.at("measured"), 0);
  ASSERT_EQ(json.at("tasks").size(), 4u);
  EXPECT_EQ(json.at("tasks")[3].at("state"), "failed");
  EXPECT_EQ(json.at("tasks")[3].at("message"), "exit code 6: the disk is full");
  EXPECT_EQ(json.at("truths")[0].at("state"), "waiting");
}

TEST_F(SweepStatusTest, OfDamagedFiles_IsRefused) {
  write_text_file(task(1) / "task.json", "{");
  EXPECT_THROW(read_status(out()), Error);
  write_text_file(out() / "tasks.json", R"({"schema_version": 1, "cells": "many"})");
  EXPECT_THROW(read_sweep(out()), Error);
  write_text_file(out() / "tasks.json", R"({"schema_version": 99})");
  EXPECT_THROW(read_sweep(out()), Error);
  EXPECT_THROW(read_sweep(out() / "tasks"), Error);
}

/// Engines' programs are given the names: scancel ends all of a user's jobs for one of these.
TEST_F(SweepStatusTest, OfJobsThatAreNoNumbers_IsRefused) {
  Sweep sweep = read_sweep(out());
  for (const std::string job : {"", "12", "12;cluster", "12@machine"}) {
    sweep.jobs = {{"slurm", job, job, job}};
    write_sweep(out(), sweep);
    EXPECT_EQ(read_sweep(out()).jobs.at(0).merge, job);
  }
  const auto expect_refused = [&](const SubmittedJobs& jobs, const std::string& job) {
    sweep.jobs.back() = jobs;
    write_sweep(out(), sweep);
    try {
      read_sweep(out());
      ADD_FAILURE() << job;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      EXPECT_THAT(error.message(), HasSubstr("a job '" + job + "', which is no number"));
    }
  };
  for (const std::string job : {"--me", "1 --me", "-1", ";cluster", "@machine", "12x;cluster", "../1", "all"}) {
    expect_refused({"slurm", job, "", ""}, job);
    expect_refused({"slurm", "", job, ""}, job);
    expect_refused({"slurm", "", "", job}, job);
  }
}

/// Where two processes do one task, the first to end takes the file of the other away.
TEST_F(SweepStatusTest, SignOfLife_ComesAgain) {
  using std::chrono::milliseconds;
  const SignOfLife alive(task(1), milliseconds(20));
  const auto comes_back = [&] {
    for (int tries = 0; tries < 500 && status(1).state != TaskState::kRunning; ++tries)
      std::this_thread::sleep_for(milliseconds(10));
    return status(1).state == TaskState::kRunning;
  };
  std::filesystem::last_write_time(task(1) / "alive", file_system_now(out()) - std::chrono::hours(1));
  EXPECT_TRUE(comes_back());
  remove_sign_of_life(task(1));
  EXPECT_TRUE(comes_back());
}

/// A job that never came as far as its task: no program there, no folder.
TEST_F(SweepStatusTest, OfAJobThatPrintedAndEnded_IsLost) {
  write_text_file(task(1) / "log.txt", "sh: 1: shadowbench: not found\n");
  EXPECT_EQ(status(1).state, TaskState::kRunning) << "it may yet begin";
  EXPECT_THAT(status(1).message, HasSubstr("shown itself"));
  EXPECT_FALSE(status(1).is_alive) << "a queue knows more of it";
  const auto now = file_system_now(out());
  std::filesystem::last_write_time(task(1) / "log.txt", now - std::chrono::seconds(100));
  EXPECT_EQ(status(1).state, TaskState::kLost);
  EXPECT_THAT(status(1).message, HasSubstr("log.txt"));
  write_text_file(out() / "submit.sbatch", "#!/bin/sh\n");
  EXPECT_EQ(status(1).state, TaskState::kWaiting) << "what it printed is of an earlier submission";
}

TEST_F(SweepStatusTest, SignOfLife_GoesWithItsTask_AndLeavesNothing) {
  {
    const SignOfLife alive(task(1));
    EXPECT_TRUE(read_last_sign(task(1), file_system_now(out())));
  }
  EXPECT_FALSE(read_last_sign(task(1), file_system_now(out())));
  for (const auto& entry : std::filesystem::directory_iterator(out()))
    EXPECT_FALSE(is_temporary(entry.path())) << entry.path();
}

}  // namespace
}  // namespace shadowbench::submit
