#include "roadbed/tools/batch/job_hash.h"

#include "roadbed/map/files/sha256.h"
#include "roadbed/tools/cli/build_id.h"

namespace roadbed::tools::inline batch {
namespace {

using nlohmann::json;

const std::string& program() {
  static const std::string text = version() + " " + build_id();
  return text;
}

void add_file(const std::filesystem::path& path, FileHashes& files, json& list) {
  list.push_back({path.generic_string(), files.of(path)});
}

}  // namespace

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

}  // namespace roadbed::tools
