#include "roadbed/tools/batch/batch_run.h"

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <set>
#include <sstream>
#include <utility>

#include "roadbed/map/files/in_threads.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/files/unpack.h"
#include "roadbed/tools/batch/job.h"
#include "roadbed/tools/batch/memory.h"

namespace roadbed::tools::inline batch {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse_jobs_file(const fs::path& file, const std::string& found,
                                   const std::string& remedy) {
  throw map::InputError({.file = file.string(),
                         .found = found,
                         .needed = "a file with a job a line",
                         .remedy = remedy});
}

/// Of a plain file line by line; a stream, or what is packed, is held whole.
std::unique_ptr<std::istream> open_jobs(const fs::path& file) {
  const std::string remedy = "check the path; roadbed jobs writes such files";
  std::error_code error;
  if (!map::is_stream(file)) {
    if (!fs::exists(file, error)) refuse_jobs_file(file, "no such file", remedy);
    if (!fs::is_regular_file(file, error)) refuse_jobs_file(file, "is no file or pipe", remedy);
  }
  const bool is_empty = fs::is_regular_file(file, error) && fs::file_size(file, error) == 0;
  if (!is_empty && (map::is_stream(file) || map::is_packed(map::stored_start(file, 4)))) {
    return std::make_unique<std::istringstream>(map::read_file(file));
  }
  auto stream = std::make_unique<std::ifstream>(file, std::ios::binary);
  if (!stream->is_open()) refuse_jobs_file(file, "cannot be read", remedy);
  return stream;
}

std::unique_ptr<JobRunner> make_runner(const BatchOptions& options,
                                       const std::shared_ptr<const Inputs>& inputs) {
  if (!options.isolates) return std::make_unique<ThreadRunner>(options.folder, inputs);
  JobLimits limits = options.limits;
  const auto processes = static_cast<std::uint64_t>(options.threads);
  limits.process_memory =
      fmt::format("{}B", std::max<std::uint64_t>(1, options.memory_bytes / processes));
  return std::make_unique<ProcessRunner>(options.folder, std::move(limits));
}

std::string too_long(const JobLines::Line& line) {
  return fmt::format("job: is longer than {} bytes", line.text.size());
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::atomic<bool> stop_is_asked = false;  // a handler of signals has no other place
static_assert(std::atomic<bool>::is_always_lock_free);

void ask(int) {
  stop_is_asked = true;
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

}  // namespace

std::size_t count_jobs(const fs::path& jobs_file) {
  const auto stream = open_jobs(jobs_file);
  JobLines lines(*stream);
  std::size_t count = 0;
  while (lines.next()) ++count;
  return count;
}

void list_missing(const BatchOptions& options, const JobKinds& kinds, const ResultStore& store,
                  std::ostream& out) {
  const auto stream = open_jobs(options.jobs_file);
  JobLines lines(*stream);
  FileHashes files;
  std::set<JobHash> listed;
  while (const auto line = lines.next()) {
    try {
      const Job job = parse_job(line->text, kinds);
      const std::string hash = hash_of(job, files);
      const JobHash key = *parse_hash(hash);
      if (store.stands(key, &job) || !listed.insert(key).second) continue;
      fmt::print(out, "{}\t{}\n", hash, line->text);
    } catch (const map::InputError&) {
      continue;  // the batch itself says what is wrong with it
    }
  }
}

BatchRun::BatchRun(const BatchOptions& options, const JobKinds& kinds, ResultStore& store,
                   ProgressBar& progress)
    : options_(options),
      store_(store),
      progress_(progress),
      kinds_(kinds),
      files_(StopSignal::is_asked),
      inputs_(std::make_shared<const InputCache>(files_, options.memory_bytes / 2,
                                                 [this] { return resident(); })),
      timings_(options.folder / "timings.jsonl"),
      stream_(open_jobs(options.jobs_file)),
      lines_(*stream_),
      gate_(options.memory_bytes, [this] { return least_resident(); }) {
  for (int i = 0; i < options.threads; ++i) runners_.push_back(make_runner(options, inputs_));
}

void BatchRun::run() {
  map::in_threads(runners_.size(), options_.threads, [&](std::size_t i) { work(*runners_[i]); });
}

void BatchRun::work(JobRunner& runner) {
  try {
    while (const auto taken = take()) bring(*taken, runner);
  } catch (...) {
    stop_others();
    runner.finish();
    throw;
  }
  runner.finish();
}

std::optional<BatchRun::Taken> BatchRun::take() {
  const std::scoped_lock lock(mutex_);
  if (has_failed_ || StopSignal::is_asked()) return {};
  auto line = lines_.next();
  if (!line) {
    is_complete_ = true;
    return {};
  }
  order_.push_back({.line = line->number, .hash = {}});
  return Taken{order_.size() - 1, *std::move(line)};
}

void BatchRun::bring(const Taken& taken, JobRunner& runner) {
  const JobLines::Line& line = taken.line;
  const auto keep_bad = [&](const std::string& reason) {
    if (claim(taken.index, *parse_hash(hash_of_bad_line(line.text)), nullptr)) {
      store_.add(line_of_bad_line(line.text, reason));
      progress_.done_one();
    }
  };
  if (line.is_too_long) return keep_bad(too_long(line));
  std::optional<Job> job;
  std::string hash;
  try {
    job = parse_job(line.text, kinds_);
    hash = hash_of(*job, files_);
  } catch (const map::InputError& error) {
    return keep_bad(error.what());
  }
  if (StopSignal::is_asked()) {  // perhaps before all was read
    const std::scoped_lock lock(mutex_);
    is_complete_ = false;
    return;
  }
  if (!claim(taken.index, *parse_hash(hash), &*job)) return;
  if (options_.merges) {
    const std::scoped_lock lock(mutex_);
    ++missing_;
    return;
  }
  run_job_of(line, *job, hash, runner);
  progress_.done_one();
}

// Whether the job of this hash is to be run now.
bool BatchRun::claim(std::size_t index, const JobHash& hash, const Job* job) {
  {
    const std::scoped_lock lock(mutex_);
    order_[index].hash = hash;
    const auto [found, is_first] = were_there_by_hash_.try_emplace(hash, false);
    if (!is_first) {
      if (found->second) ++were_there_;
      progress_.skip_one();
      return false;
    }
  }
  const bool stands = store_.stands(hash, job, options_.merges);  // reads files: not under the lock
  const std::scoped_lock lock(mutex_);
  were_there_by_hash_[hash] = stands;
  if (!stands) return true;
  ++were_there_;
  progress_.skip_one();
  return false;
}

void BatchRun::run_job_of(const JobLines::Line& line, const Job& job, const std::string& hash,
                          JobRunner& runner) {
  const MemoryGate::Pass pass(gate_);
  const auto start = std::chrono::steady_clock::now();
  std::string result = runner.run(job, hash, line.text);
  const double wall_s = seconds_since(start);
  if (hash_of(job, files_) != hash) {
    remove_files_of(hash, options_.folder);
    result = line_of(job, failure(hash, Cause::changed, {}, "an input changed while the job ran"));
  }
  if (!read_head(result)) {
    remove_files_of(hash, options_.folder);
    result = line_of(job, failure(hash, Cause::internal, {}, "what it printed is no JSON"));
  }
  store_.add(result);
  keep_time(job, hash, wall_s);
}

void BatchRun::keep_time(const Job& job, const std::string& hash, double wall_s) {
  const std::scoped_lock lock(mutex_);
  timings_.append(
      fmt::format(R"({{"hash":"{}","job":"{}","wall_s":{:.6f}}})", hash, job.kind->name, wall_s));
}

std::uint64_t BatchRun::resident() const {
  std::uint64_t bytes = memory_of_process(::getpid()).resident;
  for (const auto& runner : runners_) {
    if (const pid_t process = runner->process(); process != 0) {
      bytes += memory_of_process(process).resident;
    }
  }
  return bytes;
}

// What waits for memory first takes that of inputs that no job has in use.
std::uint64_t BatchRun::least_resident() const {
  inputs_->shrink(options_.memory_bytes);
  return resident();
}

void BatchRun::stop_others() {
  const std::scoped_lock lock(mutex_);
  is_complete_ = false;
  has_failed_ = true;
}

StopSignal::StopSignal() {
  stop_is_asked = false;
  struct sigaction stop {};
  stop.sa_handler = ask;
  ::sigaction(SIGINT, &stop, &interrupt_);
  ::sigaction(SIGTERM, &stop, &terminate_);
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  ::sigaction(SIGPIPE, &ignore, &pipe_);
  ::sigaction(SIGXFSZ, &ignore, &file_size_);
}

StopSignal::~StopSignal() {
  ::sigaction(SIGINT, &interrupt_, nullptr);
  ::sigaction(SIGTERM, &terminate_, nullptr);
  ::sigaction(SIGPIPE, &pipe_, nullptr);
  ::sigaction(SIGXFSZ, &file_size_, nullptr);
}

bool StopSignal::is_asked() { return stop_is_asked; }

}  // namespace roadbed::tools::batch
