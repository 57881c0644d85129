#include "roadbed/tools/batch/run_job.h"

#include <new>
#include <nlohmann/json.hpp>
#include <sstream>
#include <system_error>

#include "roadbed/map/files/input_error.h"
#include "roadbed/tools/batch/compact_json.h"
#include "roadbed/tools/batch/job_files.h"
#include "roadbed/tools/batch/job_verdict.h"
#include "roadbed/tools/batch/result_head.h"
#include "roadbed/tools/files/output_file.h"

namespace roadbed::tools::inline batch {
namespace {

namespace fs = std::filesystem;

constexpr int kFailed = static_cast<int>(Exit::failed), kWrongUsage = static_cast<int>(Exit::usage);

std::vector<std::string> words_of(const Job& job, const std::vector<JobOutput>& outputs) {
  std::vector<std::string> words = words_of_options(job);
  for (const JobOutput& output : outputs) {
    words.push_back("--" + output.option + "=" + output.path.string());
  }
  for (const char* flag : {"json", "force"}) {
    if (job.kind->option(flag) != nullptr) words.push_back(std::string("--") + flag);
  }
  words.emplace_back("--");
  words.insert(words.end(), job.inputs.begin(), job.inputs.end());
  return words;
}

[[noreturn]] void refuse_folder(const fs::path& folder, const std::string& found) {
  throw OutputError({.file = folder.string(),
                     .place = {},
                     .element = {},
                     .found = found,
                     .needed = {},
                     .remedy = "free some space or choose another folder"});
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error && !fs::is_directory(folder)) {
    refuse_folder(folder, "cannot be made: " + error.message());
  }
}

// What a process that was killed left in a folder would be taken for the job's.
void remove_old(const std::vector<JobOutput>& outputs) {
  for (const JobOutput& output : outputs) {
    std::error_code error;
    fs::remove_all(output.path, error);
    if (error) refuse_folder(output.path, "cannot be removed: " + error.message());
  }
}

// Makes the job's command with its options. Returns what it says of them.
std::string parse_options(const Job& job, const std::vector<JobOutput>& outputs,
                          std::unique_ptr<Command>& command, ArgumentSet& set) {
  command = job.kind->make();
  command->declare(set.arguments());
  return set.parse(words_of(job, outputs));
}

/// Runs the command; what it throws goes on.
JobResult run_command(const Job& job, const std::string& hash, const fs::path& folder,
                      const std::shared_ptr<const Inputs>& inputs) {
  const std::vector<JobOutput> outputs = outputs_of(job, hash, folder);
  ArgumentSet set;
  std::unique_ptr<Command> command;
  if (const std::string fault = parse_options(job, outputs, command, set); !fault.empty()) {
    return failure(hash, Cause::line, kWrongUsage, fault);
  }
  if (!outputs.empty()) make_folder(folder_of_files(hash, folder));
  remove_old(outputs);
  std::ostringstream out, err;
  const Exit exit =
      command->run({out, err}, {.quiet = true, .threads = 1, .is_alone = false, .inputs = inputs});
  if (exit != Exit::ok && out.view().empty()) {
    return failure(hash, Cause::input, static_cast<int>(exit), err.str());
  }
  if (!nlohmann::json::accept(out.view())) {
    return failure(hash, Cause::internal, static_cast<int>(exit), "what it printed is no JSON");
  }
  JobResult result{.hash = hash,
                   .status = exit == Exit::ok ? JobStatus::done : JobStatus::no,
                   .exit = static_cast<int>(exit),
                   .document = compact_json(out.view()),
                   .files = files_of(outputs, folder)};
  if (exit != Exit::ok) {
    result.reason = verdict_of(job.kind->name, nlohmann::json::parse(result.document)).text;
  }
  return result;
}

JobResult run_guarded(const Job& job, const std::string& hash, const fs::path& folder,
                      const std::shared_ptr<const Inputs>& inputs) {
  try {
    return run_command(job, hash, folder, inputs);
  } catch (const OutputError& error) {
    return failure(hash, Cause::disk, kFailed, error.what());
  } catch (const map::InputError& error) {
    return failure(hash, Cause::input, kFailed, error.what());
  } catch (const std::bad_alloc&) {
    return failure(hash, Cause::memory, kFailed, "out of memory");
  } catch (const std::exception& error) {
    return failure(hash, Cause::internal, kFailed, std::string("internal error: ") + error.what());
  }
}

}  // namespace

std::string fault_of_options(const Job& job) {
  const std::string any_hash(kHashDigits, '0');
  ArgumentSet set;
  std::unique_ptr<Command> command;
  return parse_options(job, outputs_of(job, any_hash, "any"), command, set);
}

JobResult run_job(const Job& job, const std::string& hash, const fs::path& folder,
                  const std::shared_ptr<const Inputs>& inputs) {
  JobResult result = run_guarded(job, hash, folder, inputs);
  if (result.status == JobStatus::failed) remove_files_of(hash, folder);
  return result;
}

}  // namespace roadbed::tools
