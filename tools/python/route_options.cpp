#include <fmt/format.h>

#include <map>
#include <stdexcept>

#include "roadbed/tools/cli/route_question.h"
#include "roadbed/tools/python/routes.h"

namespace roadbed::tools::inline python {
namespace {

map::Participant participant_of(const std::string& name) {
  for (int i = 0; i <= static_cast<int>(map::Participant::train); ++i) {
    const auto kind = static_cast<map::Participant>(i);
    if (planning::to_string(kind) == name) return kind;
  }
  throw std::invalid_argument(
      fmt::format("participant: \"{}\", needs car, truck, bus, taxi, motorcycle, emergency, "
                  "bicycle, pedestrian, tram or train",
                  name));
}

planning::RouteCost cost_of(const std::string& name) {
  if (name == "time") return planning::RouteCost::time;
  if (name == "distance") return planning::RouteCost::distance;
  throw std::invalid_argument(fmt::format("cost: \"{}\", needs time or distance", name));
}

std::vector<map::LaneId> avoided(const map::RoadMap& road_map,
                                 const std::vector<std::string>& texts) {
  std::vector<map::LaneId> lanes;
  for (const std::string& text : texts) {
    const std::string fault = avoid_fault(text);
    if (!fault.empty()) throw std::invalid_argument(fmt::format("avoid: \"{}\" {}", text, fault));
    const std::vector<map::LaneId> closed = closed_by(road_map, text);
    lanes.insert(lanes.end(), closed.begin(), closed.end());
  }
  return lanes;
}

double not_negative(const std::string& name, nb::handle value) {
  const double number = nb::cast<double>(value);
  if (number >= 0.0) return number;
  throw std::invalid_argument(fmt::format("{}: {}, needs 0 or more", name, number));
}

double positive(const std::string& name, nb::handle value) {
  const double number = nb::cast<double>(value);
  if (number > 0.0) return number;
  throw std::invalid_argument(fmt::format("{}: {}, needs more than 0", name, number));
}

}  // namespace

planning::RouteOptions route_options(const map::RoadMap& road_map, const nb::kwargs& given) {
  planning::RouteOptions options;
  if (given.contains("cost")) options.cost = cost_of(nb::cast<std::string>(given["cost"]));
  planning::ManoeuvrePrices& prices =
      options.cost == planning::RouteCost::time ? options.prices_s : options.prices_m;
  const std::map<std::string, double*> price_of = {
      {"lane_change_cost", &prices.lane_change},
      {"left_turn_cost", &prices.left_turn},
      {"right_turn_cost", &prices.right_turn},
      {"u_turn_cost", &prices.u_turn},
      {"signal_cost", &prices.signal},
      {"least_lane_change_m", &options.least_lane_change_m}};
  for (const auto [key, value] : given) {
    const auto name = nb::cast<std::string>(key);
    if (const auto price = price_of.find(name); price != price_of.end()) {
      *price->second = not_negative(name, value);
    } else if (name == "participant") {
      options.participant = participant_of(nb::cast<std::string>(value));
    } else if (name == "avoid") {
      options.avoid = avoided(road_map, nb::cast<std::vector<std::string>>(value));
    } else if (name == "default_speed_mps") {
      options.default_speed_mps = positive(name, value);
    } else if (name == "max_speed_mps") {
      options.max_speed_mps = positive(name, value);
    } else if (name == "lateral_acceleration_mps2") {
      options.lateral_acceleration_mps2 = positive(name, value);
    } else if (name != "cost") {
      throw nb::type_error(fmt::format("there is no option of routes \"{}\"", name).c_str());
    }
  }
  return options;
}

}  // namespace roadbed::tools::python
