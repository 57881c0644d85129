#include "roadbed/tools/simulation/pilot_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <istream>
#include <ostream>
#include <set>
#include <stdexcept>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/tools/simulation/cycle_log.h"
#include "roadbed/tools/simulation/scenario.h"

namespace roadbed::tools::inline simulation {
namespace {

constexpr double kFarthest_m = 1e9;
constexpr Range kPlace{-kFarthest_m, kFarthest_m}, kAnyAngle{-1e3, 1e3}, kAnySpeed{-100.0, 150.0},
    kOwnSpeed{-1.0, 150.0}, kAcceleration{-50.0, 50.0}, kSteering{-1.6, 1.6},
    kBodySize{0.05, 100.0}, kAnyTime{-1e9, 1e9};
constexpr std::size_t kMostObjects = 10'000;

geometry::Pose2 pose_in(const map::RoadMap& road_map, const JsonNode& node) {
  const Eigen::Vector2d place =
      road_map.to_map({node.at("x_m").number(kPlace), node.at("y_m").number(kPlace)});
  return {place.x(), place.y(), node.at("heading_rad").number(kAnyAngle)};
}

planning::VehicleState ego_in(const map::RoadMap& road_map, const JsonNode& node) {
  node.require_object({"x_m", "y_m", "heading_rad", "speed_mps", "acceleration_mps2",
                       "steering_rad", "s_m", "d_m"});
  return {.map_from_vehicle = pose_in(road_map, node),
          .speed_mps = std::max(0.0, node.at("speed_mps").number(kOwnSpeed)),
          .steering_rad = node.number_or("steering_rad", 0.0, kSteering),
          .acceleration_mps2 = node.number_or("acceleration_mps2", 0.0, kAcceleration)};
}

planning::Detection object_in(const map::RoadMap& road_map, const JsonNode& node) {
  node.require_object(
      {"id", "kind", "x_m", "y_m", "heading_rad", "speed_mps", "length_m", "width_m"});
  const planning::Detection usual;
  const auto id = node.find("id");
  const auto kind = node.find("kind");
  return {.id = id ? id->name() : "",
          .kind = kind ? kind->name() : usual.kind,
          .length_m = node.number_or("length_m", usual.length_m, kBodySize),
          .width_m = node.number_or("width_m", usual.width_m, kBodySize),
          .centre = pose_in(road_map, node),
          .speed_mps = node.at("speed_mps").number(kAnySpeed)};
}

std::vector<planning::Detection> objects_in(const map::RoadMap& road_map, const JsonNode& list) {
  const std::vector<JsonNode> elements = list.elements();
  if (elements.size() > kMostObjects) {
    list.refuse(fmt::format("has {} objects", elements.size()),
                fmt::format("{} at most", kMostObjects), "leave out those far away");
  }
  std::vector<planning::Detection> objects;
  std::set<std::string> ids;
  for (const JsonNode& element : elements) {
    objects.push_back(object_in(road_map, element));
    const std::string& id = objects.back().id;
    if (id.empty() || ids.insert(id).second) continue;
    element.at("id").refuse(fmt::format("is \"{}\" again", id), "an id of its own",
                            "name each object once");
  }
  return objects;
}

planning::SeenLight light_in(const map::RoadMap& road_map, const JsonNode& node) {
  node.require_object({"signal", "colour"});
  const JsonNode signal = node.at("signal");
  planning::SeenLight light{signal.one_line(), light_colour_in(node.at("colour"))};
  const bool is_known = std::ranges::any_of(road_map.signals(), [&](const map::Signal& known) {
    return known.source_id == light.signal;
  });
  if (!is_known) {
    signal.refuse(fmt::format("is \"{}\", which is not in the map", light.signal),
                  "the source id of one of the map's signals", "leave it out");
  }
  return light;
}

double rounded(double value) { return std::round(value * 1e6) / 1e6 + 0.0; }

Json trajectory_json(const map::RoadMap& road_map, const geometry::Trajectory& trajectory) {
  Json rows = Json::array();
  for (const geometry::TrajectoryPoint& row : trajectory.points()) {
    const Eigen::Vector2d place = road_map.to_source({row.x_m, row.y_m});
    rows.push_back({rounded(row.t_s), rounded(place.x()), rounded(place.y()),
                    rounded(row.heading_rad), rounded(row.speed_mps),
                    rounded(row.acceleration_mps2), rounded(row.steering_rad),
                    rounded(row.curvature_per_m)});
  }
  return rows;
}

Json motions_json(const map::RoadMap& road_map,
                  const std::vector<planning::ForecastMotion>& motions) {
  Json list = Json::array();
  for (const planning::ForecastMotion& motion : motions) {
    Json lanes = Json::array();
    for (const map::LaneId lane : motion.lanes) lanes.push_back(road_map.lane(lane).name);
    list.push_back({{"probability", rounded(motion.probability)}, {"lanes", std::move(lanes)}});
  }
  return list;
}

Json objects_json(const map::RoadMap& road_map, const planning::Pilot& pilot) {
  Json list = Json::array();
  const auto slots = pilot.others().tracker().slots();
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (!slots[i]) continue;
    const planning::SeenMotion now = slots[i]->filter.state();
    const Eigen::Vector2d place = road_map.to_source(now.pose.position());
    Json object = {{"id", slots[i]->id},
                   {"kind", slots[i]->kind},
                   {"x_m", rounded(place.x())},
                   {"y_m", rounded(place.y())},
                   {"heading_rad", rounded(now.pose.heading_rad)},
                   {"speed_mps", rounded(now.speed_mps)},
                   {"acceleration_mps2", rounded(now.acceleration_mps2)},
                   {"position_deviation_m", rounded(slots[i]->filter.position_deviation_m())},
                   {"last_measured_s", rounded(slots[i]->last_measured_s)},
                   {"motions", motions_json(road_map, pilot.others().forecasts()[i])}};
    list.push_back(std::move(object));
  }
  return list;
}

/// The next line; of one that is too long only so much is kept.
/// @returns whether there is one.
bool read_line(std::istream& in, std::size_t most_bytes, std::string& line) {
  line.clear();
  std::streambuf& bytes = *in.rdbuf();
  for (int byte = bytes.sbumpc(); byte != std::char_traits<char>::eof(); byte = bytes.sbumpc()) {
    if (byte == '\n') return true;
    if (line.size() <= most_bytes) line.push_back(static_cast<char>(byte));
  }
  return !line.empty();
}

}  // namespace

planning::PilotView parse_pilot_view(const map::RoadMap& road_map, std::string_view line,
                                     const std::string& name) {
  const nlohmann::json document = parse_json_strictly(line, name);
  const JsonNode root(document, name);
  root.require_object({"t_s", "ego", "obstacles", "lights", "scene"});
  planning::PilotView view{.t_s = root.at("t_s").number(kAnyTime),
                           .ego = ego_in(road_map, root.at("ego")),
                           .objects = {},
                           .has_objects = false,
                           .lights = {}};
  if (const auto objects = root.find("obstacles")) {
    view.objects = objects_in(road_map, *objects);
    view.has_objects = true;
  }
  if (const auto lights = root.find("lights")) {
    for (const JsonNode& light : lights->elements()) {
      view.lights.push_back(light_in(road_map, light));
    }
  }
  return view;
}

std::string pilot_answer_line(const map::RoadMap& road_map, double t_s,
                              const planning::PilotAnswer& answer, const planning::Pilot* pilot) {
  Json json = {{"t_s", t_s},
               {"behaviour", planning::to_string(answer.decision.behaviour)},
               {"reason", answer.decision.reason},
               {"at_goal", answer.is_at_goal},
               {"command",
                {{"acceleration_mps2", rounded(answer.acceleration_mps2)},
                 {"steering_rad", rounded(answer.steering_rad)}}},
               {"lead", lead_json(answer.decision.lead)},
               {"hypotheses", hypotheses_json(answer.decision.hypotheses)},
               {"trajectory", trajectory_json(road_map, answer.trajectory)}};
  if (pilot != nullptr) json["tracks"] = objects_json(road_map, *pilot);
  return map::json_text(json);
}

std::string pilot_refusal_line(const std::string& fault) {
  return map::json_text(Json{
      {"error", fault}, {"reason", "a line could not be used: " + fault}, {"trajectory", nullptr}});
}

std::size_t answer_lines(planning::Pilot& pilot, const map::RoadMap& road_map, std::istream& in,
                         std::ostream& out, const PilotLineOptions& options) {
  std::size_t refused = 0;
  std::string line;
  std::optional<double> last_s;
  const auto answer = [&](const std::string& name) {
    if (line.size() > options.most_bytes) {
      throw map::InputError({.file = name,
                             .found = fmt::format("more than {} bytes", options.most_bytes),
                             .needed = "one observation",
                             .remedy = "leave out objects far away"});
    }
    const planning::PilotView view = parse_pilot_view(road_map, line, name);
    if (last_s && !(view.t_s > *last_s)) {
      throw map::InputError({.file = name,
                             .place = "/t_s",
                             .found = fmt::format("{} s after {} s", view.t_s, *last_s),
                             .needed = "times that increase",
                             .remedy = "start another pilot for another drive"});
    }
    last_s = view.t_s;
    const planning::PilotAnswer decided = pilot.step(view);
    return pilot_answer_line(road_map, view.t_s, decided, options.tells_objects ? &pilot : nullptr);
  };
  for (std::size_t number = 1; read_line(in, options.most_bytes, line); ++number) {
    try {
      out << answer(fmt::format("line {}", number)) << '\n' << std::flush;
    } catch (const map::InputError& error) {
      ++refused;
      out << pilot_refusal_line(error.what()) << '\n' << std::flush;
    }
    if (!out) break;
  }
  return refused;
}

}  // namespace roadbed::tools::simulation
