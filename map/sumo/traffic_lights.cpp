#include "roadbed/map/sumo/traffic_lights.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "roadbed/map/sumo/lane_users.h"

namespace roadbed::map::sumo {
namespace {

constexpr int kGreen_s = 30, kClearance_s = 2;
constexpr int kIdle_s = 5;  // red where nothing crosses, as netconvert has it

constexpr double kFast_mps = 70.0 / 3.6;  // netconvert's tls.minor-left.max-speed

using SignalList = std::vector<std::size_t>;

class LightMaker {
 public:
  LightMaker(const RoadMap& road_map, const Net& net, const ConnectionConflicts& conflicts)
      : road_map_(road_map), net_(net), conflicts_(conflicts) {
    std::map<std::string, std::set<std::string>> controllers;
    for (const Controller& controller : road_map.controllers()) {
      for (const std::string& signal : controller.signals) {
        controllers[signal].insert(controller.source_id);
      }
    }
    for (std::size_t i = 0; i < road_map.signals().size(); ++i) {
      const Signal& signal = road_map.signals().at(i);
      if (!signal.dynamic) continue;
      for (const LaneId lane : signal.lanes) of_lane_[lane].push_back(i);
      const auto found = controllers.find(signal.source_id);
      switches_.emplace(i, found != controllers.end()
                               ? std::set<std::string>(found->second)
                               : std::set<std::string>{"signal " + signal.source_id});
    }
  }

  std::vector<TrafficLight> make() {
    std::vector<TrafficLight> lights;
    for (std::uint32_t node = 0; node < net_.nodes.size(); ++node) {
      TrafficLight light{node, {}, {}, {}};
      for (const std::uint32_t connection : conflicts_.at_nodes()[node]) {
        SignalList signals = signals_of(net_.connections[connection]);
        if (signals.empty()) continue;
        light.connections.push_back(connection);
        light.signals.push_back(std::move(signals));
      }
      if (light.connections.empty()) continue;
      light.phases = program(light);
      lights.push_back(std::move(light));
    }
    return lights;
  }

 private:
  using Group = std::vector<std::size_t>;  // links

  SignalList signals_of(const NetConnection& connection) const {
    SignalList signals;
    const auto add = [&](DirectedLane way) {
      const auto found = of_lane_.find(way.lane);
      if (way.against || found == of_lane_.end()) return;
      signals.insert(signals.end(), found->second.begin(), found->second.end());
    };
    add(net_.from_lane(connection));
    for (const DirectedLane way : connection.across) add(way);
    std::sort(signals.begin(), signals.end());
    signals.erase(std::unique(signals.begin(), signals.end()), signals.end());
    return signals;
  }

  // Links that switch together, in order of their first.
  std::vector<Group> groups(const TrafficLight& light) const {
    std::map<std::set<std::string>, std::size_t> numbers;
    std::vector<Group> groups;
    for (std::size_t link = 0; link < light.connections.size(); ++link) {
      std::set<std::string> key;
      for (const std::size_t signal : light.signals[link]) {
        const auto& some = switches_.at(signal);
        key.insert(some.begin(), some.end());
      }
      const auto [found, is_new] = numbers.emplace(std::move(key), groups.size());
      if (is_new) groups.emplace_back();
      groups[found->second].push_back(link);
    }
    return apart_where_fast(light, std::move(groups));
  }

  // From over 70 km/h nobody is to wait for a gap at green: such links of a group become their own.
  std::vector<Group> apart_where_fast(const TrafficLight& light, std::vector<Group> groups) const {
    for (std::size_t i = 0; i < groups.size(); ++i) {
      Group waiting;
      for (const std::size_t link : groups[i]) {
        const bool waits = std::any_of(groups[i].begin(), groups[i].end(), [&](std::size_t other) {
          return conflicts_.meet(light.connections[link], light.connections[other]) &&
                 turn(light, link) > turn(light, other);
        });
        if (waits && limit_mps(light, link) > kFast_mps) waiting.push_back(link);
      }
      if (waiting.empty()) continue;
      std::erase_if(groups[i], [&](std::size_t link) {
        return std::find(waiting.begin(), waiting.end(), link) != waiting.end();
      });
      groups.push_back(std::move(waiting));
    }
    return groups;
  }

  bool meet(const TrafficLight& light, const Group& a, const Group& b) const {
    return std::any_of(a.begin(), a.end(), [&](std::size_t one) {
      return std::any_of(b.begin(), b.end(), [&](std::size_t other) {
        return conflicts_.meet(light.connections[one], light.connections[other]);
      });
    });
  }

  // Phase by phase the first group that had no green yet, and all that go with it.
  std::vector<LightPhase> program(const TrafficLight& light) const {
    const std::vector<Group> all = groups(light);
    std::vector<std::string> greens;
    std::vector<bool> was_green(all.size());
    for (std::size_t first = 0; first < all.size(); ++first) {
      if (was_green[first]) continue;
      std::vector<std::size_t> together{first};
      for (const bool again : {false, true}) {
        for (std::size_t other = 0; other < all.size(); ++other) {
          if (was_green[other] != again || other == first) continue;
          const bool fits = std::none_of(together.begin(), together.end(), [&](std::size_t one) {
            return meet(light, all[one], all[other]);
          });
          if (fits) together.push_back(other);
        }
      }
      std::string state(light.connections.size(), 'r');
      for (const std::size_t group : together) {
        was_green[group] = true;
        for (const std::size_t link : all[group]) state[link] = 'G';
      }
      greens.push_back(let_wait(light, std::move(state)));
    }
    return with_changes(greens, yellow_s(light));
  }

  std::string let_wait(const TrafficLight& light, std::string state) const {
    std::string shown = state;
    for (std::size_t a = 0; a < state.size(); ++a) {
      for (std::size_t b = 0; b < state.size(); ++b) {
        if (a == b || state[a] == 'r' || state[b] == 'r') continue;
        if (!conflicts_.meet(light.connections[a], light.connections[b])) continue;
        if (turn(light, a) > turn(light, b)) shown[a] = 'g';
      }
    }
    return shown;
  }

  // How much a link turns; of two that turn as much the later one waits.
  std::pair<double, std::size_t> turn(const TrafficLight& light, std::size_t link) const {
    const NetConnection& connection = net_.connections[light.connections[link]];
    return {std::abs(turn_rad(road_map_, net_, connection)), link};
  }

  double limit_mps(const TrafficLight& light, std::size_t link) const {
    return speed_mps(
        road_map_.lane(net_.from_lane(net_.connections[light.connections[link]]).lane));
  }

  // 3 s up to 50 km/h, 4 s up to 60, else 5 (RiLSA 2015, 2.7.3).
  int yellow_s(const TrafficLight& light) const {
    double fastest_mps = 0.0;
    for (std::size_t link = 0; link < light.connections.size(); ++link) {
      fastest_mps = std::max(fastest_mps, limit_mps(light, link));
    }
    return fastest_mps <= 50.1 / 3.6 ? 3 : fastest_mps <= 60.1 / 3.6 ? 4 : 5;
  }

  // Green, then yellow where it ends, then red until the junction is clear.
  static std::vector<LightPhase> with_changes(const std::vector<std::string>& greens,
                                              int yellow_s) {
    std::vector<LightPhase> phases;
    for (std::size_t i = 0; i < greens.size(); ++i) {
      const std::string& now = greens[i];
      const std::string& next = greens[(i + 1) % greens.size()];
      phases.push_back({kGreen_s, now});
      std::string yellow = now, red = now;
      for (std::size_t link = 0; link < now.size(); ++link) {
        if (now[link] == 'r' || (next[link] != 'r' && greens.size() > 1)) continue;
        yellow[link] = 'y';
        red[link] = 'r';
      }
      if (yellow == now) continue;
      phases.push_back({yellow_s, std::move(yellow)});
      phases.push_back({greens.size() > 1 ? kClearance_s : kIdle_s, std::move(red)});
    }
    return phases;
  }

  const RoadMap& road_map_;
  const Net& net_;
  const ConnectionConflicts& conflicts_;
  std::map<LaneId, SignalList> of_lane_;
  std::map<std::size_t, std::set<std::string>> switches_;  // controllers, by signal
};

}  // namespace

std::vector<TrafficLight> make_traffic_lights(const RoadMap& road_map, const Net& net,
                                              const ConnectionConflicts& conflicts) {
  return LightMaker(road_map, net, conflicts).make();
}

}  // namespace roadbed::map::sumo
