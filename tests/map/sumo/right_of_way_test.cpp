#include "roadbed/map/sumo/right_of_way.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/derived/conflicts.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/made_lanelet2.h"

namespace roadbed::map::sumo {
namespace {

using Place = tests::MadeLanelet2::Point;

// A two-way road along x, whose lanes touch all the way, a one-way road to the north, and a turn
// onto it across the oncoming lane; in a mirror, y turned over, for left-hand traffic. With a rim
// the map begins where the lane to the east comes to the crossing:
//
//               ▲
//     ◀── west ─┼───────
//     ─── east ─┴──────▶
class TurnAcross {
 public:
  explicit TurnAcross(bool left_hand, bool has_rim = false) : left_hand_(left_hand) {
    const auto middle = nodes({{-60, 0}, {-12, 0}, {12, 0}, {60, 0}});
    const auto south = nodes({{-60, -4}, {-12, -4}, {12, -4}, {60, -4}});
    const auto north = nodes({{60, 4}, {12, 4}, {-12, 4}, {-60, 4}});
    const auto up_left = nodes({{-2, -60}, {-2, -12}, {-2, 12}, {-2, 60}});
    const auto up_right = nodes({{2, -60}, {2, -12}, {2, 12}, {2, 60}});
    const std::ptrdiff_t first = has_rim ? 1 : 0;
    lanes({middle.begin() + first, middle.end()}, {south.begin() + first, south.end()});
    lanes({middle.rbegin(), middle.rend()}, north);
    lanes(up_left, up_right);
    const auto bend = nodes({{-3, 1}, {1, -3}});
    lane(file_.way({middle[1], bend[0], up_left[2]}), file_.way({south[1], bend[1], up_right[2]}));
  }

  RoadMap map() const { return parse_map(file_.text(), "made.osm"); }

 private:
  using Nodes = std::vector<std::int64_t>;

  Nodes nodes(const std::vector<Place>& places) {
    Nodes made;
    for (const auto& [x, y] : places) made.push_back(file_.node({x, left_hand_ ? -y : y}));
    return made;
  }

  void lanes(const Nodes& left, const Nodes& right) {
    for (std::size_t i = 1; i < left.size(); ++i) {
      const auto one = way(left[i - 1], left[i]), other = way(right[i - 1], right[i]);
      lane(one, other);
    }
  }

  void lane(std::int64_t left, std::int64_t right) {
    file_.lanelet(left_hand_ ? right : left, left_hand_ ? left : right,
                  {{"subtype", "road"}, {"location", "urban"}, {"one_way", "yes"}});
  }

  // Lanes that touch share it, whichever way they lead.
  std::int64_t way(std::int64_t from, std::int64_t to) {
    const auto [found, is_new] = ways_.try_emplace(std::minmax({from, to}));
    if (is_new) found->second = file_.way({from, to});
    return found->second;
  }

  bool left_hand_;
  tests::MadeLanelet2 file_;
  std::map<std::pair<std::int64_t, std::int64_t>, std::int64_t> ways_;
};

// "from->to over from->to", each a heading: E, N, W or S.
std::vector<std::string> found_in(const RoadMap& road_map) {
  const DirectedLanes ways(road_map);
  const auto conflicts = find_conflicts(road_map);
  const Net net = build_net(road_map, ways, conflicts);
  const auto heading = [&](std::uint32_t edge) {
    const Lane& lane = road_map.lane(net.edges[edge].lanes.front().lane);
    const Eigen::Vector2d step =
        lane.centre.in_map.points().back() - lane.centre.in_map.points()[0];
    if (std::abs(step.x()) > std::abs(step.y())) return step.x() > 0.0 ? "E" : "W";
    return step.y() > 0.0 ? "N" : "S";
  };
  std::vector<std::string> found;
  for (const Prohibition& one : find_prohibitions(road_map, net, LaneLines(road_map, net),
                                                  ConnectionConflicts(net, conflicts))) {
    found.push_back(std::string(heading(one.first_from)) + "->" + heading(one.first_to) + " over " +
                    heading(one.then_from) + "->" + heading(one.then_to));
  }
  return found;
}

TEST(SumoRightOfWay, WhoTurnsAcrossWaitsAndStraightTrafficBesideEachOtherDoesNot) {
  EXPECT_EQ(found_in(TurnAcross(false).map()), std::vector<std::string>{"W->W over E->N"});
  EXPECT_EQ(found_in(TurnAcross(true).map()), std::vector<std::string>{"W->W over E->S"});
}

// The turn's edge is its first metre, which still leads straight on.
TEST(SumoRightOfWay, ATurnFromTheRimOfTheMapIsOne) {
  EXPECT_EQ(found_in(TurnAcross(false, true).map()), std::vector<std::string>{"W->W over N->N"});
  EXPECT_EQ(found_in(TurnAcross(true, true).map()), std::vector<std::string>{"W->W over S->S"});
}

}  // namespace
}  // namespace roadbed::map::sumo
