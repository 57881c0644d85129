#include "roadbed/planning/route/route_network.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <type_traits>

#include "roadbed/map/elements/byte_io.h"
#include "roadbed/map/index/road_map_index.h"

namespace roadbed::planning::inline route {
namespace {

constexpr std::uint32_t kVersion = 3;
constexpr auto kLastTurn = static_cast<std::uint8_t>(Turn::u_turn);

// What a network is made of, said once for writing and reading, as in map/elements/map_fields.h.

constexpr auto field = [](auto& io, auto& value) { io(value); };

constexpr auto range = [](auto& io, auto& item) {
  io(item.from_s_m);
  io(item.to_s_m);
  io.check(std::isfinite(item.from_s_m) && std::isfinite(item.to_s_m));
};

constexpr auto speed_piece = [](auto& io, auto& item) {
  io(item.to_s_m);
  io(item.limit_mps);
  io(item.curvature_per_m);
  io.check(std::isfinite(item.to_s_m) && item.limit_mps >= 0.0 && item.curvature_per_m >= 0.0);
};

constexpr auto network_lane = []<typename Io, typename Lane>(Io& io, Lane& lane) {
  std::uint16_t users = lane.users.bits();
  auto turn = static_cast<std::uint8_t>(lane.turn);
  io(lane.length_m);
  io.point(lane.start_in_map);
  io.point(lane.end_in_map);
  io(users);
  io(lane.type);
  io(turn);
  io(lane.signal_s_m);
  io(lane.left);
  io(lane.right);
  io(lane.contraflow_twin);
  io.check(lane.length_m >= 0.0 && std::isfinite(lane.length_m) && turn <= kLastTurn &&
           std::isfinite(lane.signal_s_m));
  if constexpr (!std::is_const_v<Lane>) {
    lane.users = map::Participants::from_bits(users);
    lane.turn = static_cast<Turn>(turn);
  }
};

template <typename Io, typename Groups, typename Each>
void groups(Io& io, Groups& grouped, std::size_t count, const Each& each) {
  if constexpr (!std::is_const_v<Groups>) grouped.first.clear();
  io.list(grouped.first, field);
  io.list(grouped.items, each);
  io.check(grouped.first.size() == count + 1 && grouped.first.front() == 0 &&
           grouped.first.back() == grouped.items.size() &&
           std::is_sorted(grouped.first.begin(), grouped.first.end()));
}

constexpr auto whole_network = [](auto& io, auto& network) {
  io.list(network.lanes, network_lane);
  const std::size_t lanes = network.lanes.size();
  groups(io, network.successors, lanes, field);
  groups(io, network.speeds, lanes, speed_piece);
  groups(io, network.left_windows, lanes, range);
  groups(io, network.right_windows, lanes, range);
};

bool names_only_its_lanes(const RouteNetwork& network) {
  const std::size_t lanes = network.lanes.size();
  const auto names_one = [&](std::uint32_t lane) { return lane < lanes; };
  const auto is_sound = [&](const NetworkLane& lane) {
    return (lane.left == kNoLane || names_one(lane.left)) &&
           (lane.right == kNoLane || names_one(lane.right));
  };
  return std::all_of(network.lanes.begin(), network.lanes.end(), is_sound) &&
         std::all_of(network.successors.items.begin(), network.successors.items.end(), names_one);
}

// The map's lanes first, then twins of some of them.
bool has_sound_twins(const RouteNetwork& network, std::size_t on_map) {
  const std::size_t lanes = network.lanes.size();
  if (lanes < on_map) return false;
  for (std::uint32_t lane = 0; lane < lanes; ++lane) {
    const std::uint32_t contraflow_twin = network.lanes[lane].contraflow_twin;
    if (contraflow_twin == kNoLane && lane < on_map) continue;
    if (contraflow_twin >= lanes || network.lanes[contraflow_twin].contraflow_twin != lane)
      return false;
    if ((contraflow_twin < on_map) == (lane < on_map)) return false;
  }
  return true;
}

}  // namespace

std::string write_route_network(const RouteNetwork& network) {
  std::string bytes;
  map::ByteWriter io(bytes);
  io(kVersion);
  whole_network(io, network);
  return bytes;
}

std::optional<RouteNetwork> read_route_network(std::string_view bytes, std::size_t lanes) {
  if (bytes.empty()) return {};
  map::ByteReader io(bytes, {});
  RouteNetwork network;
  try {
    std::uint32_t version = 0;
    io(version);
    if (version != kVersion) return {};
    whole_network(io, network);
    io.check(io.at_end() && names_only_its_lanes(network) && has_sound_twins(network, lanes));
  } catch (const map::ByteReader::Damaged&) {
    throw std::invalid_argument("read_route_network: its content is damaged");
  }
  return network;
}

RouteNetwork route_network_of(const map::RoadMap& road_map) {
  const map::FlatArray<char>& routing = road_map.index().routing;
  try {
    auto stored = read_route_network(routing.bytes(), road_map.lanes().size());
    return stored ? *std::move(stored) : make_route_network(road_map);
  } catch (const std::invalid_argument&) {
    routing.refuse("the route network in it is damaged");
  }
}

}  // namespace roadbed::planning::route
