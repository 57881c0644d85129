// What a batch costs beside the jobs themselves, what shared inputs save, and how busy two threads
// are.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tools/batch/batch_results.h"
#include "roadbed/tools/batch/batch_run.h"
#include "roadbed/tools/batch/input_cache.h"
#include "roadbed/tools/batch/job.h"
#include "roadbed/tools/commands/commands.h"

namespace {

using namespace roadbed;
using Lines = std::vector<std::string>;

constexpr std::uint64_t kMemory = 8'000'000'000;

double seconds_on(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double cpu_s() { return seconds_on(CLOCK_PROCESS_CPUTIME_ID); }
double wall_s() { return seconds_on(CLOCK_MONOTONIC); }

/// A wall of 100 m by 3 m beside a street, as an octree.
std::string make_wall(const tests::TemporaryFolder& folder) {
  std::string cloud;
  for (int i = 0; i < 1000; ++i) {
    for (int k = 0; k < 30; ++k) {
      cloud += fmt::format("{:.2f} 201.05 {:.2f}\n", 100.05 + 0.1 * i, 0.05 + 0.1 * k);
    }
  }
  const std::string cells = (folder / "wall.bt").string();
  tests::run_roadbed(
      {"occupancy", "build", folder.write("wall.xyz", cloud), "-o", cells, "--resolution", "0.1"});
  return cells;
}

/// A drive of 1 s past it.
std::string make_drive(const tests::TemporaryFolder& folder, int index) {
  std::string csv =
      "t_s,x_m,y_m,heading_rad,speed_mps,acceleration_mps2,steering_rad,curvature_per_m\n";
  for (int i = 0; i <= 10; ++i) {
    csv += fmt::format("{},{},{},0,10,0,0,0\n", 0.1 * i, 150.0 + i, 198.0 + 1e-4 * index);
  }
  return folder.write(fmt::format("drive_{}.csv", index), csv);
}

Lines audits(const tests::TemporaryFolder& folder, int count) {
  const std::string cells = make_wall(folder);
  Lines lines;
  for (int i = 0; i < count; ++i) {
    lines.push_back(fmt::format(
        R"({{"job":"audit","options":{{"occupancy":"{}","trajectory":"{}","unknown":"free"}}}})",
        cells, make_drive(folder, i)));
  }
  return lines;
}

Lines routes(int count) {
  const std::string map = (tests::data_folder() / "town.xodr").string();
  Lines lines;
  for (int i = 0; i < count; ++i) {
    lines.push_back(fmt::format(
        R"({{"job":"route","inputs":["{}"],"options":{{"from":"lane:1/0/-1@{}","to":"lane:7/0/1@55"}}}})",
        map, 1.0 + 13.0 * i / count));
  }
  return lines;
}

/// Drives of 2 s in the town, each by a seed of its own.
Lines drives(const tests::TemporaryFolder& folder, int count) {
  const std::string scenario = folder.write(
      "scenario.json",
      fmt::format(
          R"({{"roadbed_scenario":1,"map":"{}","ego":{{"start":"lane:1/3/1@6","speed_mps":8}},)"
          R"("goal":"lane:1/3/1@45","duration_s":2,"noise":{{"position_m":0.02}}}})",
          (tests::data_folder() / "town.xodr").string()));
  Lines lines;
  for (int i = 0; i < count; ++i) {
    lines.push_back(fmt::format(
        R"({{"job":"simulate","inputs":["{}"],"options":{{"seed":{}}},"outputs":["output"]}})",
        scenario, i));
  }
  return lines;
}

/// CPU time of the commands alone, one after the other, for each job [s].
double alone_s(const Lines& lines, const std::shared_ptr<const tools::Inputs>& inputs) {
  const tools::JobKinds& kinds = tools::job_kinds();
  const double start = cpu_s();
  for (const std::string& line : lines) {
    const tools::Job job = tools::parse_job(line, kinds);
    Lines words = tools::words_of_options(job);
    words.insert(words.end(), {"--json", "--"});
    words.insert(words.end(), job.inputs.begin(), job.inputs.end());
    tools::ArgumentSet set;
    const auto command = job.kind->make();
    command->declare(set.arguments());
    set.parse(words);
    std::ostringstream out, err;
    command->run({out, err}, {.quiet = true, .threads = 1, .is_alone = false, .inputs = inputs});
  }
  return (cpu_s() - start) / static_cast<double>(lines.size());
}

void run_batch(const Lines& lines, int threads) {
  const tests::TemporaryFolder folder;
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  const std::string jobs = folder.write("jobs.jsonl", text);
  std::filesystem::create_directory(folder / "out");
  tools::ResultStore store(folder / "out");
  std::ostringstream err;
  tools::ProgressBar progress(0, false);
  const tools::BatchOptions options{.jobs_file = jobs,
                                    .folder = folder / "out",
                                    .threads = threads,
                                    .memory_bytes = kMemory,
                                    .limits = {}};
  tools::BatchRun run(options, tools::job_kinds(), store, progress);
  run.run();
  tools::write_results(store, run.order(), options.folder);
}

double batch_s(const Lines& lines) {
  const double start = cpu_s();
  run_batch(lines, 1);
  return (cpu_s() - start) / static_cast<double>(lines.size());
}

/// A command that loads its inputs is measured on the first few only.
void compare(const char* name, const Lines& lines) {
  const std::size_t sample = std::min<std::size_t>(lines.size(), 200);
  const Lines few(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(sample));
  double loading = 1e9, sharing = 1e9, batch = 1e9;
  for (int turn = 0; turn < 3; ++turn) {
    tools::FileHashes hashes;
    const auto cache =
        std::make_shared<const tools::InputCache>(hashes, kMemory, [] { return std::uint64_t{0}; });
    loading = std::min(loading, alone_s(few, std::make_shared<const tools::Inputs>()));
    sharing = std::min(sharing, alone_s(lines, cache));
    batch = std::min(batch, batch_s(lines));
  }
  fmt::print(
      "{} {}: each loading its inputs {:.3f} ms, sharing them {:.3f} ms, in a batch {:.3f} ms: "
      "{:.3f} ms beside the job\n",
      lines.size(), name, 1e3 * loading, 1e3 * sharing, 1e3 * batch, 1e3 * (batch - sharing));
}

/// What threads of this process have had of the cores, as the scheduler counts it: on one, and
/// waiting for one. A thread that has ended keeps what it had when last looked at.
class ThreadTimes {
 public:
  struct Times {
    double on_core_s = 0.0, waiting_s = 0.0, first_s = 0.0, last_s = 0.0;
  };

  void look() {
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
      std::ifstream file(task.path() / "schedstat");
      double on_core_ns = 0.0, waiting_ns = 0.0;
      if (!(file >> on_core_ns >> waiting_ns)) continue;
      const double now_s = wall_s();
      Times& times =
          by_id_.try_emplace(task.path().filename(), Times{.first_s = now_s}).first->second;
      times.on_core_s = 1e-9 * on_core_ns;
      times.waiting_s = 1e-9 * waiting_ns;
      times.last_s = now_s;
    }
  }

  const std::map<std::string, Times>& by_id() const { return by_id_; }

 private:
  std::map<std::string, Times> by_id_;
};

void print_threads(const ThreadTimes& all, const ThreadTimes& before) {
  for (const auto& [id, times] : all.by_id()) {
    if (before.by_id().contains(id)) continue;  // this one, and that which looks
    const double there_s = times.last_s - times.first_s;
    const double idle_s = std::max(0.0, there_s - times.on_core_s - times.waiting_s);
    fmt::print("  thread: {:.1f} s, on a core {:.1f} %, waiting for one {:.1f} %, idle {:.1f} %\n",
               there_s, 100.0 * times.on_core_s / there_s, 100.0 * times.waiting_s / there_s,
               100.0 * idle_s / there_s);
  }
}

/// Two threads: how busy they keep two cores.
void measure_busy(const char* name, const Lines& lines) {
  ThreadTimes before, all;
  double wall = 0.0, cpu = 0.0;
  {
    std::jthread looking([&](const std::stop_token& stop) {
      before.look();
      while (!stop.stop_requested()) {
        all.look();
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
      }
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const double start_wall = wall_s(), start_cpu = cpu_s();
    std::jthread([&] { run_batch(lines, 2); }).join();  // this thread has worked before
    wall = wall_s() - start_wall;
    cpu = cpu_s() - start_cpu;
  }
  fmt::print(
      "{} {}, two threads: {:.1f} s of wall clock, {:.1f} s of CPU time, {:.1f} % of two cores\n",
      lines.size(), name, wall, cpu, 100.0 * cpu / (2.0 * wall));
  print_threads(all, before);
}

}  // namespace

int main(int argc, char** argv) {
  int count = 1000;
  CLI::App app{
      "Times batches of JOBS audits of one occupancy, ten times as many routes on one map and "
      "three "
      "tenths as many drives of one scenario by seed. CPU time of this process."};
  app.add_option("JOBS", count)->capture_default_str()->check(CLI::Range(10, 1'000'000));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);  // each line when it is there
  const tests::TemporaryFolder folder;
  const Lines of_audits = audits(folder, count), of_drives = drives(folder, count * 3 / 10);
  compare("audits of one occupancy", of_audits);
  compare("routes on one map", routes(10 * count));
  measure_busy("audits", of_audits);
  measure_busy("drives", of_drives);
}
