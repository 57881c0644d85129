#include <fmt/format.h>
#include <fmt/ostream.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/storage/output_folder.h"
#include "roadbed/tools/batch/batch_results.h"
#include "roadbed/tools/batch/batch_run.h"
#include "roadbed/tools/batch/folder_lock.h"
#include "roadbed/tools/batch/memory.h"
#include "roadbed/tools/batch/serve_process.h"
#include "roadbed/tools/commands/commands.h"

namespace roadbed::tools::inline commands {
namespace {

std::string counted(std::size_t count, const char* thing) {
  return with_commas(count) + " " + thing + (count == 1 ? "" : "s");
}

std::string memory_fault(const std::string& text) {
  return parse_memory_size(text) ? "" : "is no size such as 4GB or 512MB";
}

std::uint64_t default_memory() {
  constexpr double fraction = 0.8;
  const double pages = static_cast<double>(::sysconf(_SC_PHYS_PAGES));
  return static_cast<std::uint64_t>(fraction * pages *
                                    static_cast<double>(::sysconf(_SC_PAGESIZE)));
}

// There may be one such process for each core.
std::uint64_t default_memory_of_server() {
  const auto cores = static_cast<std::uint64_t>(std::max(1L, ::sysconf(_SC_NPROCESSORS_ONLN)));
  return default_memory() / cores;
}

class BatchCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Run many jobs, one a line of JSON, and keep what became of each");
    arguments.add("JOBS", jobs_file_, "File of jobs (.jsonl), as roadbed jobs writes them")
        .reads()
        .ending(".jsonl");
    arguments
        .add("-o,--output", folder_,
             "Folder for results.jsonl, summary.json, index.html and the files of jobs; run again, "
             "only what is missing or changed is done")
        .required()
        .writes("/");
    arguments
        .add("--memory", memory_,
             "No job starts while the resident memory of the batch is above this and another one "
             "runs, such as 4GB; maps and occupancies stay loaded in half of it; default: 80 % of "
             "the machine's, with --serve a core's part of that")
        .checked(memory_fault);
    arguments.flag("--isolate", isolates_,
                   "Run jobs in processes of their own: one that crashes is one that failed");
    arguments
        .add("--time-limit", time_limit_s_,
             "Wall clock that a job may take, with --isolate [s]; what takes longer has failed")
        .positive();
    arguments
        .add("--job-memory", job_memory_,
             "Memory that a job may take beyond that of the program, with --isolate, such as 2GB; "
             "what needs more has failed")
        .checked(memory_fault);
    arguments.flag("--merge", merges_,
                   "Run no job: write what the results of all come to, as others have run them");
    arguments.flag("--list-missing", lists_,
                   "Print hash and line of each job that has no result yet, and run none");
    arguments.flag("-j,--json", json_, "Print summary.json");
    arguments.flag("--serve", serves_,
                   "Take job lines from standard input instead, one after the other, and print the "
                   "line of each result at once");
    arguments.flag("-f,--force", force_, "Work in a folder that holds files and is no batch's");
    arguments.require([this] { return fault(); });
    arguments.says_no_if("a job says no, or has failed");
    arguments.example(
        "  roadbed batch jobs.jsonl -o results --threads 2\n"
        "  roadbed batch jobs.jsonl -o results --isolate --time-limit 60 --job-memory 2GB");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    // Some outputs name others: how the folder is called on the command line is not to matter.
    folder_ = std::filesystem::absolute(folder_).lexically_normal();
    if (serves_) {
      map::refuse_streams();
      return run_server(streams);
    }
    count_jobs(jobs_file_);  // nothing is made where there are none to read
    map::refuse_streams();   // of jobs; that of JOBS is kept
    refuse_own_file(folder_, jobs_file_);
    if (lists_) {
      list_missing(options(common), job_kinds(), ResultStore(folder_), streams.out);
      return Exit::ok;
    }
    make_folder();
    const FolderLock lock(folder_);
    return run_jobs(streams, common);
  }

 private:
  std::string fault() const {
    const bool runs_apart = isolates_ || time_limit_s_;
    if (serves_) {
      const bool is_alone = jobs_file_.empty() && !runs_apart && !merges_ && !lists_ && !json_;
      return is_alone ? "" : "--serve takes -o, --memory and --job-memory only";
    }
    const bool has_limits = runs_apart || !memory_.empty();
    if (jobs_file_.empty()) return "JOBS is required";
    if (lists_ && (has_limits || merges_ || json_)) return "--list-missing takes JOBS and -o only";
    if (merges_ && has_limits) return "--merge runs no job, so it takes no limits";
    if (!isolates_ && (time_limit_s_ || !job_memory_.empty())) {
      return "--time-limit and --job-memory need --isolate";
    }
    return "";
  }

  void make_folder() const { map::make_output_folder(folder_, force_ || is_of_batch(folder_)); }

  Exit run_server(const Streams& streams) const {
    make_folder();
    if (!job_memory_.empty()) limit_memory(*parse_memory_size(job_memory_));
    serve(std::cin, streams.out, job_kinds(),
          {.folder = folder_,
           .job_memory = job_memory_,
           .memory_bytes = memory_bytes(default_memory_of_server())});
    return Exit::ok;
  }

  std::uint64_t memory_bytes(std::uint64_t otherwise) const {
    return memory_.empty() ? otherwise : *parse_memory_size(memory_);
  }

  BatchOptions options(const CommonOptions& common) const {
    return {.jobs_file = jobs_file_,
            .folder = folder_,
            .threads = std::max(1, common.threads),
            .memory_bytes = memory_bytes(default_memory()),
            .isolates = isolates_,
            .limits = {.time_s = time_limit_s_, .memory = job_memory_},
            .merges = merges_};
  }

  Exit run_jobs(const Streams& streams, const CommonOptions& common) const {
    const StopSignal stop;
    const BatchOptions how = options(common);
    UnfinishedMark mark(folder_);
    ResultStore store(folder_);
    ProgressBar progress(count_jobs(jobs_file_), !common.quiet && ::isatty(STDERR_FILENO) == 1);
    BatchRun run(how, job_kinds(), store, progress);
    run.run();
    if (!run.is_complete()) {
      say_why(streams.err, run, store);
      return Exit::unusable;
    }
    const BatchSummary summary = write_results(store, run.order(), folder_);
    mark.remove();
    report(streams.out, summary,
           merges_ ? fmt::format("merged from {}", counted(store.journals(), "journal"))
                   : fmt::format("{} were there already", with_commas(run.were_there())));
    if (!common.quiet) note_where(streams.err, summary);
    const bool is_all_done = summary.count(JobStatus::done) == summary.count();
    return is_all_done ? Exit::ok : Exit::no;
  }

  static void say_why(std::ostream& err, const BatchRun& run, const ResultStore& store) {
    if (run.missing() > 0) {
      fmt::print(err, "roadbed: {} jobs have no result; run without --merge\n",
                 with_commas(run.missing()));
      return;
    }
    fmt::print(err, "roadbed: stopped: {} jobs have their results; run again to go on\n",
               with_commas(store.size()));
  }

  void report(std::ostream& out, const BatchSummary& summary, const std::string& origin) const {
    if (json_) {
      out << summary.document(kMostInSummary);
      return;
    }
    fmt::print(out, "{}: {} done, {} no, {} failed; {}\n", counted(summary.count(), "job"),
               with_commas(summary.count(JobStatus::done)),
               with_commas(summary.count(JobStatus::no)),
               with_commas(summary.count(JobStatus::failed)), origin);
  }

  // All that went wrong is in the page; the first of it is worth a line here.
  void note_where(std::ostream& err, const BatchSummary& summary) const {
    std::optional<WorstCase> first;
    for (const auto& [name, kind] : summary.kinds()) {
      for (const WorstCase& job : kind.worst()) {
        if (job.status != JobStatus::failed) break;  // these come first
        if (!first || job.line < first->line) first = job;
      }
    }
    if (first) fmt::print(err, "note: line {} failed: {}\n", first->line, first->text);
    fmt::print(err, "wrote {}\n", (folder_ / "index.html").string());
  }

  std::filesystem::path jobs_file_, folder_;
  std::string memory_, job_memory_;
  std::optional<double> time_limit_s_;
  bool isolates_ = false, json_ = false, serves_ = false, merges_ = false, lists_ = false,
       force_ = false;
};

}  // namespace

const JobKinds& job_kinds() {
  static const JobKinds kinds({{"import", make_import_command},
                               {"validate", make_validate_command},
                               {"route", make_route_command},
                               {"simulate", make_simulate_command},
                               {"audit", make_audit_command}});
  return kinds;
}

std::unique_ptr<Command> make_batch_command() { return std::make_unique<BatchCommand>(); }

}  // namespace roadbed::tools::commands
