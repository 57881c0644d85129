#include "roadbed/tools/support/certificate_json.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "roadbed/map/read_file.h"
#include "roadbed/tools/support/json_node.h"
#include "roadbed/tools/support/obstacles_csv.h"

namespace roadbed::tools {
namespace {

using planning::AuditCertificate;
using planning::Conflict;
using planning::ProvenSpan;
using planning::ProvenTime;
using planning::Stretch;
using planning::UnknownPolicy;
using planning::Verdict;
using Ordered = nlohmann::ordered_json;

constexpr std::string_view kFormat = "roadbed audit certificate 1";
constexpr Range kAny{-1e12, 1e12}, kShare{0.0, 1.0}, kLength_m{0.0, 200.0}, kCount{0.0, 1e9};

constexpr std::array<UnknownPolicy, 3> kPolicies{UnknownPolicy::free, UnknownPolicy::occupied,
                                                 UnknownPolicy::report};
constexpr std::array<Verdict, 4> kVerdicts{Verdict::clear, Verdict::conflict, Verdict::unknown,
                                           Verdict::undecided};

Ordered file_json(const CertifiedFile& file) {
  return {{"file", file.name}, {"xxhash", file.xxhash}};
}

Ordered vehicle_json(const geometry::VehicleShape& vehicle) {
  return {{"length_m", vehicle.length_m},
          {"width_m", vehicle.width_m},
          {"rear_overhang_m", vehicle.rear_overhang_m},
          {"wheelbase_m", vehicle.wheelbase_m}};
}

Ordered spans_json(const std::vector<ProvenSpan>& spans) {
  Ordered json = Ordered::array();
  for (const ProvenSpan& span : spans) {
    json.push_back({span.segment, span.from, span.to, span.at_least_m});
  }
  return json;
}

Ordered times_json(const std::vector<ProvenTime>& spans) {
  Ordered json = Ordered::array();
  for (const ProvenTime& span : spans) json.push_back({span.from_s, span.to_s, span.at_least_m});
  return json;
}

Ordered stretches_json(const std::vector<Stretch>& stretches) {
  Ordered json = Ordered::array();
  for (const Stretch& stretch : stretches) json.push_back({stretch.from_s, stretch.to_s});
  return json;
}

Ordered conflicts_json(const std::vector<Conflict>& conflicts) {
  Ordered json = Ordered::array();
  for (const Conflict& conflict : conflicts) {
    const Eigen::Vector2d &least = conflict.witness.min_in_source,
                          &most = conflict.witness.max_in_source;
    json.push_back({{"from_s", conflict.from_s},
                    {"to_s", conflict.to_s},
                    {"at_s", conflict.at.t_s},
                    {"clearance_m", conflict.least_clearance_m},
                    {"witness_m", {least.x(), least.y(), most.x(), most.y()}}});
    if (!conflict.obstacle.empty()) json.back()["obstacle"] = conflict.obstacle;
  }
  return json;
}

// File names may hold bytes that are no UTF-8.
std::string dumped(const Ordered& value) {
  return value.dump(-1, ' ', false, Ordered::error_handler_t::replace);
}

// One value per line of the long lists would make files of a hundred thousand lines.
std::string text_of(const Ordered& document) {
  std::string text = "{\n";
  for (auto member = document.begin(); member != document.end(); ++member) {
    text += fmt::format("{}{}: {}", member == document.begin() ? "" : ",\n", dumped(member.key()),
                        dumped(member.value()));
  }
  return text + "\n}\n";
}

std::vector<JsonNode> numbers(const JsonNode& node, std::size_t count) {
  std::vector<JsonNode> elements = node.elements();
  if (elements.size() != count) {
    node.refuse(fmt::format("has {} values", elements.size()), fmt::format("{}", count),
                "write the certificate anew");
  }
  return elements;
}

template <class Value, std::size_t N>
Value one_of(const JsonNode& node, const std::array<Value, N>& values) {
  const std::string text = node.text();
  for (const Value value : values) {
    if (planning::name(value) == text) return value;
  }
  node.refuse(fmt::format("is \"{}\"", text), "a word that roadbed writes",
              "write the certificate anew");
}

CertifiedFile read_file_entry(const JsonNode& node) {
  node.require_object({"file", "xxhash"});
  return {.name = node.at("file").text(), .xxhash = node.at("xxhash").text()};
}

geometry::VehicleShape read_vehicle(const JsonNode& node) {
  node.require_object({"length_m", "width_m", "rear_overhang_m", "wheelbase_m"});
  constexpr Range measure{0.0, 1000.0};
  geometry::VehicleShape shape;
  shape.length_m = node.at("length_m").number(measure);
  shape.width_m = node.at("width_m").number(measure);
  shape.rear_overhang_m = node.at("rear_overhang_m").number(measure);
  shape.wheelbase_m = node.at("wheelbase_m").number(measure);
  try {
    shape.check();
  } catch (const std::invalid_argument& fault) {
    node.refuse(fault.what(), "a vehicle", "write the certificate anew");
  }
  return shape;
}

map::HeightBand read_band(const JsonNode& node) {
  constexpr Range height{-1e6, 1e6};
  const std::vector<JsonNode> ends = numbers(node, 2);
  const map::HeightBand band{ends[0].number(height), ends[1].number(height)};
  if (!(band.from_m < band.to_m)) {
    node.refuse("is empty", "a lower and a higher end", "write the certificate anew");
  }
  return band;
}

std::vector<ProvenSpan> read_spans(const JsonNode& node) {
  std::vector<ProvenSpan> spans;
  for (const JsonNode& element : node.elements()) {
    const std::vector<JsonNode> values = numbers(element, 4);
    spans.push_back({static_cast<std::size_t>(values[0].number(kCount)), values[1].number(kShare),
                     values[2].number(kShare), values[3].number(kLength_m)});
    if (!(spans.back().from < spans.back().to)) {
      element.refuse("is empty", "a start before its end", "write the certificate anew");
    }
  }
  return spans;
}

std::vector<ProvenTime> read_times(const JsonNode& node) {
  std::vector<ProvenTime> spans;
  for (const JsonNode& element : node.elements()) {
    const std::vector<JsonNode> values = numbers(element, 3);
    spans.push_back({values[0].number(kAny), values[1].number(kAny), values[2].number(kLength_m)});
  }
  return spans;
}

std::vector<Stretch> read_stretches(const JsonNode& node) {
  std::vector<Stretch> stretches;
  for (const JsonNode& element : node.elements()) {
    const std::vector<JsonNode> values = numbers(element, 2);
    stretches.push_back({values[0].number(kAny), values[1].number(kAny)});
  }
  return stretches;
}

std::vector<Conflict> read_conflicts(const JsonNode& node) {
  std::vector<Conflict> conflicts;
  for (const JsonNode& element : node.elements()) {
    element.require_object({"from_s", "to_s", "at_s", "clearance_m", "witness_m", "obstacle"});
    const std::vector<JsonNode> witness = numbers(element.at("witness_m"), 4);
    Conflict conflict;
    conflict.from_s = element.at("from_s").number(kAny);
    conflict.to_s = element.at("to_s").number(kAny);
    conflict.at.t_s = element.at("at_s").number(kAny);
    conflict.least_clearance_m = element.at("clearance_m").number(kLength_m);
    conflict.witness = {{witness[0].number(kAny), witness[1].number(kAny)},
                        {witness[2].number(kAny), witness[3].number(kAny)}};
    if (const auto id = element.find("obstacle")) conflict.obstacle = id->text();
    conflicts.push_back(conflict);
  }
  return conflicts;
}

}  // namespace

CertifiedFile certified_file(const std::filesystem::path& file) {
  const std::string bytes = map::read_file(file);
  return {.name = file.string(),
          .xxhash = fmt::format("{:016x}", XXH3_64bits(bytes.data(), bytes.size()))};
}

CertifiedFile certified_obstacles(const std::filesystem::path& file,
                                  const std::vector<planning::MovingObstacle>& obstacles) {
  const std::string text = obstacles_text(obstacles);
  return {.name = file.string(),
          .xxhash = fmt::format("{:016x}", XXH3_64bits(text.data(), text.size()))};
}

std::string write_certificate_json(const CertificateFile& file) {
  const AuditCertificate& audit = file.certificate;
  Ordered json;
  json["format"] = kFormat;
  json["program"] = file.program;
  json["occupancy"] = file_json(file.occupancy);
  json["trajectory"] = file_json(file.trajectory);
  if (file.obstacles) json["obstacles"] = file_json(*file.obstacles);
  json["vehicle"] = vehicle_json(audit.vehicle);
  json["heights_m"] = {audit.band.from_m, audit.band.to_m};
  json["clearance_m"] = audit.clearance_m;
  json["inflate_m"] = audit.inflate_m;
  json["unknown_counts_as"] = planning::name(audit.unknown_policy);
  json["verdict"] = planning::name(audit.verdict);
  json["certified_clearance_m"] = audit.certified_clearance_m;
  json["conflicts"] = conflicts_json(audit.conflicts);
  json["unknown"] = stretches_json(audit.unknown);
  json["undecided"] = stretches_json(audit.undecided);
  json["from_occupied"] = spans_json(audit.from_occupied);
  json["from_unknown"] = spans_json(audit.from_unknown);
  if (file.obstacles) json["from_moving"] = times_json(audit.from_moving);
  return text_of(json);
}

CertificateFile parse_certificate_json(std::string_view bytes, const std::string& name) {
  const nlohmann::json document = parse_json_strictly(bytes, name);
  const JsonNode node(document, name);
  node.require_object({"format", "program", "occupancy", "trajectory", "vehicle", "heights_m",
                       "clearance_m", "inflate_m", "unknown_counts_as", "verdict",
                       "certified_clearance_m", "conflicts", "unknown", "undecided",
                       "from_occupied", "from_unknown", "obstacles", "from_moving"});
  if (const JsonNode format = node.at("format"); format.text() != kFormat) {
    format.refuse(fmt::format("is \"{}\"", format.text()), fmt::format("\"{}\"", kFormat),
                  "write the certificate with this version of roadbed");
  }
  CertificateFile file{.program = node.at("program").text(),
                       .occupancy = read_file_entry(node.at("occupancy")),
                       .trajectory = read_file_entry(node.at("trajectory")),
                       .certificate = {}};
  AuditCertificate& audit = file.certificate;
  audit.vehicle = read_vehicle(node.at("vehicle"));
  audit.band = read_band(node.at("heights_m"));
  audit.clearance_m = node.at("clearance_m").number(kLength_m);
  audit.inflate_m = node.at("inflate_m").number(kLength_m);
  audit.unknown_policy = one_of(node.at("unknown_counts_as"), kPolicies);
  audit.verdict = one_of(node.at("verdict"), kVerdicts);
  audit.certified_clearance_m = node.at("certified_clearance_m").number(kLength_m);
  audit.conflicts = read_conflicts(node.at("conflicts"));
  audit.unknown = read_stretches(node.at("unknown"));
  audit.undecided = read_stretches(node.at("undecided"));
  audit.from_occupied = read_spans(node.at("from_occupied"));
  audit.from_unknown = read_spans(node.at("from_unknown"));
  if (const auto obstacles = node.find("obstacles")) {
    file.obstacles = read_file_entry(*obstacles);
    audit.from_moving = read_times(node.at("from_moving"));
  }
  return file;
}

CertificateFile read_certificate_json(const std::filesystem::path& file) {
  return parse_certificate_json(map::read_file(file), file.string());
}

}  // namespace roadbed::tools
