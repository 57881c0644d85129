// bench_batch [JOBS]: what a batch costs beside the jobs themselves. The same small audits (default
// 1000) run once by the command alone, one after the other in this process, and once as a batch of
// one thread with its journal and its outputs; CPU time of this process, in turn, least of three.

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tools/batch/batch_results.h"
#include "roadbed/tools/batch/batch_run.h"
#include "roadbed/tools/batch/job.h"

namespace {

using namespace roadbed;

double cpu_s() {
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// A wall beside a street, as an octree.
std::string make_wall(const tests::TemporaryFolder& folder) {
  std::string cloud;
  for (int i = 0; i < 150; ++i) cloud += fmt::format("{} 201.0 0.7\n", 145.0 + 0.2 * i);
  const std::string cells = (folder / "wall.bt").string();
  tests::run_roadbed(
      {"occupancy", "build", folder.write("wall.xyz", cloud), "-o", cells, "--resolution", "0.2"});
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

std::vector<std::string> make_jobs(const tests::TemporaryFolder& folder, int count) {
  const std::string cells = make_wall(folder);
  std::vector<std::string> lines;
  for (int i = 0; i < count; ++i) {
    lines.push_back(fmt::format(
        R"({{"job":"audit","options":{{"occupancy":"{}","trajectory":"{}","unknown":"free"}}}})",
        cells, make_drive(folder, i)));
  }
  return lines;
}

double alone_s(const std::vector<std::string>& lines) {
  const tools::JobKinds kinds;
  const double start = cpu_s();
  for (const std::string& line : lines) {
    const tools::Job job = tools::parse_job(line, kinds);
    std::vector<std::string> words = tools::words_of_options(job);
    words.emplace_back("--json");
    tools::ArgumentSet set;
    const auto command = job.kind->make();
    command->declare(set.arguments());
    set.parse(words);
    std::ostringstream out, err;
    command->run({out, err}, {.quiet = true, .threads = 1, .is_alone = false});
  }
  return cpu_s() - start;
}

double batch_s(const std::string& jobs) {
  const tests::TemporaryFolder folder;
  const double start = cpu_s();
  tools::ResultStore store(folder.path());
  std::ostringstream err;
  tools::ProgressBar progress(err, 0, false);
  const tools::BatchOptions options{
      .jobs_file = jobs, .folder = folder.path(), .memory_bytes = 1'000'000'000, .limits = {}};
  tools::BatchRun run(options, store, progress);
  run.run();
  tools::write_results(store, run.order(), folder.path());
  return cpu_s() - start;
}

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::stoi(argv[1]) : 1000;
  const tests::TemporaryFolder folder;
  const std::vector<std::string> lines = make_jobs(folder, count);
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  const std::string jobs = folder.write("jobs.jsonl", text);
  double alone = 1e9, batch = 1e9;
  for (int turn = 0; turn < 3; ++turn) {
    alone = std::min(alone, alone_s(lines));
    batch = std::min(batch, batch_s(jobs));
  }
  const double to_ms = 1e3 / count;
  fmt::print("{} audits: alone {:.3f} ms each, in a batch {:.3f} ms, difference {:.3f} ms\n", count,
             alone * to_ms, batch * to_ms, (batch - alone) * to_ms);
}
