#include "roadbed/planning/route/route_network.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roadbed::planning::inline route {
namespace {

constexpr double kCorner_m = 0.05;

/// The corners of a lane's end, as seen in driving direction.
struct Gate {
  Eigen::Vector2d left{0, 0}, right{0, 0};
  std::uint32_t lane = 0;
  double strip = strip_of(left.x());  // of 1 m

  bool operator<(const Gate& other) const {
    return std::pair(strip, left.y()) < std::pair(other.strip, other.left.y());
  }
  static double strip_of(double x_m) { return std::floor(x_m); }
  bool meets(const Gate& other) const {
    return (left - other.left).norm() <= kCorner_m && (right - other.right).norm() <= kCorner_m;
  }
  bool is_open() const { return (left - right).norm() > 2.0 * kCorner_m; }
};

Turn mirrored(Turn turn) {
  if (turn == Turn::left) return Turn::right;
  return turn == Turn::right ? Turn::left : turn;
}

bool shared_users(const NetworkLane& one, const NetworkLane& other) {
  return (one.users.bits() & other.users.bits()) != 0;
}

map::Participants users_against(const map::Lane& lane) {
  map::Participants users;
  for (int kind = 0; kind <= static_cast<int>(map::Participant::train); ++kind) {
    const auto participant = static_cast<map::Participant>(kind);
    if (may_reverse(lane, participant)) users.add(participant);
  }
  return users;
}

class ContraflowLanes {
 public:
  ContraflowLanes(const map::RoadMap& road_map, const NetworkOptions& options,
                  RouteNetwork& network)
      : road_map_(road_map), options_(options), network_(network) {}

  void run() {
    add_twins();
    const std::size_t lanes = network_.lanes.size();
    if (lanes == road_map_.lanes().size()) return;
    next_.resize(lanes);
    mirror_links();
    join_gates();
    if (options_.against_traffic) copy_links();
    store_links();
    find_turns();
  }

 private:
  const map::Lane& lane_on_map(std::uint32_t lane) const {
    return road_map_.lane(network_.on_map(lane));
  }

  void add_twins() {
    for (const map::Lane& lane : road_map_.lanes()) {
      const map::Participants users = users_against(lane);
      if (users.empty()) continue;
      NetworkLane contraflow_twin = network_.lanes[lane.id.index];
      contraflow_twin.users = users;
      contraflow_twin.signal_s_m = -1.0;
      contraflow_twin.contraflow_twin = lane.id.index;
      std::swap(contraflow_twin.start_in_map, contraflow_twin.end_in_map);
      network_.lanes[lane.id.index].contraflow_twin =
          static_cast<std::uint32_t>(network_.lanes.size());
      network_.lanes.push_back(contraflow_twin);
      mirror_speeds(lane.id.index);
    }
  }

  void mirror_speeds(std::uint32_t lane) {
    CsrLists<SpeedPiece>& speeds = network_.speeds;
    const double length_m = network_.lanes[lane].length_m;
    for (std::size_t i = speeds.of(lane).size(); i > 0; --i) {
      SpeedPiece piece = speeds.of(lane)[i - 1];
      piece.to_s_m = length_m - (i > 1 ? speeds.of(lane)[i - 2].to_s_m : 0.0);
      speeds.items.push_back(piece);
    }
    speeds.end_list();
  }

  void mirror_links() {
    for (std::uint32_t lane = 0; lane < road_map_.lanes().size(); ++lane) {
      const auto links = network_.successors.of(lane);
      next_[lane].assign(links.begin(), links.end());
      const std::uint32_t contraflow_twin = network_.lanes[lane].contraflow_twin;
      if (contraflow_twin == kNoLane) continue;
      for (const map::LaneId before : road_map_.graph().of({lane}).predecessors) {
        const std::uint32_t reached = network_.lanes[before.index].contraflow_twin;
        if (reached != kNoLane &&
            shared_users(network_.lanes[contraflow_twin], network_.lanes[reached])) {
          next_[contraflow_twin].push_back(reached);
        }
      }
    }
  }

  Gate gate(std::uint32_t lane, bool at_end) const {
    const map::Lane& on_map = lane_on_map(lane);
    const bool reversed = network_.is_reversed(lane);
    const auto corner = [&](const map::LaneLine& line) {
      return at_end != reversed ? line.in_map.points().back() : line.in_map.points().front();
    };
    const Eigen::Vector2d left = corner(on_map.left), right = corner(on_map.right);
    return reversed ? Gate{right, left, lane} : Gate{left, right, lane};
  }

  // From lanes driven one way into such as are driven the other way.
  void join_gates() {
    std::vector<Gate> entries;
    for (std::uint32_t lane = 0; lane < network_.lanes.size(); ++lane) {
      if (!network_.lanes[lane].users.empty()) entries.push_back(gate(lane, false));
    }
    std::sort(entries.begin(), entries.end());
    for (std::uint32_t lane = 0; lane < network_.lanes.size(); ++lane) {
      const Gate exit = gate(lane, true);
      if (!exit.is_open()) continue;
      const double from_strip = Gate::strip_of(exit.left.x() - kCorner_m);
      const double to_strip = Gate::strip_of(exit.left.x() + kCorner_m);
      for (double strip = from_strip; strip <= to_strip; strip += 1.0) {
        join_in_strip(entries, exit, strip);
      }
    }
  }

  void join_in_strip(const std::vector<Gate>& entries, const Gate& exit, double strip) {
    Gate first = exit;
    first.strip = strip;
    first.left.y() = exit.left.y() - kCorner_m;
    for (auto at = std::lower_bound(entries.begin(), entries.end(), first);
         at != entries.end() && at->strip == strip && at->left.y() <= exit.left.y() + kCorner_m;
         ++at) {
      if (may_join(exit, *at)) next_[exit.lane].push_back(at->lane);
    }
  }

  bool may_join(const Gate& exit, const Gate& entry) const {
    return network_.is_reversed(exit.lane) != network_.is_reversed(entry.lane) &&
           network_.on_map(exit.lane) != network_.on_map(entry.lane) && exit.meets(entry) &&
           shared_users(network_.lanes[exit.lane], network_.lanes[entry.lane]);
  }

  // Where everything may be driven both ways, so may these.
  void copy_links() {
    for (std::uint32_t lane = 0; lane < next_.size(); ++lane) {
      if (!network_.is_reversed(lane)) continue;
      const auto& own = next_[network_.lanes[lane].contraflow_twin];
      next_[lane].insert(next_[lane].end(), own.begin(), own.end());
    }
  }

  void store_links() {
    network_.successors = {};
    for (auto& links : next_) {
      std::sort(links.begin(), links.end());
      links.erase(std::unique(links.begin(), links.end()), links.end());
      network_.successors.items.insert(network_.successors.items.end(), links.begin(), links.end());
      network_.successors.end_list();
    }
  }

  // A lane's own turn stands where its own links leave a choice; reversed ones may add one.
  void find_turns() {
    std::vector<bool> has_choice(network_.lanes.size(), false);
    for (const auto& links : next_) {
      if (links.size() < 2) continue;
      for (const std::uint32_t next : links) has_choice[next] = true;
    }
    for (std::uint32_t lane = 0; lane < network_.lanes.size(); ++lane) {
      const map::Lane& on_map = lane_on_map(lane);
      Turn& turn = network_.lanes[lane].turn;
      const bool counts = has_choice[lane] || on_map.junction;
      if (network_.is_reversed(lane)) turn = counts ? mirrored(bend_of(on_map)) : Turn::none;
      if (!network_.is_reversed(lane) && counts && turn == Turn::none) turn = bend_of(on_map);
    }
  }

  const map::RoadMap& road_map_;
  const NetworkOptions& options_;
  RouteNetwork& network_;
  std::vector<std::vector<std::uint32_t>> next_;
};

class Neighbours {
 public:
  Neighbours(const map::RoadMap& road_map, const NetworkOptions& options, RouteNetwork& network)
      : road_map_(road_map), options_(options), network_(network) {}

  void run() {
    for (std::uint32_t lane = 0; lane < network_.lanes.size(); ++lane) find_neighbours(lane);
  }

 private:
  void find_neighbours(std::uint32_t lane) {
    const map::LaneLinks& links = road_map_.graph().of(network_.on_map(lane));
    const bool reversed = network_.is_reversed(lane);
    NetworkLane& made = network_.lanes[lane];
    made.left = neighbour(lane, reversed ? links.right : links.left, network_.left_windows);
    made.right = neighbour(lane, reversed ? links.left : links.right, network_.right_windows);
  }

  std::uint32_t neighbour(std::uint32_t lane, const std::optional<map::Neighbour>& beside,
                          CsrLists<map::StationRange>& windows) const {
    const std::uint32_t found = lane_beside(lane, beside);
    if (found != kNoLane) add_windows(lane, *beside, windows);
    windows.end_list();
    return found;
  }

  // Of a lane in its own direction the map's neighbour stays, whoever may use it.
  std::uint32_t lane_beside(std::uint32_t lane, const std::optional<map::Neighbour>& beside) const {
    if (!beside || !(beside->change_allowed() || options_.across_markings)) return kNoLane;
    const bool reversed = network_.is_reversed(lane);
    const bool other_reversed = beside->same_direction == reversed;
    const std::uint32_t other = network_.lane_of(beside->lane, other_reversed);
    if (other == kNoLane) return kNoLane;
    const bool as_on_map = !reversed && !other_reversed;
    return as_on_map || shared_users(network_.lanes[lane], network_.lanes[other]) ? other : kNoLane;
  }

  void add_windows(std::uint32_t lane, const map::Neighbour& beside,
                   CsrLists<map::StationRange>& windows) const {
    const double length_m = network_.lanes[lane].length_m;
    if (options_.across_markings) {
      windows.items.push_back({0.0, length_m});
      return;
    }
    const std::size_t first = windows.items.size();
    for (const map::StationRange& window : beside.change_windows) {
      windows.items.push_back(network_.is_reversed(lane)
                                  ? map::StationRange{std::max(0.0, length_m - window.to_s_m),
                                                      length_m - window.from_s_m}
                                  : window);
    }
    if (network_.is_reversed(lane)) {
      std::reverse(windows.items.begin() + static_cast<std::ptrdiff_t>(first), windows.items.end());
    }
  }

  const map::RoadMap& road_map_;
  const NetworkOptions& options_;
  RouteNetwork& network_;
};

}  // namespace

void add_contraflow_lanes(const map::RoadMap& road_map, const NetworkOptions& options,
                          RouteNetwork& network) {
  ContraflowLanes(road_map, options, network).run();
}

void add_neighbours(const map::RoadMap& road_map, const NetworkOptions& options,
                    RouteNetwork& network) {
  Neighbours(road_map, options, network).run();
}

}  // namespace roadbed::planning::route
