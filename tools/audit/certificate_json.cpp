#include "roadbed/tools/audit/certificate_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/occupancy/ground/ground.h"
#include "roadbed/tools/audit/certificate_values.h"
#include "roadbed/tools/files/json.h"
#include "roadbed/tools/files/vehicle_json.h"
#include "roadbed/tools/simulation/scenario.h"

namespace roadbed::tools::inline audit {
namespace {

using planning::GroundRule;

using planning::AuditCertificate;
using planning::Conflict;
using planning::ObservedTime;
using planning::ProvenSpan;
using planning::ProvenTime;
using planning::Stretch;
using planning::UnknownPolicy;
using planning::Verdict;
constexpr std::string_view kFormat = "roadbed audit certificate 2", kBody = "body";
constexpr Range kUnderside_m{-100.0, 100.0};

constexpr std::array<UnknownPolicy, 3> kPolicies{UnknownPolicy::free, UnknownPolicy::occupied,
                                                 UnknownPolicy::report};
constexpr std::array<Verdict, 4> kVerdicts{Verdict::clear, Verdict::conflict, Verdict::unknown,
                                           Verdict::undecided};

Json file_json(const CertifiedFile& file) { return {{"file", file.name}, {"sha256", file.sha256}}; }

// A rectangle in the middle is told as a vehicle is; what differs from that is told besides.
Json part_json(const geometry::BodyPart& part) {
  Json json{{"length_m", part.length_m()},
            {"width_m", part.width_m()},
            {"rear_overhang_m", -part.rear_m}};
  if (part.right_m + part.left_m != 0.0) json["middle_m"] = part.middle_in_vehicle().y();
  if (part.is_circle()) json["radius_m"] = part.radius_m;
  if (part.name != kBody) json["name"] = part.name;
  return json;
}

constexpr std::array<std::pair<GroundRule::Kind, std::string_view>, 3> kGrounds{
    {{GroundRule::Kind::level, "level"},
     {GroundRule::Kind::map, "map"},
     {GroundRule::Kind::measured, "measured"}}};

Json places_json(const map::Ground& ground) {
  Json json = Json::array();
  for (const map::GroundPlace& place : ground.places()) {
    json.push_back(
        {place.in_source.x(), place.in_source.y(), place.z_m, place.slope.x(), place.slope.y()});
  }
  return json;
}

void add_ground(Json& json, const CertifiedGround& ground) {
  const auto* named =
      std::ranges::find(kGrounds, ground.kind, [](const auto& known) { return known.first; });
  Json above{{"ground", named->second}, {"margin_m", ground.under.margin_m}};
  if (ground.under.surface) {
    above["places"] = places_json(*ground.under.surface);
  } else {
    above["level_m"] = ground.under.level_m;
  }
  json["heights_above"] = std::move(above);
}

Json observed_json(const std::vector<ObservedTime>& times) {
  Json json = Json::array();
  for (const ObservedTime& time : times) {
    json.push_back({time.from_s, time.to_s, time.column_in_source.x(), time.column_in_source.y()});
  }
  return json;
}

Json times_json(const std::vector<ProvenTime>& spans) {
  Json json = Json::array();
  for (const ProvenTime& span : spans) json.push_back({span.from_s, span.to_s, span.at_least_m});
  return json;
}

Json conflicts_json(const std::vector<Conflict>& conflicts) {
  Json json = Json::array();
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
std::string dumped(const Json& value) { return map::json_text(value); }

// One value per line of the long lists would make files of a hundred thousand lines.
std::string text_of(const Json& document) {
  std::string text = "{\n";
  for (auto member = document.begin(); member != document.end(); ++member) {
    text += fmt::format("{}{}: {}", member == document.begin() ? "" : ",\n", dumped(member.key()),
                        dumped(member.value()));
  }
  return text + "\n}\n";
}

template <class Value, std::size_t N>
Value one_of(const JsonNode& node, const std::array<Value, N>& values) {
  const std::string text = node.text();
  for (const Value value : values) {
    if (planning::to_string(value) == text) return value;
  }
  node.refuse(fmt::format("is \"{}\"", text), "a word that roadbed writes",
              "write the certificate anew");
}

CertifiedFile read_file_entry(const JsonNode& node) {
  node.require_object({"file", "sha256"});
  return {.name = node.at("file").one_line(), .sha256 = node.at("sha256").one_line()};
}

geometry::BodyPart read_part(const JsonNode& node) {
  node.require_object(
      {"length_m", "width_m", "rear_overhang_m", "wheelbase_m", "middle_m", "radius_m", "name"});
  constexpr Range measure{0.0, 2000.0}, place{-1000.0, 1000.0};
  const double length_m = node.at("length_m").number(measure);
  const double width_m = node.at("width_m").number(measure);
  const double rear_m = -node.at("rear_overhang_m").number(place);
  const double middle_m = node.number_or("middle_m", 0.0, place);
  geometry::BodyPart part{.rear_m = rear_m,
                          .front_m = rear_m + length_m,
                          .right_m = middle_m - 0.5 * width_m,
                          .left_m = middle_m + 0.5 * width_m,
                          .radius_m = node.number_or("radius_m", 0.0, measure)};
  if (const auto name = node.find("name")) part.name = read_part_name(*name);
  try {
    part.check();
  } catch (const std::invalid_argument& fault) {
    node.refuse(fault.what(), "a vehicle", "write the certificate anew");
  }
  return part;
}

map::HeightBand read_band(const JsonNode& node) {
  constexpr Range height{-1e6, 1e6};
  const std::vector<JsonNode> ends = numbers(node, 2);
  const map::HeightBand band{ends[0].number(height), ends[1].number(height), nullptr};
  if (!is_height_of_part(band.from_m, band.to_m)) {
    node.refuse(fmt::format("is {:.9g} m high", band.to_m - band.from_m),
                fmt::format("at least {} m", kLeastHeight_m), "write the certificate anew");
  }
  return band;
}

std::shared_ptr<const map::Ground> read_places(const JsonNode& node) {
  constexpr Range slope{-0.5, 0.5}, height{-1e6, 1e6}, place{-1e9, 1e9};
  std::vector<map::GroundPlace> places;
  for (const JsonNode& element : node.elements()) {
    const std::vector<JsonNode> values = numbers(element, 5);
    places.push_back({{values[0].number(place), values[1].number(place)},
                      values[2].number(height),
                      {values[3].number(slope), values[4].number(slope)}});
  }
  if (places.empty()) node.refuse("is empty", "a place at least", "write the certificate anew");
  return std::make_shared<const map::Ground>(std::move(places));
}

CertifiedGround read_ground(const JsonNode& node) {
  node.require_object({"ground", "margin_m", "level_m", "places"});
  const JsonNode word = node.at("ground");
  const auto* named =
      std::ranges::find(kGrounds, word.text(), [](const auto& known) { return known.second; });
  if (named == kGrounds.end()) {
    word.refuse(fmt::format("is \"{}\"", word.text()), "level, map or measured",
                "write the certificate anew");
  }
  CertifiedGround ground{.kind = named->first, .under = {}};
  ground.under.margin_m = node.at("margin_m").number({0.0, 100.0});
  if (const auto places = node.find("places")) {
    ground.under.surface = read_places(*places);
  } else {
    ground.under.level_m = node.at("level_m").number({-1e6, 1e6});
  }
  return ground;
}

std::vector<ObservedTime> read_observed(const JsonNode& node) {
  std::vector<ObservedTime> times;
  for (const JsonNode& element : node.elements()) {
    const std::vector<JsonNode> values = numbers(element, 4);
    times.push_back({values[0].number(kAny),
                     values[1].number(kAny),
                     {values[2].number(kAny), values[3].number(kAny)}});
  }
  return times;
}

std::vector<ProvenTime> read_times(const JsonNode& node) {
  std::vector<ProvenTime> spans;
  for (const JsonNode& element : node.elements()) {
    const std::vector<JsonNode> values = numbers(element, 3);
    spans.push_back({values[0].number(kAny), values[1].number(kAny), values[2].number(kLength_m)});
  }
  return spans;
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
    if (const auto id = element.find("obstacle")) conflict.obstacle = id->one_line();
    conflicts.push_back(conflict);
  }
  return conflicts;
}

void add_claims(Json& json, const AuditCertificate& audit, bool has_moving) {
  json["verdict"] = planning::to_string(audit.verdict);
  json["certified_clearance_m"] = audit.certified_clearance_m;
  json["conflicts"] = conflicts_json(audit.conflicts);
  json["unknown"] = stretches_json(audit.unknown);
  json["undecided"] = stretches_json(audit.undecided);
  json["from_occupied"] = spans_json(audit.from_occupied);
  json["from_unknown"] = spans_json(audit.from_unknown);
  json["observed"] = observed_json(audit.observed);
  json["measured_share"] = audit.measured_fraction;
  if (has_moving) json["from_moving"] = times_json(audit.from_moving);
}

void read_claims(const JsonNode& node, bool has_moving, AuditCertificate& audit) {
  audit.part = read_part(node.at("vehicle"));
  audit.band = read_band(node.at("heights_m"));
  audit.verdict = one_of(node.at("verdict"), kVerdicts);
  audit.certified_clearance_m = node.at("certified_clearance_m").number(kLength_m);
  audit.conflicts = read_conflicts(node.at("conflicts"));
  audit.unknown = read_stretches(node.at("unknown"));
  audit.undecided = read_stretches(node.at("undecided"));
  audit.from_occupied = read_spans(node.at("from_occupied"));
  audit.from_unknown = read_spans(node.at("from_unknown"));
  audit.observed = read_observed(node.at("observed"));
  audit.measured_fraction = node.at("measured_share").number(kFraction);
  if (has_moving) audit.from_moving = read_times(node.at("from_moving"));
}

void add_parts(Json& json, const CertificateFile& file) {
  const AuditCertificate& body = file.parts.front();
  const bool has_moving = file.obstacles.has_value();
  json["vehicle"] = part_json(body.part);
  json["heights_m"] = {body.band.from_m, body.band.to_m};
  json["underside_m"] = file.underside_m;
  add_ground(json, file.ground);
  json["clearance_m"] = body.clearance_m;
  json["inflate_m"] = body.inflate_m;
  json["unknown_counts_as"] = planning::to_string(body.unknown_policy);
  json["least_measured"] = file.least_measured;
  add_claims(json, body, has_moving);
  for (std::size_t i = 1; i < file.parts.size(); ++i) {
    const AuditCertificate& audit = file.parts[i];
    Json part{{"vehicle", part_json(audit.part)},
              {"heights_m", {audit.band.from_m, audit.band.to_m}}};
    add_claims(part, audit, has_moving);
    json["parts"].push_back(std::move(part));
  }
}

void read_parts(const JsonNode& node, CertificateFile& file) {
  const bool has_moving = file.obstacles.has_value();
  AuditCertificate audit;
  audit.clearance_m = node.at("clearance_m").number(kLength_m);
  audit.inflate_m = node.at("inflate_m").number(kLength_m);
  audit.unknown_policy = one_of(node.at("unknown_counts_as"), kPolicies);
  file.least_measured = node.at("least_measured").number(kFraction);
  file.ground = read_ground(node.at("heights_above"));
  read_claims(node, has_moving, audit);
  audit.band.ground = file.ground.under.surface.get();
  file.parts.push_back(audit);
  const auto parts = node.find("parts");
  if (!parts) return;
  for (const JsonNode& part : parts->elements()) {
    part.require_object({"vehicle", "heights_m", "verdict", "certified_clearance_m", "conflicts",
                         "unknown", "undecided", "from_occupied", "from_unknown", "from_moving",
                         "observed", "measured_share"});
    read_claims(part, has_moving, audit);
    audit.band.ground = file.ground.under.surface.get();
    file.parts.push_back(audit);
  }
}

}  // namespace

Verdict CertificateFile::verdict() const {
  const bool is_measured = parts.empty() || measured_fraction() >= least_measured;
  for (const Verdict grave : {Verdict::conflict, Verdict::unknown, Verdict::undecided}) {
    if (std::ranges::count(parts, grave, &AuditCertificate::verdict) > 0) return grave;
    if (surface && surface->verdict() == grave) return grave;
    if (grave == Verdict::unknown && !is_measured) return grave;
  }
  return Verdict::clear;
}

double CertificateFile::certified_clearance_m() const {
  if (parts.empty()) return 0.0;
  return std::ranges::min(parts, {}, &AuditCertificate::certified_clearance_m)
      .certified_clearance_m;
}

double CertificateFile::measured_fraction() const {
  double measured_m3 = 0.0, all_m3 = 0.0;
  for (const AuditCertificate& part : parts) {
    const double height_m = part.band.to_m - part.band.from_m - 2.0 * ground.under.margin_m;
    const double part_m3 = geometry::box_area_m2(part.part) * height_m;
    measured_m3 += part.measured_fraction * part_m3;
    all_m3 += part_m3;
  }
  return measured_m3 / all_m3;
}

std::string write_certificate_json(const CertificateFile& file) {
  Json json;
  json["format"] = kFormat;
  json["program"] = file.program;
  if (file.occupancy) json["occupancy"] = file_json(*file.occupancy);
  json["trajectory"] = file_json(file.trajectory);
  if (file.obstacles) json["obstacles"] = file_json(*file.obstacles);
  if (file.vehicle) json["vehicle_file"] = file_json(*file.vehicle);
  if (file.roads) json["map"] = file_json(*file.roads);
  if (file.occupancy) {
    add_parts(json, file);
  } else {
    json["underside_m"] = file.underside_m;
  }
  if (file.surface) json["surface"] = surface_certificate_json(*file.surface);
  return text_of(json);
}

CertificateFile parse_certificate_json(std::string_view bytes, const std::string& name) {
  const nlohmann::json document = parse_json_strictly(bytes, name);
  const JsonNode node(document, name);
  node.require_object({"format",
                       "program",
                       "occupancy",
                       "trajectory",
                       "vehicle",
                       "heights_m",
                       "clearance_m",
                       "inflate_m",
                       "unknown_counts_as",
                       "verdict",
                       "certified_clearance_m",
                       "conflicts",
                       "unknown",
                       "undecided",
                       "from_occupied",
                       "from_unknown",
                       "obstacles",
                       "from_moving",
                       "parts",
                       "underside_m",
                       "heights_above",
                       "least_measured",
                       "observed",
                       "measured_share",
                       "vehicle_file",
                       "map",
                       "surface"});
  if (const JsonNode format = node.at("format"); format.text() != kFormat) {
    format.refuse(fmt::format("is \"{}\"", format.text()), fmt::format("\"{}\"", kFormat),
                  "write the certificate with this version of roadbed");
  }
  CertificateFile file{.program = node.at("program").one_line(),
                       .trajectory = read_file_entry(node.at("trajectory")),
                       .parts = {}};
  if (const auto surface = node.find("surface")) file.surface = read_surface_certificate(*surface);
  const bool has_occupancy = !file.surface || node.find("occupancy");
  if (has_occupancy) file.occupancy = read_file_entry(node.at("occupancy"));
  if (const auto obstacles = node.find("obstacles")) file.obstacles = read_file_entry(*obstacles);
  if (const auto vehicle = node.find("vehicle_file")) file.vehicle = read_file_entry(*vehicle);
  if (const auto roads = node.find("map")) file.roads = read_file_entry(*roads);
  file.underside_m = node.at("underside_m").number(kUnderside_m);
  if (has_occupancy) read_parts(node, file);
  return file;
}

CertificateFile read_certificate_json(const std::filesystem::path& file) {
  return parse_certificate_json(map::read_file(file), map::input_name(file));
}

std::vector<std::filesystem::path> files_named_by_certificate(const std::filesystem::path& file) {
  try {
    const CertificateFile read = read_certificate_json(file);
    std::vector<std::filesystem::path> files{read.trajectory.name};
    const auto of_surface = read.surface ? read.surface->file : std::nullopt;
    for (const auto& named :
         {read.occupancy, read.vehicle, read.roads, read.obstacles, of_surface}) {
      if (named) files.emplace_back(named->name);
    }
    if (!read.obstacles) return files;
    const auto more = files_named_by_scenario(read.obstacles->name);
    files.insert(files.end(), more.begin(), more.end());
    return files;
  } catch (const map::InputError&) {
    return {};
  }
}

}  // namespace roadbed::tools::audit
