#include "roadbed/tools/batch/job_runner.h"

#include <fmt/format.h>

#include <new>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/tools/batch/job.h"
#include "roadbed/tools/batch/job_result.h"

namespace roadbed::tools::inline batch {
namespace {

namespace fs = std::filesystem;

/// Why a command that threw has no answer.
Cause cause_of(const std::exception& error) {
  if (dynamic_cast<const map::OutputError*>(&error) != nullptr) return Cause::disk;
  if (dynamic_cast<const map::InputError*>(&error) != nullptr) return Cause::input;
  return dynamic_cast<const std::bad_alloc*>(&error) != nullptr ? Cause::memory : Cause::internal;
}

// A JSON document without the blanks between its parts, so on one line; all else stays as it is
// written, numbers too.
std::string compact_json(std::string_view document) {
  std::string compact;
  compact.reserve(document.size());
  bool in_text = false;
  for (std::size_t i = 0; i < document.size(); ++i) {
    const char sign = document[i];
    const bool is_blank = sign == ' ' || sign == '\n' || sign == '\t' || sign == '\r';
    if (in_text || !is_blank) compact += sign;
    if (in_text && sign == '\\' && i + 1 < document.size()) {
      compact += document[++i];
    } else if (sign == '"') {
      in_text = !in_text;
    }
  }
  return compact;
}

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
  throw map::OutputError({.file = folder.string(),
                          .found = found,
                          .remedy = "free some space or choose another folder"});
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error && !map::is_folder(folder)) {
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
    return failure(hash, Cause::line, static_cast<int>(Exit::usage), fault);
  }
  if (!outputs.empty()) make_folder(folder_of_files(hash, folder));
  remove_old(outputs);
  std::ostringstream out, err;
  const Exit exit =
      command->run({out, err}, {.quiet = true, .threads = 1, .is_alone = false, .inputs = inputs});
  if (!nlohmann::json::accept(out.view())) {
    return failure(hash, Cause::internal, static_cast<int>(Exit::internal),
                   "what it printed is no JSON");
  }
  JobResult result{.hash = hash,
                   .status = exit == Exit::ok ? JobStatus::done : JobStatus::no,
                   .exit = static_cast<int>(exit),
                   .document = compact_json(out.view()),
                   .files = files_of(outputs, folder)};
  for (const std::string& file : result.files) {
    result.sha256.push_back(sha256_of_output(folder / file));
  }
  if (exit != Exit::ok) {
    result.reason = verdict_of(job.kind->name, nlohmann::json::parse(result.document)).text;
  }
  return result;
}

JobResult run_guarded(const Job& job, const std::string& hash, const fs::path& folder,
                      const std::shared_ptr<const Inputs>& inputs) {
  try {
    return run_command(job, hash, folder, inputs);
  } catch (const std::exception& error) {
    const Failure failed = failure_of(error);
    return failure(hash, cause_of(error), static_cast<int>(failed.exit), failed.text);
  }
}

}  // namespace

std::string ThreadRunner::run(const Job& job, const std::string& hash, const std::string&) {
  return line_of(job, run_job(job, hash, folder_, inputs_));
}

std::string ProcessRunner::run(const Job& job, const std::string& hash, const std::string& text) {
  const int answered_before = process_.process() == 0 ? 0 : process_.answered();
  const ServeProcess::Answer answer = process_.ask(hash + "\t" + text, limits_.time_s);
  const auto failed = [&](Cause cause, const std::string& reason) {
    remove_files_of(hash, folder_);
    return line_of(job, failure(hash, cause, {}, reason));
  };
  if (answer.is_late) {
    return failed(Cause::time, fmt::format("took longer than {} s", *limits_.time_s));
  }
  if (!answer.death.empty()) return failed(Cause::crash, answer.death);
  const auto head = read_head(answer.line);
  if (!head) return failed(Cause::internal, "its process answered with no result");
  if (text_of(head->hash) != hash) {
    return failed(Cause::internal, "its process answered with the result of another job");
  }
  if (head->cause != Cause::memory) return answer.line;
  process_.end();  // its heap may be in pieces
  // Memory that earlier jobs left to the process must not be counted as the job's.
  return answered_before > 0 ? run(job, hash, text) : answer.line;
}

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

}  // namespace roadbed::tools::batch
