#include "roadbed/planning/route/route_obstacle.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <utility>

#include "roadbed/geometry/index/point_index.h"

namespace roadbed::planning::inline route {
namespace {

using map::LaneId;

// Least natural first: the first ones are tried to do without.
constexpr std::array kRules = {Barrier::one_way, Barrier::participant, Barrier::marking,
                               Barrier::length, Barrier::closed};

bool holds(const std::vector<Barrier>& rules, Barrier rule) {
  return std::find(rules.begin(), rules.end(), rule) != rules.end();
}

void find_gap(const RouteNetwork& network, const std::vector<std::uint32_t>& from_start,
              const std::vector<std::uint32_t>& to_goal, RouteObstacle& obstacle) {
  std::vector<Eigen::Vector2d> starts;
  for (const std::uint32_t lane : to_goal) starts.push_back(network.lanes[lane].start_in_map);
  const geometry::PointIndex index(std::move(starts));
  obstacle.gap_m = std::numeric_limits<double>::infinity();
  for (const std::uint32_t lane : from_start) {
    const auto nearest = index.nearest(network.lanes[lane].end_in_map);
    if (!nearest || nearest->distance_m >= obstacle.gap_m) continue;
    obstacle.gap_m = nearest->distance_m;
    obstacle.gap_from = network.on_map(lane);
    obstacle.gap_to = network.on_map(to_goal[nearest->index]);
  }
}

// The last lane of the way that can be reached with all rules, and the one behind it.
void find_block(const RouteNetwork& network, const Way& way,
                const std::vector<std::uint32_t>& from_start, RouteObstacle& obstacle) {
  std::optional<LaneId> before;
  for (const Passage& passage : way.passages) {
    for (const std::uint32_t lane : passage.chain) {
      const bool reached = std::binary_search(from_start.begin(), from_start.end(), lane);
      if (reached) before = network.on_map(lane);
      if (reached || obstacle.blocked_to) continue;
      obstacle.blocked_from = before;
      obstacle.blocked_to = network.on_map(lane);
    }
  }
}

// Lanes of the map: driven both ways they count once.
std::size_t count_on_map(const RouteNetwork& network, const std::vector<std::uint32_t>& lanes) {
  std::vector<LaneId> on_map;
  for (const std::uint32_t lane : lanes) on_map.push_back(network.on_map(lane));
  std::sort(on_map.begin(), on_map.end());
  return static_cast<std::size_t>(std::unique(on_map.begin(), on_map.end()) - on_map.begin());
}

std::string words(Barrier barrier) {
  switch (barrier) {
    case Barrier::closed:
      return "closed lanes";
    case Barrier::length:
      return "lanes too short for the lane changes that it takes";
    case Barrier::marking:
      return "markings that may not be crossed";
    case Barrier::participant:
      return "lanes of other road users";
    case Barrier::one_way:
      return "lanes of the other direction";
    case Barrier::map_gap:
      return "a gap of the map";
  }
  return "";
}

std::string cause(const map::RoadMap& road_map, const RouteObstacle& obstacle) {
  std::string text;
  for (const Barrier barrier : obstacle.barriers) {
    text += (text.empty() ? "; between them stand " : " and ") + words(barrier);
  }
  if (obstacle.barriers == std::vector{Barrier::map_gap}) {
    text = "; nothing in the map connects them, whatever the rules";
  }
  if (obstacle.blocked_from && obstacle.blocked_to) {
    text +=
        fmt::format(", first from lane {} to lane {}", road_map.lane(*obstacle.blocked_from).name,
                    road_map.lane(*obstacle.blocked_to).name);
  }
  return text;
}

}  // namespace

std::string_view name(Barrier barrier) {
  switch (barrier) {
    case Barrier::closed:
      return "closed";
    case Barrier::length:
      return "lane_change_length";
    case Barrier::marking:
      return "marking";
    case Barrier::participant:
      return "participant";
    case Barrier::one_way:
      return "one_way";
    case Barrier::map_gap:
      return "map_gap";
  }
  return "";
}

/// Solvers by the rules that they leave out, made when they are first needed.
struct ObstacleFinder::Solvers {
  const map::RoadMap& road_map;
  RouteSolver strict;
  std::map<std::vector<Barrier>, std::unique_ptr<RouteSolver>> lenient;
  std::map<std::pair<bool, bool>, std::shared_ptr<const RouteNetwork>> networks;

  Solvers(const map::RoadMap& of, const RouteSolver& solver)
      : road_map(of), strict(solver, solver.options()) {}

  std::optional<Way> way_without(const std::vector<Barrier>& rules, const RoutePlace& from,
                                 const RoutePlace& to) {
    std::unique_ptr<RouteSolver>& solver = lenient[rules];
    if (!solver) solver = make(rules);
    return solver->solve(from, to);
  }

 private:
  std::unique_ptr<RouteSolver> make(const std::vector<Barrier>& rules) {
    const Leniency leniency{.closed_lanes = holds(rules, Barrier::closed),
                            .participants = holds(rules, Barrier::participant),
                            .length = holds(rules, Barrier::length)};
    const NetworkOptions options{.across_markings = holds(rules, Barrier::marking),
                                 .against_traffic = holds(rules, Barrier::one_way)};
    if (!options.across_markings && !options.against_traffic) {
      return std::make_unique<RouteSolver>(strict, strict.options(), leniency);
    }
    auto& network = networks[{options.across_markings, options.against_traffic}];
    if (!network) {
      network = std::make_shared<const RouteNetwork>(make_route_network(road_map, options));
    }
    return std::make_unique<RouteSolver>(network, strict.options(), leniency);
  }
};

ObstacleFinder::ObstacleFinder(const map::RoadMap& road_map, const RouteSolver& solver)
    : solvers_(std::make_unique<Solvers>(road_map, solver)) {}

ObstacleFinder::~ObstacleFinder() = default;
ObstacleFinder::ObstacleFinder(ObstacleFinder&&) noexcept = default;

RouteObstacle ObstacleFinder::find(const RoutePlace& from, const RoutePlace& to) {
  RouteObstacle obstacle;
  RouteSolver& strict = solvers_->strict;
  const auto from_start = strict.lanes_from(from), to_goal = strict.lanes_to(to);
  obstacle.lanes_from_start = count_on_map(strict.network(), from_start);
  obstacle.lanes_to_goal = count_on_map(strict.network(), to_goal);
  find_gap(strict.network(), from_start, to_goal, obstacle);
  std::vector<Barrier> left_out(kRules.begin(), kRules.end());
  std::optional<Way> way = solvers_->way_without(left_out, from, to);
  if (!way) {
    obstacle.barriers = {Barrier::map_gap};
    return obstacle;
  }
  for (const Barrier rule : kRules) {
    std::vector<Barrier> fewer = left_out;
    std::erase(fewer, rule);
    std::optional<Way> other = solvers_->way_without(fewer, from, to);
    if (!other) continue;
    left_out = fewer;
    way = std::move(other);
  }
  obstacle.barriers = left_out;
  find_block(strict.network(), *way, from_start, obstacle);
  return obstacle;
}

std::string describe(const map::RoadMap& road_map, const map::LanePlace& from,
                     const map::LanePlace& to, const RouteObstacle& obstacle) {
  std::string text = fmt::format(
      "no lane sequence leads from lane {} to lane {}: {} lanes can be reached from the start, the "
      "goal from {}",
      road_map.lane(from.lane).name, road_map.lane(to.lane).name, obstacle.lanes_from_start,
      obstacle.lanes_to_goal);
  if (obstacle.gap_from && obstacle.gap_from == obstacle.gap_to) {
    text += fmt::format("; lane {} is reached one way and leads on the other way",
                        road_map.lane(*obstacle.gap_from).name);
  } else if (obstacle.gap_from && obstacle.gap_to) {
    text += fmt::format("; they come nearest where lane {} ends {:.2f} m from the start of lane {}",
                        road_map.lane(*obstacle.gap_from).name, obstacle.gap_m,
                        road_map.lane(*obstacle.gap_to).name);
  }
  return text + cause(road_map, obstacle);
}

}  // namespace roadbed::planning::route
