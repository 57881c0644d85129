#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <charconv>
#include <deque>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/input_error.h"
#include "roadbed/map/read_file.h"
#include "roadbed/tools/batch/counted.h"
#include "roadbed/tools/batch/file_patterns.h"
#include "roadbed/tools/batch/job.h"
#include "roadbed/tools/command.h"
#include "roadbed/tools/support/od_csv.h"
#include "roadbed/tools/support/output_file.h"

namespace roadbed::tools {
namespace {

using Json = nlohmann::ordered_json;

[[noreturn]] void refuse_jobs(const std::string& file, const std::string& found,
                              const std::string& remedy) {
  throw map::InputError(
      {.file = file, .place = {}, .element = {}, .found = found, .needed = {}, .remedy = remedy});
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
                        last.ptr == end && from <= to && to - from < 1'000'000'000;
  return is_range ? std::optional(std::pair(from, to)) : std::nullopt;
}

std::vector<Json> values_of(const ArgumentInfo& option, const std::vector<std::string>& texts) {
  std::vector<Json> values;
  for (const std::string& text : texts) {
    if (option.use == ArgumentInfo::Use::input) {
      std::ranges::move(matching(text), std::back_inserter(values));
    } else if (const auto range = parse_range(text)) {
      for (long number = range->first; number <= range->second; ++number) values.push_back(number);
    } else {
      values.push_back(text);
    }
  }
  return values;
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
      part_.add("--pairs", pairs_, "CSV with the columns from and to: a job for each row").reads();
    }
    part_.add("-o,--output", file_, "File of jobs to write (.jsonl)").required().writes(".jsonl");
    part_.flag("--force", force_, "Replace the file if it exists");
    part_.example(fmt::format("  roadbed jobs {} {}", kind.name, example_of(kind.name)));
  }

  bool given() const { return part_.given(); }
  const std::filesystem::path& file() const { return file_; }
  bool force() const { return force_; }

  /// The product of all lists, the first of which changes slowest.
  std::vector<Json> jobs() const {
    std::vector<Json> jobs{Json{{"job", kind_.name}}};
    if (!inputs_.empty()) multiply(jobs, values_of(kind_.positional(), inputs_), to_input);
    for (const auto& [argument, values] : lists_) {
      const auto put = [name = argument->name](Json& job, const Json& value) {
        job["options"][name] = value;
      };
      if (!values.empty()) multiply(jobs, values_of(*argument, values), put);
    }
    if (!pairs_.empty()) multiply(jobs, pairs(), to_places);
    for (Json& job : jobs) finish(job);
    return jobs;
  }

 private:
  static std::string example_of(const std::string& kind) {
    if (kind == "import") return "'maps/**/*.xodr' -o jobs.jsonl";
    if (kind == "validate") return "'maps/*.xodr' --outputs sarif -o jobs.jsonl";
    if (kind == "route") return "town.rbm --pairs pairs.csv -o jobs.jsonl";
    if (kind == "simulate") return "'scenarios/**/*.xml' -o jobs.jsonl";
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

  template <typename Put>
  static void multiply(std::vector<Json>& jobs, const std::vector<Json>& values, const Put& put) {
    std::vector<Json> product;
    for (const Json& job : jobs) {
      for (const Json& value : values) {
        product.push_back(job);
        put(product.back(), value);
      }
    }
    jobs = std::move(product);
  }

  std::vector<Json> pairs() const {
    std::vector<Json> pairs;
    for (const OdRow& row : parse_od_csv(map::read_file(pairs_), pairs_.string())) {
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
    check_writable(options.file(), options.force());
    const std::vector<Json> jobs = options.jobs();
    std::string lines;
    for (const Json& job : jobs) {
      const std::string line = job.dump(-1, ' ', false, Json::error_handler_t::replace);
      parse_job(line, kinds_);
      lines += line + "\n";
    }
    write_output(options.file(), lines);
    if (!common.quiet) {
      fmt::print(streams.err, "{}: {} jobs\n", options.file().string(), with_commas(jobs.size()));
    }
    return Exit::ok;
  }

 private:
  JobKinds kinds_;
  std::deque<KindOptions> options_;
};

}  // namespace

std::unique_ptr<Command> make_jobs_command() { return std::make_unique<JobsCommand>(); }

}  // namespace roadbed::tools
