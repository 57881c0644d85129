#include "roadbed/planning/route/no_route_explanation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <utility>

#include "roadbed/geometry/index/point_index.h"
#include "roadbed/planning/route/route_network.h"
#include "roadbed/planning/route/route_solver.h"

namespace roadbed::planning::inline route {
namespace {

using map::LaneId;

// Least natural first: the first ones are tried to do without.
constexpr std::array kRules = {BlockingRule::one_way, BlockingRule::participant,
                               BlockingRule::marking, BlockingRule::length, BlockingRule::closed};

bool holds(const std::vector<BlockingRule>& rules, BlockingRule rule) {
  return std::find(rules.begin(), rules.end(), rule) != rules.end();
}

void find_gap(const RouteNetwork& network, const std::vector<std::uint32_t>& from_start,
              const std::vector<std::uint32_t>& to_goal, NoRouteExplanation& explanation) {
  std::vector<Eigen::Vector2d> starts;
  for (const std::uint32_t lane : to_goal) starts.push_back(network.lanes[lane].start_in_map);
  const geometry::PointIndex index(starts);
  explanation.gap_m = std::numeric_limits<double>::infinity();
  for (const std::uint32_t lane : from_start) {
    const auto nearest = index.nearest(network.lanes[lane].end_in_map);
    if (!nearest || nearest->distance_m >= explanation.gap_m) continue;
    explanation.gap_m = nearest->distance_m;
    explanation.gap_from = network.on_map(lane);
    explanation.gap_to = network.on_map(to_goal[nearest->index]);
  }
}

// The last lane of the way that can be reached with all rules, and the one behind it.
void find_block(const RouteNetwork& network, const Way& way,
                const std::vector<std::uint32_t>& from_start, NoRouteExplanation& explanation) {
  std::optional<LaneId> before;
  for (const LaneGroup& lane_group : way.lane_groups) {
    for (const std::uint32_t lane : lane_group.chain) {
      const bool reached = std::binary_search(from_start.begin(), from_start.end(), lane);
      if (reached) before = network.on_map(lane);
      if (reached || explanation.blocked_to) continue;
      explanation.blocked_from = before;
      explanation.blocked_to = network.on_map(lane);
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

std::string words(BlockingRule rule) {
  switch (rule) {
    case BlockingRule::closed:
      return "closed lanes";
    case BlockingRule::length:
      return "lanes too short for the lane changes that it takes";
    case BlockingRule::marking:
      return "markings that may not be crossed";
    case BlockingRule::participant:
      return "lanes of other road users";
    case BlockingRule::one_way:
      return "lanes of the other direction";
    case BlockingRule::map_gap:
      return "a gap of the map";
  }
  return "";
}

std::string cause(const map::RoadMap& road_map, const NoRouteExplanation& explanation) {
  std::string text;
  for (const BlockingRule rule : explanation.blocking_rules) {
    text += (text.empty() ? "; between them stand " : " and ") + words(rule);
  }
  if (explanation.blocking_rules == std::vector{BlockingRule::map_gap}) {
    text = "; nothing in the map connects them, whatever the rules";
  }
  if (explanation.blocked_from && explanation.blocked_to) {
    text += fmt::format(", first from lane {} to lane {}",
                        road_map.lane(*explanation.blocked_from).name,
                        road_map.lane(*explanation.blocked_to).name);
  }
  return text;
}

}  // namespace

std::string_view to_string(BlockingRule rule) {
  switch (rule) {
    case BlockingRule::closed:
      return "closed";
    case BlockingRule::length:
      return "lane_change_length";
    case BlockingRule::marking:
      return "marking";
    case BlockingRule::participant:
      return "participant";
    case BlockingRule::one_way:
      return "one_way";
    case BlockingRule::map_gap:
      return "map_gap";
  }
  return "";
}

/// Solvers by the rules that they leave out, made when they are first needed.
struct NoRouteExplainer::Solvers {
  const map::RoadMap& road_map;
  RouteSolver strict;
  std::map<std::vector<BlockingRule>, std::unique_ptr<RouteSolver>> lenient;
  std::map<std::pair<bool, bool>, std::shared_ptr<const RouteNetwork>> networks;

  Solvers(const map::RoadMap& of, const RouteSolver& solver)
      : road_map(of), strict(solver, solver.options()) {}

  std::optional<Way> way_without(const std::vector<BlockingRule>& rules, const RoutePlace& from,
                                 const RoutePlace& to) {
    std::unique_ptr<RouteSolver>& solver = lenient[rules];
    if (!solver) solver = make(rules);
    return solver->solve(from, to);
  }

 private:
  std::unique_ptr<RouteSolver> make(const std::vector<BlockingRule>& rules) {
    const RelaxedRules relaxed{.closed_lanes = holds(rules, BlockingRule::closed),
                               .participants = holds(rules, BlockingRule::participant),
                               .length = holds(rules, BlockingRule::length)};
    const NetworkOptions options{.across_markings = holds(rules, BlockingRule::marking),
                                 .against_traffic = holds(rules, BlockingRule::one_way)};
    if (!options.across_markings && !options.against_traffic) {
      return std::make_unique<RouteSolver>(strict, strict.options(), relaxed);
    }
    auto& network = networks[{options.across_markings, options.against_traffic}];
    if (!network) {
      network = std::make_shared<const RouteNetwork>(make_route_network(road_map, options));
    }
    return std::make_unique<RouteSolver>(network, strict.options(), relaxed);
  }
};

NoRouteExplainer::NoRouteExplainer(const map::RoadMap& road_map, const RouteSolver& solver)
    : solvers_(std::make_unique<Solvers>(road_map, solver)) {}

NoRouteExplainer::~NoRouteExplainer() = default;
NoRouteExplainer::NoRouteExplainer(NoRouteExplainer&&) noexcept = default;

NoRouteExplanation NoRouteExplainer::find(const RoutePlace& from, const RoutePlace& to) {
  NoRouteExplanation explanation;
  RouteSolver& strict = solvers_->strict;
  const auto from_start = strict.lanes_from(from), to_goal = strict.lanes_to(to);
  explanation.lanes_from_start = count_on_map(strict.network(), from_start);
  explanation.lanes_to_goal = count_on_map(strict.network(), to_goal);
  find_gap(strict.network(), from_start, to_goal, explanation);
  std::vector<BlockingRule> left_out(kRules.begin(), kRules.end());
  std::optional<Way> way = solvers_->way_without(left_out, from, to);
  if (!way) {
    explanation.blocking_rules = {BlockingRule::map_gap};
    return explanation;
  }
  for (const BlockingRule rule : kRules) {
    std::vector<BlockingRule> fewer = left_out;
    std::erase(fewer, rule);
    std::optional<Way> other = solvers_->way_without(fewer, from, to);
    if (!other) continue;
    left_out = fewer;
    way = std::move(other);
  }
  explanation.blocking_rules = left_out;
  find_block(strict.network(), *way, from_start, explanation);
  return explanation;
}

std::string describe(const map::RoadMap& road_map, const map::LanePlace& from,
                     const map::LanePlace& to, const NoRouteExplanation& explanation) {
  std::string text = fmt::format(
      "no lane sequence leads from lane {} to lane {}: {} lanes can be reached from the start, the "
      "goal from {}",
      road_map.lane(from.lane).name, road_map.lane(to.lane).name, explanation.lanes_from_start,
      explanation.lanes_to_goal);
  if (explanation.gap_from && explanation.gap_from == explanation.gap_to) {
    text += fmt::format("; lane {} is reached one way and leads on the other way",
                        road_map.lane(*explanation.gap_from).name);
  } else if (explanation.gap_from && explanation.gap_to) {
    text += fmt::format("; they come nearest where lane {} ends {:.2f} m from the start of lane {}",
                        road_map.lane(*explanation.gap_from).name, explanation.gap_m,
                        road_map.lane(*explanation.gap_to).name);
  }
  return text + cause(road_map, explanation);
}

}  // namespace roadbed::planning::route
