#include "roadbed/tools/report/drive_record.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/tools/audit/certificate_json.h"
#include "roadbed/tools/files/vehicle_file.h"
#include "roadbed/tools/simulation/scenario.h"

namespace roadbed::tools::inline report {
namespace {

namespace fs = std::filesystem;

constexpr int kFormat = 1;
constexpr std::string_view kScenarioRole = "scenario", kCloudRole = "cloud",
                           kObstaclesRole = "obstacles";

/// The folder is looked up as it is, the name in it may be a link: what a scenario names in turn is
/// relative to where the link is.
std::string relative_name(const fs::path& file, const fs::path& folder) {
  if (is_vehicle_name(file.native())) return file.string();
  const fs::path parent = fs::weakly_canonical(fs::absolute(file).parent_path());
  const fs::path from = fs::weakly_canonical(fs::absolute(folder));
  return (parent / file.filename()).lexically_relative(from).generic_string();
}

std::string role_of(const JsonNode& node) {
  const std::string role = node.text();
  if (std::ranges::find(kDriveRoles, role) == std::end(kDriveRoles)) {
    node.refuse(fmt::format("is \"{}\"", role),
                fmt::format("one of {}", fmt::join(kDriveRoles, ", ")), "drive it again");
  }
  return role;
}

std::string sha256_in(const JsonNode& node) {
  const std::string text = node.text();
  const bool is_hex = text.find_first_not_of("0123456789abcdef") == std::string::npos;
  if (text.size() != 64 || !is_hex) {
    node.refuse("is no SHA-256", "64 hexadecimal digits", "drive it again");
  }
  return text;
}

DriveSource source_in(const JsonNode& node, const fs::path& folder) {
  node.require_object({"role", "file", "sha256"});
  const std::string name = node.at("file").one_line();
  return {.role = role_of(node.at("role")),
          .file = is_vehicle_name(name) ? fs::path(name) : folder / name,
          .sha256 = sha256_in(node.at("sha256"))};
}

void check_roles(const std::vector<DriveSource>& sources, const JsonNode& node) {
  for (const std::string_view role : kDriveRoles) {
    const auto count = std::ranges::count(sources, role, &DriveSource::role);
    if (count > 1 && role != kCloudRole && role != kObstaclesRole) {
      node.refuse(fmt::format("has {} of the role \"{}\"", count, role), "one at most",
                  "drive it again");
    }
  }
  if (sources.empty() || sources.front().role != kScenarioRole) {
    node.refuse("does not begin with a scenario", "it", "drive it again");
  }
}

void check_format(const JsonNode& node) {
  const double format = node.number({0.0, 1e9});
  if (format == kFormat) return;
  node.refuse(fmt::format("is {}: another version of roadbed drove this", format),
              fmt::format("{}", kFormat), "drive it again, or replay it with that version");
}

}  // namespace

fs::path DriveRecord::file_of(std::string_view role) const {
  const auto source = std::ranges::find(sources, role, &DriveSource::role);
  return source == sources.end() ? fs::path() : source->file;
}

std::string write_drive_record(const DriveRecord& record, const fs::path& folder) {
  Json files = Json::array();
  for (const DriveSource& source : record.sources) {
    files.push_back({{"role", source.role},
                     {"file", relative_name(source.file, folder)},
                     {"sha256", source.sha256}});
  }
  Json json = {{"roadbed_drive", kFormat},
               {"program", record.program},
               {"files", files},
               {"predict", record.predicts},
               {"drop_ego_recording", record.drops_ego_recording}};
  if (record.is_outside) json["outside_planner"] = true;
  if (record.seed) json["seed"] = *record.seed;
  return map::json_text(json, 2) + "\n";
}

DriveRecord parse_drive_record(std::string_view bytes, const fs::path& file) {
  const nlohmann::json document = parse_json_strictly(bytes, file.string());
  const JsonNode root(document, file.string());
  check_format(root.at("roadbed_drive"));
  root.require_object({"roadbed_drive", "program", "files", "predict", "drop_ego_recording",
                       "outside_planner", "seed"});
  DriveRecord record{.program = root.at("program").one_line(),
                     .sources = {},
                     .predicts = root.at("predict").boolean(),
                     .drops_ego_recording = root.at("drop_ego_recording").boolean(),
                     .is_outside = root.find("outside_planner").has_value(),
                     .seed = {}};
  if (const auto seed = root.find("seed")) record.seed = seed_in(*seed);
  for (const JsonNode& node : root.at("files").elements()) {
    record.sources.push_back(source_in(node, file.parent_path()));
  }
  check_roles(record.sources, root.at("files"));
  return record;
}

DriveRecord read_drive_record(const fs::path& folder) {
  const fs::path file = folder / kDriveRecordName;
  if (!map::is_file(file)) {
    throw map::InputError({.file = folder.string(),
                           .found = map::is_folder(folder) ? "holds no drive" : "no such folder",
                           .needed = fmt::format("a folder with a {}", kDriveRecordName),
                           .remedy = "give one that `roadbed simulate -o` wrote"});
  }
  return parse_drive_record(map::read_file(file), file);
}

void check_sources(const DriveRecord& record) {
  for (const DriveSource& source : record.sources) {
    if (certified_file(source.file).sha256 == source.sha256) continue;
    throw map::InputError({.file = source.file.string(),
                           .found = "has changed since the drive",
                           .needed = "the " + source.role + " of SHA-256 " + source.sha256,
                           .remedy = "put it back, or drive again with `roadbed simulate`"});
  }
}

}  // namespace roadbed::tools::report
