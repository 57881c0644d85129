#include "roadbed/tools/simulation/scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/planning/obstacles/obstacle_limits.h"
#include "roadbed/tools/files/json.h"
#include "roadbed/tools/files/vehicle_file.h"

namespace roadbed::tools::inline simulation {
namespace {

constexpr Range kCoordinate{-1e9, 1e9};
constexpr Range kAngle{-1e3, 1e3};
constexpr Range kSpeed{0.0, 100.0};
constexpr Range kTime{0.0, 3600.0};
constexpr Range kDuration{0.1, 3600.0};
constexpr Range kSize{0.05, 100.0};
constexpr Range kDeviation{0.0, 100.0};
constexpr Range kOffset{-100.0, 100.0};
// Every whole number up to it is a double, which JSON numbers are.
constexpr std::uint64_t kLargestSeed = std::uint64_t{1} << 53;

ScenarioPlace place(const JsonNode& node) { return {node.text(), node.pointer()}; }

std::filesystem::path beside(const JsonNode& node, const std::filesystem::path& folder) {
  return folder / node.text();  // an absolute path stays itself
}

std::vector<std::filesystem::path> occupancy_files(const JsonNode& node,
                                                   const std::filesystem::path& folder) {
  if (node.value().is_string()) return {beside(node, folder)};
  std::vector<std::filesystem::path> files;
  for (const JsonNode& element : node.elements()) files.push_back(beside(element, folder));
  if (files.empty()) node.refuse("is an empty list", "at least one file", "remove the key");
  return files;
}

geometry::Pose2 pose(const JsonNode& node) {
  return {.x_m = node.at("x_m").number(kCoordinate),
          .y_m = node.at("y_m").number(kCoordinate),
          .heading_rad = node.at("heading_rad").number(kAngle)};
}

ParkedObstacle parked(const JsonNode& node) {
  if (const auto text = node.find("place")) {
    node.require_object({"place", "d_m"});
    return {ParkedObstacle::Beside{place(*text), node.number_or("d_m", 0.0, kOffset)}};
  }
  node.require_object({"x_m", "y_m", "heading_rad", "place", "d_m"});
  return {pose(node)};
}

/// Times of a list must increase, or what lies between them has no meaning.
void require_later(const JsonNode& node, double t_s, double previous_s) {
  if (t_s >= previous_s + planning::kLeastObstacleStep_s) return;
  node.refuse(fmt::format("is {} after {}", t_s, previous_s),
              "a time that is later by 1 µs at least", "sort the list");
}

std::vector<JsonNode> not_empty(const JsonNode& list) {
  std::vector<JsonNode> nodes = list.elements();
  if (nodes.empty()) list.refuse("is an empty list", "at least one entry", "add one");
  return nodes;
}

ScriptedObstacle scripted(const JsonNode& list) {
  ScriptedObstacle obstacle;
  for (const JsonNode& node : not_empty(list)) {
    node.require_object({"t_s", "x_m", "y_m", "heading_rad"});
    const double t_s = node.at("t_s").number(kTime);
    if (!obstacle.poses.empty()) require_later(node.at("t_s"), t_s, obstacle.poses.back().t_s);
    obstacle.poses.push_back({t_s, pose(node)});
  }
  return obstacle;
}

std::vector<TimedSpeed> speeds(const JsonNode& list) {
  std::vector<TimedSpeed> timed;
  for (const JsonNode& node : not_empty(list)) {
    node.require_object({"t_s", "speed_mps"});
    const double t_s = node.at("t_s").number(kTime);
    if (!timed.empty()) require_later(node.at("t_s"), t_s, timed.back().t_s);
    timed.push_back({t_s, node.at("speed_mps").number(kSpeed)});
  }
  return timed;
}

TrafficObstacle traffic(const JsonNode& node) {
  node.require_object({"start", "to", "speed_mps", "speeds"});
  TrafficObstacle obstacle;
  obstacle.start = place(node.at("start"));
  if (const auto to = node.find("to")) obstacle.to = place(*to);
  const auto profile = node.find("speeds");
  if (profile && node.find("speed_mps")) {
    profile->refuse("stands beside speed_mps", "one of the two", "remove one");
  }
  obstacle.speeds = profile ? speeds(*profile)
                            : std::vector<TimedSpeed>{{0.0, node.at("speed_mps").number(kSpeed)}};
  return obstacle;
}

ScenarioObstacle obstacle(const JsonNode& node, const std::filesystem::path& folder) {
  node.require_object(
      {"id", "kind", "length_m", "width_m", "parked", "scripted", "traffic", "recorded"});
  ScenarioObstacle result;
  result.id = node.at("id").name();
  if (const auto kind = node.find("kind")) result.kind = kind->name();
  result.length_m = node.number_or("length_m", result.length_m, kSize);
  result.width_m = node.number_or("width_m", result.width_m, kSize);
  const auto stands = node.find("parked");
  const auto moves = node.find("scripted");
  const auto drives = node.find("traffic");
  const auto drove = node.find("recorded");
  if (stands.has_value() + moves.has_value() + drives.has_value() + drove.has_value() != 1) {
    node.refuse("does not say how it moves", "exactly one of parked, scripted, traffic, recorded",
                "keep one of them");
  }
  if (stands) result.motion = parked(*stands);
  if (moves) result.motion = scripted(*moves);
  if (drives) result.motion = traffic(*drives);
  if (drove) result.motion = recorded_obstacle_in(*drove, folder, result.length_m);
  return result;
}

std::vector<ScenarioObstacle> obstacles(const JsonNode& list, const std::filesystem::path& folder) {
  std::vector<ScenarioObstacle> result;
  std::map<std::string, std::string> pointer_of_id;
  for (const JsonNode& node : list.elements()) {
    result.push_back(obstacle(node, folder));
    const auto [other, is_new] = pointer_of_id.emplace(result.back().id, node.pointer());
    if (!is_new) {
      node.at("id").refuse(fmt::format("is \"{}\" again, as {}", result.back().id, other->second),
                           "an id of its own", "rename one of the two");
    }
  }
  return result;
}

std::vector<planning::TimeSpan> time_spans(const JsonNode& list) {
  std::vector<planning::TimeSpan> spans;
  for (const JsonNode& node : not_empty(list)) {
    node.require_object({"from_s", "to_s"});
    const planning::TimeSpan span{node.at("from_s").number(kTime), node.at("to_s").number(kTime)};
    require_later(node.at("to_s"), span.to_s, span.from_s);
    spans.push_back(span);
  }
  return spans;
}

planning::LightPhase light_phase(const JsonNode& node) {
  node.require_object({"colour", "duration_s"});
  return {light_colour_in(node.at("colour")), node.at("duration_s").number(kDuration)};
}

std::vector<planning::LightCycle> lights(const JsonNode& list) {
  std::vector<planning::LightCycle> result;
  for (const JsonNode& node : list.elements()) {
    node.require_object({"signals", "offset_s", "phases"});
    planning::LightCycle light{.signals = {}, .pointer = node.pointer(), .phases = {}};
    for (const JsonNode& signal : not_empty(node.at("signals"))) {
      light.signals.push_back(signal.name());
    }
    light.offset_s = node.number_or("offset_s", 0.0, {-3600.0, 3600.0});
    for (const JsonNode& phase : not_empty(node.at("phases"))) {
      light.phases.push_back(light_phase(phase));
    }
    result.push_back(std::move(light));
  }
  return result;
}

planning::DrivingOptions options(const JsonNode& node) {
  planning::DrivingOptions options;
  limits_in(node, {"pedals"}).apply_to(options);
  return options;
}

bool has_pedals(const JsonNode& options, bool otherwise) {
  const auto pedals = options.find("pedals");
  return pedals ? pedals->boolean() : otherwise;
}

ScenarioNoise noise_in(const JsonNode& node) {
  node.check_version("noise");
  node.require_object({"roadbed_noise", "gap_m", "relative_speed_mps", "acceleration_mps2",
                       "position_m", "heading_rad", "speed_mps", "object_position_m",
                       "object_heading_rad", "object_speed_mps", "object_range_m", "dropouts",
                       "dropout_share"});
  const auto deviation = [&](const char* key) { return node.number_or(key, 0.0, kDeviation); };
  const auto dropouts = node.find("dropouts");
  return {.gap_m = deviation("gap_m"),
          .relative_speed_mps = deviation("relative_speed_mps"),
          .acceleration_mps2 = deviation("acceleration_mps2"),
          .position_m = deviation("position_m"),
          .heading_rad = deviation("heading_rad"),
          .speed_mps = deviation("speed_mps"),
          .object = {.position_m = deviation("object_position_m"),
                     .heading_rad = deviation("object_heading_rad"),
                     .speed_mps = deviation("object_speed_mps")},
          .object_range_m =
              node.number_or("object_range_m", ScenarioNoise{}.object_range_m, {1.0, 10'000.0}),
          .dropouts = dropouts ? time_spans(*dropouts) : std::vector<planning::TimeSpan>{},
          .dropout_ratio = node.number_or("dropout_share", 0.0, {0.0, 1.0})};
}

ScenarioWayPoints way_points(const JsonNode& root, const JsonNode& list) {
  ScenarioWayPoints way;
  for (const JsonNode& node : not_empty(list)) way.places.push_back(place(node));
  way.half_width_m = root.number_or("half_width_m", way.half_width_m, {0.1, 100.0});
  way.speed_limit_mps = root.number_or("speed_limit_mps", way.speed_limit_mps, {0.3, 100.0});
  if (const auto lights = root.find("lights")) {
    lights->refuse("stands beside way_points", "a goal, on whose route lights are looked at",
                   "remove one of the two");
  }
  return way;
}

void read_way(const JsonNode& root, Scenario& scenario) {
  const auto list = root.find("way_points");
  if (!list) {
    for (const char* key : {"half_width_m", "speed_limit_mps"}) {
      if (const auto node = root.find(key)) {
        node->refuse("stands without way_points", "a line of way-points that it is of",
                     "remove it, or give way_points in place of the goal");
      }
    }
    scenario.goal = place(root.at("goal"));
    return;
  }
  if (root.find("goal")) list->refuse("stands beside goal", "one of the two", "remove one");
  scenario.way_points = way_points(root, *list);
}

void read_ego(const JsonNode& node, Scenario& scenario) {
  node.require_object({"start", "speed_mps"});
  scenario.start = place(node.at("start"));
  scenario.start_speed_mps = node.number_or("speed_mps", 0.0, kSpeed);
}

/// Its measures, a vehicle of CommonRoad's, or a file, which is read later.
void read_vehicle_of(const JsonNode& node, Scenario& scenario) {
  if (!node.value().is_string()) {
    scenario.vehicle = vehicle_shape_in(node);
  } else if (const auto named = named_vehicle(node.one_line())) {
    scenario.vehicle = named->shape;
  } else {
    scenario.vehicle_file = beside(node, scenario.file.parent_path());
  }
}

void read_optional_parts(const JsonNode& root, Scenario& scenario) {
  if (const auto node = root.find("name")) scenario.name = node->name();
  if (const auto node = root.find("occupancy")) {
    scenario.occupancy_files = occupancy_files(*node, scenario.file.parent_path());
  }
  if (const auto node = root.find("vehicle")) read_vehicle_of(*node, scenario);
  if (const auto node = root.find("seed")) scenario.seed = seed_in(*node);
  if (const auto node = root.find("noise")) scenario.noise = noise_in(*node);
  if (const auto node = root.find("options")) {
    scenario.options = options(*node);
    scenario.pedals = has_pedals(*node, scenario.pedals);
  }
  if (const auto node = root.find("lights")) scenario.lights = lights(*node);
  if (const auto node = root.find("obstacles")) {
    scenario.obstacles = obstacles(*node, scenario.file.parent_path());
  }
  if (const auto node = root.find("obstacles_file")) {
    scenario.obstacles_file = beside(*node, scenario.file.parent_path());
  }
}

bool is_random(const ScenarioNoise& noise) {
  const auto all = {noise.gap_m,           noise.relative_speed_mps, noise.acceleration_mps2,
                    noise.position_m,      noise.heading_rad,        noise.speed_mps,
                    noise.dropout_ratio,   noise.object.position_m,  noise.object.heading_rad,
                    noise.object.speed_mps};
  return std::ranges::any_of(all, [](double amount) { return amount > 0.0; });
}

}  // namespace

planning::LightColour light_colour_in(const JsonNode& node) {
  const std::string word = node.text();
  const std::optional<planning::LightColour> colour = planning::light_colour(word);
  if (!colour) node.refuse(fmt::format("is \"{}\"", word), "green, yellow or red", "choose one");
  return *colour;
}

Scenario parse_scenario(std::string_view bytes, const std::filesystem::path& file) {
  const nlohmann::json document = parse_json_strictly(bytes, map::input_name(file));
  const JsonNode root(document, map::input_name(file));
  root.check_version("scenario");
  root.require_object({"roadbed_scenario", "name", "map", "occupancy", "ego", "goal", "way_points",
                       "half_width_m", "speed_limit_mps", "vehicle", "duration_s", "seed", "noise",
                       "options", "lights", "obstacles", "obstacles_file"});
  root.at("roadbed_scenario");
  Scenario scenario;
  scenario.file = file;
  scenario.name = map::input_name(file.stem());
  scenario.map_file = beside(root.at("map"), file.parent_path());
  read_ego(root.at("ego"), scenario);
  read_way(root, scenario);
  scenario.duration_s = root.at("duration_s").number(kDuration);
  read_optional_parts(root, scenario);
  return scenario;
}

Scenario read_scenario(const std::filesystem::path& file) {
  Scenario scenario = parse_scenario(map::read_file(file), file);
  if (!scenario.vehicle_file.empty()) {
    scenario.vehicle = read_vehicle_shape(scenario.vehicle_file);
  }
  return scenario;
}

std::vector<std::filesystem::path> files_named_by_scenario(const std::filesystem::path& file) {
  std::vector<std::filesystem::path> files;
  if (map::is_folder(file)) {
    std::vector<std::filesystem::path> scenarios;
    std::error_code unreadable;
    for (const auto& entry : std::filesystem::directory_iterator(file, unreadable)) {
      if (entry.path().extension() == ".json" && !map::is_folder(entry.path())) {
        scenarios.push_back(entry.path());
      }
    }
    std::ranges::sort(scenarios);
    for (const auto& scenario : scenarios) {
      std::ranges::copy(files_named_by_scenario(scenario), std::back_inserter(files));
    }
    return files;
  }
  try {
    const Scenario scenario = read_scenario(file);
    files = scenario.occupancy_files;
    files.push_back(scenario.map_file);
    for (const auto& named : {scenario.vehicle_file, scenario.obstacles_file}) {
      if (!named.empty()) files.push_back(named);
    }
    for (const ScenarioObstacle& obstacle : scenario.obstacles) {
      const auto* recorded = std::get_if<RecordedObstacle>(&obstacle.motion);
      if (recorded != nullptr) files.push_back(recorded->file);
    }
  } catch (const map::InputError&) {
    return {};
  }
  return files;
}

void ScenarioChanges::apply_to(Scenario& scenario) const {
  if (vehicle) scenario.vehicle = *vehicle;
  if (noise) scenario.noise = *noise;
  planner.apply_to(scenario.options);
  if (!seed) return;
  if (!is_random(scenario.noise)) {
    throw map::InputError({.file = map::input_name(scenario.file),
                           .found = "nothing is left to chance, and a seed is given",
                           .needed = "noise, as all seeds give the same drive without it",
                           .remedy = "leave --seed out, or give --noise"});
  }
  scenario.seed = *seed;
}

std::uint64_t seed_in(const JsonNode& node) {
  const double number = node.number({0.0, static_cast<double>(kLargestSeed)});
  if (number != std::floor(number)) {
    node.refuse(fmt::format("is {}", number), "a whole number", "round it");
  }
  return static_cast<std::uint64_t>(number);
}

std::optional<std::uint64_t> parse_seed(std::string_view text) {
  std::uint64_t seed = 0;
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, seed);
  const bool is_seed = parsed.ec == std::errc() && parsed.ptr == end && seed <= kLargestSeed;
  return is_seed ? std::optional(seed) : std::nullopt;
}

ScenarioNoise read_noise_json(const std::filesystem::path& file) {
  const nlohmann::json document = parse_json_strictly(map::read_file(file), map::input_name(file));
  return noise_in(JsonNode(document, map::input_name(file)));
}

}  // namespace roadbed::tools::simulation
