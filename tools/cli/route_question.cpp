#include "roadbed/tools/cli/route_question.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "roadbed/map/files/input_error.h"
#include "roadbed/planning/route/route_options.h"

namespace roadbed::tools::inline cli {
namespace {

constexpr std::string_view kRoad = "road:", kPolygon = "polygon:", kLane = "lane:";

std::optional<geometry::Ring> ring_of(std::string_view text) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  for (;;) {
    double value = 0.0;
    const auto [rest, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !std::isfinite(value)) return {};
    numbers.push_back(value);
    if (rest == end) break;
    if (*rest != ',') return {};
    at = rest + 1;
  }
  if (numbers.size() % 2 != 0 || numbers.size() < 6) return {};
  geometry::Ring ring;
  for (std::size_t i = 0; i < numbers.size(); i += 2) ring.push_back({numbers[i], numbers[i + 1]});
  return ring;
}

std::vector<map::LaneId> lanes_of_road(const map::RoadMap& road_map, const std::string& text) {
  const std::string id = text.substr(kRoad.size());
  for (const map::Road& road : road_map.roads()) {
    if (road.source_id == id) return road.lanes;
  }
  throw map::InputError({.file = "--avoid \"" + text + "\"",
                         .found = "the map has no road " + id,
                         .remedy = "see the roads with: roadbed locate MAP --at X,Y"});
}

}  // namespace

std::string avoid_fault(const std::string& text) {
  if (text.starts_with(kLane)) return place_syntax_fault(text);
  if (text.starts_with(kRoad)) return text.size() == kRoad.size() ? "the road's id is missing" : "";
  if (!text.starts_with(kPolygon)) return "is not lane:NAME, road:ID or polygon:X,Y,X,Y,X,Y";
  return ring_of(std::string_view(text).substr(kPolygon.size()))
             ? ""
             : "the polygon is not three or more points X,Y,X,Y,X,Y";
}

std::vector<map::LaneId> closed_by(const map::RoadMap& road_map, const std::string& text) {
  if (text.starts_with(kRoad)) return lanes_of_road(road_map, text);
  if (text.starts_with(kLane)) return {find_place(road_map, text).on_lane.lane};
  geometry::Ring region = ring_of(std::string_view(text).substr(kPolygon.size())).value();
  for (Eigen::Vector2d& point : region) point = road_map.to_map(point);
  return planning::lanes_touching(road_map, region);
}

std::vector<Argument> RouteRules::declare_speeds(Arguments& arguments) {
  const Argument participant = arguments.choice("--participant", participant_,
                                                {{"car", map::Participant::car},
                                                 {"truck", map::Participant::truck},
                                                 {"bus", map::Participant::bus},
                                                 {"taxi", map::Participant::taxi},
                                                 {"motorcycle", map::Participant::motorcycle},
                                                 {"emergency", map::Participant::emergency},
                                                 {"bicycle", map::Participant::bicycle},
                                                 {"pedestrian", map::Participant::pedestrian},
                                                 {"tram", map::Participant::tram},
                                                 {"train", map::Participant::train}},
                                                "Who drives: lanes for others are left out");
  const Argument usual =
      arguments
          .add("--default-speed", default_speed_kmh_,
               "Where the map has no limit [km/h], else by lane type: 50, ramps 60")
          .within(1.0, 400.0);
  const Argument most =
      arguments.add("--max-speed", max_speed_kmh_, "Of the vehicle [km/h], else 130")
          .within(1.0, 400.0);
  const Argument lateral =
      arguments.add("--max-lateral", lateral_mps2_, "Lateral acceleration in bends [m/s²], else 2")
          .within(0.1, 100.0);
  return {participant, usual, most, lateral};
}

std::vector<Argument> RouteRules::declare_prices(Arguments& arguments) {
  std::vector<Argument> declared;
  const auto price = [&](const char* name, std::optional<double>& value, const char* help) {
    declared.push_back(
        arguments.add(name, value, std::string(help) + " [s, or m where distance counts]")
            .not_negative());
  };
  price("--lane-change-cost", lane_change_, "Price of a lane change, else 5 s or 50 m");
  price("--left-turn-cost", left_turn_, "Price of a left turn, else 0");
  price("--right-turn-cost", right_turn_, "Price of a right turn, else 0");
  price("--u-turn-cost", u_turn_, "Price of a U-turn, else 20 s or 200 m");
  price("--signal-cost", signal_, "Price of a traffic light, else 0");
  declared.push_back(arguments
                         .add("--least-lane-change", least_lane_change_m_,
                              "Length that a lane change needs [m], else 10")
                         .not_negative());
  return declared;
}

std::vector<Argument> RouteRules::declare(Arguments& arguments, bool with_cost) {
  const std::string outer = arguments.heading("Rules of the route");
  std::vector<Argument> declared{
      arguments
          .add("--avoid", avoid_,
               "What is closed: lane:NAME, road:ID or polygon:X,Y,X,Y,X,Y; may be given again")
          .checked(avoid_fault)};
  if (with_cost) {
    declared.push_back(arguments.choice(
        "--cost", cost_,
        {{"time", planning::RouteCost::time}, {"distance", planning::RouteCost::distance}},
        "What is to be least"));
  }
  for (const auto& part : {declare_speeds(arguments), declare_prices(arguments)}) {
    declared.insert(declared.end(), part.begin(), part.end());
  }
  arguments.heading(outer);
  return declared;
}

planning::RouteOptions RouteRules::on(const map::RoadMap& road_map,
                                      std::optional<planning::RouteCost> measure) const {
  planning::RouteOptions options;
  options.cost = measure.value_or(cost_);
  options.participant = participant_;
  if (default_speed_kmh_) options.default_speed_mps = *default_speed_kmh_ / 3.6;
  options.max_speed_mps = max_speed_kmh_ ? *max_speed_kmh_ / 3.6 : options.max_speed_mps;
  options.lateral_acceleration_mps2 = lateral_mps2_.value_or(options.lateral_acceleration_mps2);
  options.least_lane_change_m = least_lane_change_m_.value_or(options.least_lane_change_m);
  planning::ManoeuvrePrices& prices =
      options.cost == planning::RouteCost::time ? options.prices_s : options.prices_m;
  prices.lane_change = lane_change_.value_or(prices.lane_change);
  prices.left_turn = left_turn_.value_or(prices.left_turn);
  prices.right_turn = right_turn_.value_or(prices.right_turn);
  prices.u_turn = u_turn_.value_or(prices.u_turn);
  prices.signal = signal_.value_or(prices.signal);
  for (const std::string& text : avoid_) {
    const auto lanes = closed_by(road_map, text);
    options.avoid.insert(options.avoid.end(), lanes.begin(), lanes.end());
  }
  return options;
}

std::vector<Argument> RouteQuestion::declare(Arguments& arguments, bool with_batch) {
  const std::string syntax = kPlaceSyntax;
  Argument from = arguments.add("--from", from_, "Start: " + syntax).checked(place_syntax_fault);
  Argument to = arguments.add("--to", to_, "Goal, in the same way").checked(place_syntax_fault);
  if (!with_batch) {
    from.required();
    to.required();
  }
  arguments.add("--via", via_, "Place to pass on the way; may be given again, in order")
      .checked(place_syntax_fault);
  return rules_.declare(arguments);
}

std::vector<planning::RoutePlace> RouteQuestion::Asked::places() const {
  std::vector<planning::RoutePlace> places{from.for_route()};
  for (const Place& place : via) places.push_back(place.for_route());
  places.push_back(to.for_route());
  return places;
}

RouteQuestion::Asked RouteQuestion::on(const map::RoadMap& road_map) const {
  const map::Participant participant = rules_.participant();
  Asked asked{find_place(road_map, from_, participant),
              find_place(road_map, to_, participant),
              {},
              rules_.on(road_map)};
  for (const std::string& text : via_) {
    asked.via.push_back(find_place(road_map, text, participant));
  }
  return asked;
}

}  // namespace roadbed::tools::cli
