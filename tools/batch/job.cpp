#include "roadbed/tools/batch/job.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/files/sha256.h"
#include "roadbed/tools/cli/build_id.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline batch {
namespace {

using nlohmann::json;

// `rules` prints a table, whatever the job's inputs are.
constexpr std::array<std::string_view, 5> kOwnOptions{"force", "json", "quiet", "rules", "threads"};

std::string kind_names(const JobKinds& kinds) {
  std::string names;
  for (const JobKind& kind : kinds.all()) names += (names.empty() ? "" : ", ") + kind.name;
  return names;
}

std::vector<std::string> texts(const JsonNode& list) {
  std::vector<std::string> result;
  for (const JsonNode& element : list.elements()) result.push_back(element.text());
  return result;
}

// A job is known by what it reads, and the batch may be reading the stream itself.
void refuse_standard_input(const Job& job, const JsonNode& node) {
  for (const JobInput& input : inputs_of(job)) {
    if (map::is_standard_stream(input.path)) {
      node.refuse("reads standard input", "files, by whose bytes a job is known",
                  "write the input to a file");
    }
  }
}

bool is_scalar(const json& value) { return value.is_string() || value.is_number(); }

bool holds_zero_byte(const json& value) {
  if (value.is_array()) return std::ranges::any_of(value, holds_zero_byte);
  return value.is_string() && value.get_ref<const std::string&>().find('\0') != std::string::npos;
}

void check_value(const ArgumentInfo& argument, const JsonNode& node) {
  const json& value = node.value();
  if (argument.kind == ArgumentInfo::Kind::flag) {
    if (value.is_boolean()) return;
    node.refuse(fmt::format("is {}", value.type_name()), "true or false", "it is a flag");
  }
  const bool is_list = value.is_array() && !value.empty() && std::ranges::all_of(value, is_scalar);
  if (holds_zero_byte(value)) node.refuse("holds a zero byte", "a text", "take it out");
  if (is_scalar(value) || is_list) return;
  node.refuse(fmt::format("is {}", value.is_array() ? "an unusable list" : value.type_name()),
              "a text, a number, or a list of them", "write one");
}

const ArgumentInfo& known_option(const JobKind& kind, const std::string& name,
                                 const JsonNode& node) {
  if (std::ranges::find(kOwnOptions, name) != kOwnOptions.end()) {
    node.refuse("is set by the batch, or no option of a job", "", "leave it out");
  }
  const ArgumentInfo* option = kind.option(name);
  if (option == nullptr) {
    node.refuse(fmt::format("is no option of {}", kind.name), "",
                fmt::format("see: roadbed {} --help", kind.name));
  }
  if (option->use == ArgumentInfo::Use::output) {
    node.refuse("names an output, and the batch chooses where they go", "",
                "name it in \"outputs\"");
  }
  return *option;
}

json read_options(const JobKind& kind, const JsonNode& node) {
  json options = json::object();
  for (const auto& [name, value] : node.members()) {
    check_value(known_option(kind, name, value), value);
    if (value.value() != false) options[name] = value.value();
  }
  return options;
}

// "output.csv" asks for the option "output" with another suffix than its own.
std::string_view name_of_output(std::string_view asked) { return asked.substr(0, asked.find('.')); }

bool is_plain(std::string_view text) {
  return std::ranges::all_of(text, [](char sign) {
    return (sign >= 'a' && sign <= 'z') || (sign >= '0' && sign <= '9') || sign == '-' ||
           sign == '.';
  });
}

std::vector<std::string> read_outputs(const JobKind& kind, const JsonNode& node) {
  std::vector<std::string> outputs;
  for (const JsonNode& element : node.elements()) {
    const std::string asked = element.text();
    const ArgumentInfo* option = kind.option(name_of_output(asked));
    const bool is_output = option != nullptr && option->use == ArgumentInfo::Use::output;
    if (!is_output || option->suffix.empty() || !is_plain(asked)) {
      element.refuse(
          fmt::format("\"{}\" is no output of {} that a batch may ask for", asked, kind.name), "",
          fmt::format("see: roadbed {} --help", kind.name));
    }
    outputs.push_back(asked);
  }
  std::ranges::sort(outputs);
  const auto same = [](std::string_view a, std::string_view b) {
    return name_of_output(a) == name_of_output(b);
  };
  if (std::ranges::adjacent_find(outputs, same) != outputs.end()) {
    node.refuse("names an output twice", "", "name it once");
  }
  return outputs;
}

void add_word(const std::string& name, const json& value, std::vector<std::string>& words) {
  if (value.is_boolean()) {
    words.push_back("--" + name);
  } else {
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    words.push_back(fmt::format("--{}={}", name, text));
  }
}

void add_inputs(const json& value, const FilesNamed* named, std::vector<JobInput>& inputs) {
  if (value.is_string()) inputs.push_back({value.get<std::string>(), named});
  if (!value.is_array()) return;
  for (const json& element : value) add_inputs(element, named, inputs);
}

const std::string& program() {
  static const std::string text = version() + " " + build_id() + " " + libraries_id();
  return text;
}

void add_file(const std::filesystem::path& path, FileHashes& files, json& list) {
  list.push_back({path.generic_string(), files.of(path)});
}

}  // namespace

Job parse_job(std::string_view line, const JobKinds& kinds) {
  const json document = parse_json_strictly(line, "job");
  const JsonNode node(document, "job");
  node.check_version("job");
  node.require_object({"roadbed_job", "job", "inputs", "options", "outputs"});
  const JsonNode name = node.at("job");
  Job job{.kind = kinds.find(name.text()), .options = json::object()};
  if (job.kind == nullptr) {
    name.refuse(fmt::format("is {}", name.value().dump()), "one of " + kind_names(kinds),
                "correct it");
  }
  if (const auto inputs = node.find("inputs")) job.inputs = texts(*inputs);
  if (const auto options = node.find("options")) job.options = read_options(*job.kind, *options);
  if (const auto outputs = node.find("outputs")) job.outputs = read_outputs(*job.kind, *outputs);
  refuse_standard_input(job, node);
  return job;
}

std::vector<std::string> words_of_options(const Job& job) {
  std::vector<std::string> words;
  for (const auto& [name, value] : job.options.items()) {
    if (!value.is_array()) {
      add_word(name, value, words);
      continue;
    }
    for (const json& element : value) add_word(name, element, words);
  }
  return words;
}

std::vector<JobInput> inputs_of(const Job& job) {
  std::vector<JobInput> inputs;
  const ArgumentInfo& positional = job.kind->positional();
  for (const std::string& path : job.inputs) inputs.push_back({path, &positional.named});
  for (const auto& [name, value] : job.options.items()) {
    const ArgumentInfo& option = *job.kind->option(name);
    if (option.use == ArgumentInfo::Use::input) add_inputs(value, &option.named, inputs);
    if (!option.file_in || !value.is_string()) continue;
    const std::filesystem::path file = option.file_in(value.get<std::string>());
    if (!file.empty()) inputs.push_back({file.string(), &option.named});
  }
  return inputs;
}

std::string hash_of(const Job& job, FileHashes& files) {
  json contents = json::array();
  for (const JobInput& input : inputs_of(job)) {
    add_file(input.path, files, contents);
    for (const auto& path : files.named_in(input.path, *input.named)) {
      add_file(path, files, contents);
    }
  }
  const json identity = {program(),   job.kind->name, job.inputs,
                         job.options, job.outputs,    std::move(contents)};
  return map::sha256_of_bytes(identity.dump(-1, ' ', false, json::error_handler_t::replace));
}

std::string hash_of_bad_line(std::string_view line) {
  return map::sha256_of_bytes(program() + " bad line " + std::string(line));
}

}  // namespace roadbed::tools::batch
