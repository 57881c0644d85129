#pragma once

// Jobs on the project's own town, and runs of `batch` as a user starts them.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tests {

using nlohmann::json;

inline const std::string kTownOfBatch = (data_folder() / "town.xodr").string();

/// A straight drive of 1 s, so far to the side of one through the town's street.
inline std::string drive_csv(double aside_m) {
  std::ostringstream csv;
  csv << "t_s,x_m,y_m,heading_rad,speed_mps,acceleration_mps2,steering_rad,curvature_per_m\n";
  for (int i = 0; i <= 10; ++i) {
    csv << 0.1 * i << ',' << 150.0 + i << ',' << 198.0 + aside_m << ",0,10,0,0,0\n";
  }
  return csv.str();
}

/// A wall of 1 m height beside the drives, made once for a folder.
inline std::string wall_in(const TemporaryFolder& inputs) {
  const std::string cells = (inputs / "wall.bt").string();
  if (std::filesystem::exists(cells)) return cells;
  std::string cloud;
  for (int i = 0; i < 150; ++i) {
    for (const char* height : {" 0.3\n", " 0.7\n", " 1.1\n"}) {
      cloud += std::to_string(145.0 + 0.2 * i) + " 201.0" + height;
    }
  }
  const ProgramRun run = run_roadbed(
      {"occupancy", "build", inputs.write("wall.xyz", cloud), "-o", cells, "--resolution", "0.1"});
  EXPECT_EQ(run.status, 0) << run.err;
  return cells;
}

inline json audit_job(const TemporaryFolder& inputs, const std::string& drive) {
  return {{"job", "audit"},
          {"options", {{"occupancy", wall_in(inputs)}, {"trajectory", drive}, {"unknown", "free"}}},
          {"outputs", {"certificate", "report"}}};
}

inline json route_job_of(const std::string& from, const std::string& to) {
  return {{"job", "route"}, {"inputs", {kTownOfBatch}}, {"options", {{"from", from}, {"to", to}}}};
}

inline std::string audit_jobs(const TemporaryFolder& inputs, int audits) {
  std::string lines;
  for (int i = 0; i < audits; ++i) {
    const std::string name = "drive_" + std::to_string(i) + ".csv";
    lines +=
        audit_job(inputs, inputs.write(name, drive_csv(0.7 * (i % 9) + 0.01 * i))).dump() + "\n";
  }
  return lines;
}

/// Jobs of every kind, some with an answer that is no, some that fail.
inline std::string jobs_of_all_kinds(const TemporaryFolder& inputs) {
  std::string lines = audit_jobs(inputs, 6);
  const auto add = [&](const json& job) { lines += job.dump() + "\n"; };
  add(route_job_of("lane:1/0/-1@10", "lane:7/0/1@55"));
  add({{"job", "import"}, {"inputs", {kTownOfBatch}}});
  add({{"job", "validate"}, {"inputs", {kTownOfBatch}}, {"outputs", {"sarif", "svg"}}});
  add({{"job", "simulate"}, {"inputs", {(data_folder() / "scenarios/cut_in.json").string()}}});
  add({{"job", "import"}, {"inputs", {(inputs / "missing.xodr").string()}}});
  add(route_job_of("lane:1/0/-1@10", "lane:7/0/1@55"));  // once more
  lines += "{\"job\":\"audit\"\n\n";
  return lines;
}

inline ProgramRun batch(const std::string& jobs, const std::filesystem::path& folder,
                        std::vector<std::string> more = {}) {
  std::vector<std::string> words{"batch", jobs, "-o", folder.string()};
  words.insert(words.end(), more.begin(), more.end());
  return run_roadbed(words);
}

/// The bytes of everything that is the same for every run of the same jobs.
inline std::map<std::string, std::string> outputs_of_batch(const std::filesystem::path& folder) {
  std::map<std::string, std::string> outputs;
  for (const std::string& file : files_below(folder)) {
    const bool is_of_run =
        file == "lock" || file == "timings.jsonl" || file.starts_with("journal/");
    if (!is_of_run) outputs[file] = bytes_of(folder / file);
  }
  return outputs;
}

inline std::vector<json> results_in(const std::filesystem::path& folder) {
  std::ifstream stream(folder / "results.jsonl");
  std::vector<json> results;
  for (std::string line; std::getline(stream, line);) results.push_back(json::parse(line));
  return results;
}

inline std::size_t lines_below(const std::filesystem::path& folder) {
  std::size_t count = 0;
  for (const std::string& file : files_below(folder)) {
    const std::string bytes = bytes_of(folder / file);
    count += static_cast<std::size_t>(std::ranges::count(bytes, '\n'));
  }
  return count;
}

/// The program, running beside the test.
class Running {
 public:
  explicit Running(std::vector<std::string> words, const std::string& err = "/dev/null") {
    words.insert(words.begin(), program_file().string());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT, 0600);
    EXPECT_EQ(::posix_spawn(&child_, argv[0], &actions, nullptr, argv.data(), environ), 0);
    posix_spawn_file_actions_destroy(&actions);
  }
  ~Running() {
    if (child_ != 0) end(SIGKILL);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  pid_t process() const { return child_; }

  bool is_running() {
    if (child_ != 0 && ::waitpid(child_, &status_, WNOHANG) == child_) child_ = 0;
    return child_ != 0;
  }

  void send(int signal) const { ::kill(child_, signal); }

  /// Sends the signal and waits for the end. Returns the exit status, 128 + signal if it was
  /// killed.
  int end(int signal) {
    if (child_ != 0) {
      send(signal);
      ::waitpid(child_, &status_, 0);
      child_ = 0;
    }
    return status();
  }

  int status() const { return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_); }

 private:
  pid_t child_ = 0;
  int status_ = 0;
};

inline void wait_a_moment() { std::this_thread::sleep_for(std::chrono::milliseconds(5)); }

/// Children of a process: those that its threads started.
inline std::vector<pid_t> children_of(pid_t process) {
  std::vector<pid_t> children;
  std::error_code error;
  const std::string tasks = "/proc/" + std::to_string(process) + "/task";
  for (const auto& task : std::filesystem::directory_iterator(tasks, error)) {
    std::ifstream list(task.path() / "children");
    for (pid_t child = 0; list >> child;) children.push_back(child);
  }
  return children;
}

}  // namespace roadbed::tests
