#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/map/storage/output_place.h"
#include "roadbed/tools/batch/batch_summary.h"
#include "roadbed/tools/batch/file_patterns.h"
#include "roadbed/tools/batch/job.h"
#include "roadbed/tools/batch/job_runner.h"
#include "roadbed/tools/cli/output_format.h"
#include "roadbed/tools/commands/commands.h"
#include "roadbed/tools/files/json.h"
#include "roadbed/tools/files/points_csv.h"
#include "roadbed/tools/files/streamed_output.h"
#include "roadbed/tools/files/vehicle_file.h"

namespace roadbed::tools::inline commands {
namespace {

[[noreturn]] void refuse_jobs(const std::string& file, const std::string& found,
                              const std::string& remedy) {
  throw map::InputError(
      {.file = file, .place = {}, .element = {}, .found = found, .needed = {}, .remedy = remedy});
}

constexpr std::size_t kMostJobs = 100'000'000, kMostValues = 10'000'000;

[[noreturn]] void refuse_number(const std::string& what, std::size_t most) {
  refuse_jobs(what, fmt::format("more than {}", with_commas(most)), "write several files of jobs");
}

std::string line_of_job(const Json& job) {
  try {
    return map::visible_text(job.dump());
  } catch (const Json::type_error&) {  // another name would not be found again
    refuse_jobs(map::json_text(job), "holds a text that is no UTF-8", "rename the file");
  }
}

// Of a product most faults are in the first ones; to try all would take longer than to write them.
constexpr std::size_t kTried = 1000;

void refuse_fault(const Job& job, const std::string& line) {
  if (const std::string fault = fault_of_options(job); !fault.empty()) {
    refuse_jobs(line, fault, fmt::format("see: roadbed {} --help", job.kind->name));
  }
}

std::vector<Json> matching(const std::string& pattern) {
  const std::vector<std::string> files = matching_files(pattern);
  if (files.empty()) refuse_jobs(pattern, "matches no file", "check the pattern, and quote it");
  return {files.begin(), files.end()};
}

// "1..10": whole numbers, both ends too; none for any other text.
std::optional<std::pair<long, long>> parse_range(const std::string& text) {
  const std::size_t dots = text.find("..");
  if (dots == std::string::npos) return {};
  const char *const middle = text.data() + dots, *const end = text.data() + text.size();
  long from = 0, to = 0;
  const auto first = std::from_chars(text.data(), middle, from);
  const auto last = std::from_chars(middle + 2, end, to);
  const bool is_range = first.ec == std::errc() && last.ec == std::errc() && first.ptr == middle &&
                        last.ptr == end && from <= to;
  return is_range ? std::optional(std::pair(from, to)) : std::nullopt;
}

void add_range(const std::pair<long, long>& range, std::vector<Json>& values) {
  const auto [from, to] = range;
  const auto steps = static_cast<std::uint64_t>(to) - static_cast<std::uint64_t>(from);
  if (steps >= kMostValues) refuse_number(fmt::format("{}..{}", from, to), kMostValues);
  for (std::uint64_t step = 0; step <= steps; ++step) {
    values.push_back(from + static_cast<long>(step));
  }
}

std::vector<Json> values_of(const ArgumentInfo& option, const std::vector<std::string>& texts) {
  std::vector<Json> values;
  for (const std::string& text : texts) {
    if (option.use == ArgumentInfo::Use::input && !is_vehicle_name(text)) {
      std::ranges::move(matching(text), std::back_inserter(values));
    } else if (const auto range = parse_range(text)) {
      add_range(*range, values);
    } else {
      values.push_back(text);
    }
  }
  return values;
}

/// One of the lists whose product the jobs are.
struct JobAxis {
  std::function<void(Json& job, const Json& value)> put;
  std::vector<Json> values;
};

/// @throws InputError if they are too many.
std::size_t product_size(const std::vector<JobAxis>& axes) {
  std::size_t count = 1;
  for (const JobAxis& axis : axes) {
    count *= axis.values.size();  // both are bounded
    if (count > kMostJobs || axis.values.size() > kMostValues) refuse_number("jobs", kMostJobs);
  }
  return count;
}

/// The options of `jobs KIND`: those of the command, each with any number of values.
class KindOptions {
 public:
  KindOptions(const JobKind& kind, Arguments part) : kind_(kind), part_(std::move(part)) {
    part_.description(fmt::format("Write jobs of roadbed {}", kind.name));
    for (const ArgumentInfo& argument : kind.arguments) declare(argument);
    part_.add("--outputs", outputs_, "Outputs of each job that the batch is to keep: a,b")
        .separated_by(',');
    if (kind.name == "route") {
      part_.add("--pairs", pairs_, "CSV with the columns from and to: a job for each row")
          .reads()
          .ending(".csv");
    }
    part_.add("-o,--output", file_, "File of jobs to write (.jsonl); - for standard output")
        .required()
        .writes(".jsonl");
    part_.flag("-f,--force", force_, "Replace the file if it exists");
    part_.example(fmt::format("  roadbed jobs {} {}", kind.name, example_of(kind.name)));
  }

  bool given() const { return part_.given(); }
  const std::filesystem::path& file() const { return file_; }
  bool force() const { return force_; }

  /// Gives the jobs one after the other: the product of all lists, the first of which changes
  /// slowest. Returns how many there are.
  /// @throws InputError before the first one, if they are too many.
  std::size_t for_each_job(const std::function<void(const Json& job)>& take) const {
    const std::vector<JobAxis> all = axes();
    const std::size_t count = product_size(all);
    refuse_inputs_as_output(all);
    for (std::size_t i = 0; i < count; ++i) take(job_at(all, i, count));
    return count;
  }

 private:
  void refuse_inputs_as_output(const std::vector<JobAxis>& axes) const {
    std::error_code error;
    if (!std::filesystem::exists(file_, error)) return;
    for (const JobAxis& axis : axes) {
      for (const Json& value : axis.values) {
        if (value.is_string()) map::refuse_input(file_, {value.get<std::string>()});
      }
    }
  }

  static std::string example_of(const std::string& kind) {
    if (kind == "import") return "'maps/**/*.xodr' -o jobs.jsonl";
    if (kind == "validate") return "'maps/*.xodr' --outputs sarif -o jobs.jsonl";
    if (kind == "route") return "town.rbm --pairs pairs.csv -o jobs.jsonl";
    if (kind == "simulate")
      return "'scenarios/**/*.json' --vehicle 'cars/*.json' --seed 0..99 -o jobs.jsonl";
    return "--occupancy city.bt --trajectory 'drives/*.csv' --inflate 0.1 0.2 -o jobs.jsonl";
  }

  static void to_input(Json& job, const Json& value) { job["inputs"] = Json::array({value}); }

  static void to_places(Json& job, const Json& pair) {
    job["options"]["from"] = pair.at(0);
    job["options"]["to"] = pair.at(1);
  }

  void declare(const ArgumentInfo& argument) {
    const std::string& name = argument.name;
    const bool is_own = name == "force" || name == "json";
    if (is_own || argument.use == ArgumentInfo::Use::output) return;
    if (argument.is_positional) {
      Argument inputs =
          part_.add(name, inputs_, "Files, or patterns such as 'maps/**/*.xodr': a job for each");
      if (argument.is_required) inputs.required();
    } else if (argument.kind == ArgumentInfo::Kind::flag) {
      flags_.emplace_back(&argument, false);
      part_.flag("--" + name, flags_.back().second, "As for the command");
    } else {
      lists_.emplace_back(&argument, std::vector<std::string>());
      part_.add("--" + name, lists_.back().second,
                argument.use == ArgumentInfo::Use::input
                    ? "Files or patterns; as for the command, a job for each"
                    : "As for the command; a job for each value, 1..10 are ten");
    }
  }

  std::vector<JobAxis> axes() const {
    std::vector<JobAxis> axes;
    if (!inputs_.empty()) axes.push_back({to_input, values_of(kind_.positional(), inputs_)});
    for (const auto& [argument, texts] : lists_) {
      const auto put = [name = argument->name](Json& job, const Json& value) {
        job["options"][name] = value;
      };
      if (!texts.empty()) axes.push_back({put, values_of(*argument, texts)});
    }
    if (!pairs_.empty()) axes.push_back({to_places, pairs()});
    return axes;
  }

  Json job_at(const std::vector<JobAxis>& axes, std::size_t index, std::size_t count) const {
    Json job{{"job", kind_.name}};
    for (const JobAxis& axis : axes) {
      count /= axis.values.size();
      axis.put(job, axis.values[index / count]);
      index %= count;
    }
    finish(job);
    return job;
  }

  std::vector<Json> pairs() const {
    std::vector<Json> pairs;
    for (const OdRow& row : parse_od_csv(map::read_file(pairs_, map::most_unpacked_of_rows),
                                         map::input_name(pairs_))) {
      if (!row.fault.empty()) {
        refuse_jobs(fmt::format("{}:{}", pairs_.string(), row.line), row.fault, "mend the row");
      }
      pairs.push_back(Json::array({row.from, row.to}));
    }
    return pairs;
  }

  void finish(Json& job) const {
    for (const auto& [argument, is_set] : flags_) {
      if (is_set) job["options"][argument->name] = true;
    }
    if (!outputs_.empty()) job["outputs"] = outputs_;
  }

  const JobKind& kind_;
  Arguments part_;
  std::vector<std::string> inputs_, outputs_;
  std::deque<std::pair<const ArgumentInfo*, std::vector<std::string>>> lists_;
  std::deque<std::pair<const ArgumentInfo*, bool>> flags_;  // deques: their elements stay
  std::filesystem::path pairs_, file_;
  bool force_ = false;
};

class JobsCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Write a file of jobs for roadbed batch, from files, patterns and lists");
    for (const JobKind& kind : kinds_.all()) {
      options_.emplace_back(kind, arguments.part(kind.name));
    }
    arguments.example("  roadbed jobs import 'maps/**/*.xodr' -o jobs.jsonl");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    const KindOptions& options = *std::ranges::find_if(options_, &KindOptions::given);
    map::check_writable(options.file(), options.force());
    BufferedOutput lines(options.file(), options.force());
    std::size_t written = 0;
    const std::size_t count = options.for_each_job([&](const Json& job) {
      const std::string line = line_of_job(job);
      const Job parsed = parse_job(line, kinds_);
      if (++written <= kTried) refuse_fault(parsed, line);
      lines.add(line + "\n");
    });
    lines.commit();
    if (!common.quiet) {
      fmt::print(streams.err, "{}: {} {}\n", output_name(options.file()), with_commas(count),
                 count == 1 ? "job" : "jobs");
    }
    return Exit::ok;
  }

 private:
  const JobKinds& kinds_ = job_kinds();
  std::deque<KindOptions> options_;
};

}  // namespace

std::unique_ptr<Command> make_jobs_command() { return std::make_unique<JobsCommand>(); }

}  // namespace roadbed::tools::commands
