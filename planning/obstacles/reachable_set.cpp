#include "roadbed/planning/obstacles/reachable_set.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "roadbed/geometry/motion/longitudinal.h"
#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/geometry/primitives/segment.h"
#include "roadbed/planning/obstacles/lanes_ahead.h"

namespace roadbed::planning::inline obstacles {
namespace {

using geometry::Rectangle;

constexpr double kSlice_m = 2.5;
constexpr double kFastest_mps = 60.0;             // where the map knows no limit
constexpr double kOnWay_rad = 0.9;                // against a lane that it drives along
constexpr double kBeside_m = 6.0, kNear_m = 1.5;  // lanes to change to; to be on
constexpr std::size_t kMostWays = 4;              // from one lane
constexpr double kChangesLane_mps = 0.3;          // sideways, more than keeping a lane
constexpr double kLeastReverse_mps = -0.2;

/// What the carriageway, or a lane alone, leaves to both sides of a lane's middle.
struct Room {
  double right_m, left_m;
};

Room room_of_lane(const map::Lane& lane, double s_m, double half_width_m) {
  const double room_m = std::max(0.0, 0.5 * lane.width_m(s_m) - half_width_m);
  return {-room_m, room_m};
}

/// Junctions have no borders that everybody keeps to.
Room room_of_road(const map::RoadMap& road_map, const map::Lane& lane, double s_m) {
  constexpr double kAll_m = std::numeric_limits<double>::infinity();
  constexpr int kMostBeside = 20;
  if (lane.junction) return {-kAll_m, kAll_m};
  const double half_m = 0.5 * lane.width_m(s_m);
  const double share = s_m / std::max(1e-9, lane.length_m());
  const auto beside_m = [&](bool leftwards) {
    double sum_m = half_m;
    bool along = true;
    map::LaneId at = lane.id;
    for (int i = 0; i < kMostBeside; ++i) {
      const map::LaneLinks& links = road_map.graph().of(at);
      const std::optional<map::Neighbour>& next = leftwards == along ? links.left : links.right;
      if (!next || !map::is_surface(road_map.lane(next->lane).type)) break;
      along = along == next->same_direction;
      at = next->lane;
      const map::Lane& beside = road_map.lane(at);
      sum_m += beside.width_m((along ? share : 1.0 - share) * beside.length_m());
    }
    return sum_m;
  };
  return {-beside_m(false), beside_m(true)};
}

double braking_m(double speed_mps, double mps2, double after_s) {
  const double t_s = std::min(after_s, speed_mps / mps2);
  return speed_mps * t_s - 0.5 * mps2 * t_s * t_s;
}

}  // namespace

MotionBounds by_the_rules() {
  return {.max_gain_mps2 = 3.0,
          .max_speeding = 1.1,
          .max_sideways_mps = 0.5,
          .max_off_road_mps = 0.5,
          .max_turned_sine = 0.05,
          .keeps_lane = true};
}

ReachableSet::ReachableSet(const map::RoadMap& road_map, const Obstacle& body, double seen_s,
                           double horizon_s, const MotionBounds& bounds)
    : bounds_(bounds),
      body_(rectangle_at(body, seen_s)),
      walks_(body.kind == "pedestrian"),
      stays_(bounds.keeps_lane && body.is_static()) {
  const double speed_mps = body.is_static() ? 0.0 : body.motion.at(seen_s).speed_mps;
  velocity_ = speed_mps * body_.axis;
  if (walks_ || stays_ || speed_mps < kLeastReverse_mps) return;
  const double heading_rad = std::atan2(body_.axis.y(), body_.axis.x());
  const double within_m = bounds_.keeps_lane ? kNear_m : kBeside_m;
  bool is_inside = false;  // who keeps his lane is in those that hold him, if any does
  for (const map::LaneMatch& match : road_map.locate(body_.centre, within_m, true)) {
    if (bounds_.keeps_lane && is_inside && match.distance_m > 0.0) continue;
    if (std::abs(geometry::wrap_angle(heading_rad - match.heading_rad)) > kOnWay_rad) continue;
    is_inside = is_inside || match.distance_m == 0.0;
    const map::Lane& lane = road_map.lane(match.place.lane);
    const double length_m =
        lane.length_m() +
        geometry::speeding_up_m(std::max(0.0, speed_mps) + bounds_.speed_error_mps,
                                bounds_.max_gain_mps2, kFastest_mps, horizon_s);
    for (const LanesAhead& way :
         ways_ahead(road_map, {match.place.lane, 0.0, 0.0}, length_m, kMostWays)) {
      add_way(road_map, way, match, horizon_s);
    }
  }
}

void ReachableSet::add_way(const map::RoadMap& road_map, const LanesAhead& lanes,
                           const map::LaneMatch& at, double horizon_s) {
  const geometry::Polyline middle = centre_of(road_map, lanes);
  const double turned_rad = std::atan2(body_.axis.y(), body_.axis.x()) - at.heading_rad;
  const double speed_mps = velocity_.dot(body_.axis);
  Way way{.slices = {},
          .first_s_m = -body_.radius_m() - bounds_.position_error_m - kSlice_m,
          .d_m = at.place.d_m,
          .sideways_mps = speed_mps * std::sin(turned_rad),
          .along_mps = std::max(0.0, speed_mps * std::cos(turned_rad)),
          .most_mps = 0.0,
          .bend_per_m = 0.0,
          .turned_sine = std::max(std::abs(std::sin(turned_rad)), bounds_.max_turned_sine)};
  for (const map::LaneId id : lanes.lanes) {
    const auto limit = road_map.lane(id).least_speed_limit_mps();
    way.most_mps = std::max(
        way.most_mps, limit ? std::min(kFastest_mps, *limit * bounds_.max_speeding) : kFastest_mps);
  }
  const double end_m =
      body_.radius_m() + bounds_.position_error_m +
      2.0 * geometry::speeding_up_m(way.along_mps + bounds_.speed_error_mps, bounds_.max_gain_mps2,
                                    way.most_mps, horizon_s);
  std::size_t lane_at = 0;
  double lane_from_m = 0.0;
  for (double s_m = way.first_s_m; s_m < end_m + kSlice_m; s_m += kSlice_m) {
    const double on_way_m = at.place.s_m + s_m;
    while (lane_at + 1 < lanes.lanes.size() &&
           on_way_m > lane_from_m + road_map.lane(lanes.lanes[lane_at]).length_m()) {
      lane_from_m += road_map.lane(lanes.lanes[lane_at++]).length_m();
    }
    const map::Lane& lane = road_map.lane(lanes.lanes[lane_at]);
    const double in_lane_m = std::clamp(on_way_m - lane_from_m, 0.0, lane.length_m());
    const Room room = bounds_.keeps_lane ? room_of_lane(lane, in_lane_m, body_.half_width_m)
                                         : room_of_road(road_map, lane, in_lane_m);
    const double about_m = body_.half_length_m + 1.0;
    const double turns_rad = pose_on(middle, on_way_m + about_m).heading_rad -
                             pose_on(middle, on_way_m - about_m).heading_rad;
    const double bend = std::abs(geometry::wrap_angle(turns_rad)) / (2.0 * about_m);
    way.bend_per_m = std::max(way.bend_per_m, bend);
    way.slices.push_back({pose_on(middle, on_way_m), bend, room.right_m, room.left_m});
  }
  widen_rooms(way);
  ways_.push_back(std::move(way));
}

/// A body reaches to where its lane may be narrower than at its centre.
void ReachableSet::widen_rooms(Way& way) const {
  const auto about = static_cast<std::size_t>(std::ceil(body_.half_length_m / kSlice_m));
  const std::vector<Slice> own = way.slices;
  for (std::size_t i = 0; i < own.size(); ++i) {
    for (std::size_t k = i - std::min(i, about); k < std::min(own.size(), i + about + 1); ++k) {
      way.slices[i].right_m = std::min(way.slices[i].right_m, own[k].right_m);
      way.slices[i].left_m = std::max(way.slices[i].left_m, own[k].left_m);
    }
  }
}

/// How far its centre may be from where its velocity of now leads.
double ReachableSet::reach_m(double after_s) const {
  const double error_m = bounds_.position_error_m + bounds_.speed_error_mps * after_s;
  if (stays_) return bounds_.position_error_m;
  const double by_acceleration_m = 0.5 * bounds_.max_acceleration_mps2 * after_s * after_s;
  if (!walks_) return error_m + by_acceleration_m;
  const double most_mps =
      bounds_.keeps_lane ? bounds_.max_off_road_mps
                         : velocity_.norm() + std::max(velocity_.norm(), bounds_.max_walking_mps);
  return error_m + std::min(by_acceleration_m, most_mps * after_s);
}

/// Around all of its reach, for who is on no way.
Rectangle ReachableSet::anywhere(double from_s, double to_s) const {
  const double body_m = stays_ ? 0.0 : body_.radius_m();
  Rectangle square = body_;
  if (stays_) {
    square.half_length_m += reach_m(to_s);
    square.half_width_m += reach_m(to_s);
    return square;
  }
  square.centre += velocity_ * 0.5 * (from_s + to_s);
  square.half_width_m = reach_m(to_s) + body_m;
  square.half_length_m = square.half_width_m + 0.5 * velocity_.norm() * (to_s - from_s);
  return square;
}

bool ReachableSet::is_out_of_reach(const Rectangle& place, double from_s, double to_s) const {
  const double apart_m = geometry::distance_to_segment_m(
      place.centre, body_.centre + from_s * velocity_, body_.centre + to_s * velocity_);
  return apart_m > reach_m(to_s) + body_.radius_m() + place.radius_m();
}

template <typename Visit>
bool ReachableSet::any_of(double from_s, double to_s, const Visit& visit) const {
  if (ways_.empty()) return visit(anywhere(from_s, to_s));
  return std::ranges::any_of(ways_,
                             [&](const Way& way) { return any_of_way(way, from_s, to_s, visit); });
}

template <typename Visit>
bool ReachableSet::any_of_way(const Way& way, double from_s, double to_s,
                              const Visit& visit) const {
  const MotionBounds& b = bounds_;
  const double aside_m = std::abs(way.d_m) + 1.0;  // beside a bend stations go by faster or slower
  const double inside = 1.0 / (1.0 - std::min(0.5, way.bend_per_m * aside_m));
  const double outside = 1.0 / (1.0 + way.bend_per_m * aside_m);
  const double least_mps = std::max(0.0, way.along_mps - b.speed_error_mps);
  const double most_mps = way.along_mps + b.speed_error_mps;
  const double half_m = body_.half_length_m + body_.half_width_m * way.turned_sine;
  const double rear_m =
      outside * braking_m(least_mps, b.max_acceleration_mps2, from_s) - b.position_error_m - half_m;
  const double front_m = inside * geometry::speeding_up_m(most_mps, b.max_gain_mps2,
                                                          std::max(way.most_mps, most_mps), to_s) +
                         b.position_error_m + half_m;

  const auto ends_at = [&](int side) {  // the centre's farthest place to one side
    const double own_mps = side * way.sideways_mps;
    const double sideways_m = std::max(b.max_sideways_mps, own_mps) * to_s;
    const double by_acceleration_m =
        own_mps * (own_mps > 0.0 ? to_s : from_s) + 0.5 * b.max_acceleration_mps2 * to_s * to_s;
    return side * way.d_m + b.position_error_m +
           std::min(sideways_m, std::max(0.0, by_acceleration_m));
  };
  const double leftmost_m = ends_at(1), rightmost_m = -ends_at(-1);
  const double over_m = b.keeps_lane ? 0.0 : b.max_off_road_mps * to_s;
  const auto moves_m = [&](int side) {  // to where lane changes that have begun lead
    const double own_mps = side * way.sideways_mps;
    return own_mps > kChangesLane_mps ? std::numeric_limits<double>::infinity() : over_m;
  };
  const double error_m = b.position_error_m;

  const auto first = std::max(0.0, std::floor((rear_m - way.first_s_m) / kSlice_m));
  for (auto i = static_cast<std::size_t>(first); i + 1 < way.slices.size(); ++i) {
    const Slice& a = way.slices[i];
    const Slice& z = way.slices[i + 1];
    if (way.first_s_m + kSlice_m * static_cast<double>(i) > front_m) break;
    const double left_m =
        std::min(leftmost_m, std::max({a.left_m, z.left_m, way.d_m + error_m}) + moves_m(1));
    const double right_m =
        std::max(rightmost_m, std::min({a.right_m, z.right_m, way.d_m - error_m}) - moves_m(-1));
    const double sagitta_m =
        0.5 * body_.half_length_m * body_.half_length_m * std::max(a.bend_per_m, z.bend_per_m);
    const double body_m = body_.half_width_m + body_.half_length_m * way.turned_sine + sagitta_m;
    const double farthest_m = std::max(std::abs(left_m), std::abs(right_m)) + body_m;
    const double turn_rad =
        std::abs(geometry::wrap_angle(z.middle.heading_rad - a.middle.heading_rad));
    const Eigen::Vector2d chord = z.middle.position() - a.middle.position();
    Rectangle part;
    part.axis = chord.norm() > 1e-6 ? Eigen::Vector2d(chord.normalized()) : body_.axis;
    const Eigen::Vector2d leftwards(-part.axis.y(), part.axis.x());
    part.centre =
        0.5 * (a.middle.position() + z.middle.position()) + 0.5 * (left_m + right_m) * leftwards;
    part.half_length_m = 0.5 * chord.norm() + turn_rad * farthest_m;
    part.half_width_m = 0.5 * (left_m - right_m) + body_m + 0.5 * turn_rad * kSlice_m;
    if (!is_out_of_reach(part, from_s, to_s) && visit(part)) return true;
  }
  return false;
}

std::vector<Rectangle> ReachableSet::between(double from_s, double to_s) const {
  std::vector<Rectangle> all;
  any_of(from_s, to_s, [&](const Rectangle& part) {
    all.push_back(part);
    return false;
  });
  return all;
}

bool ReachableSet::may_touch(const Rectangle& other, double from_s, double to_s) const {
  if (is_out_of_reach(other, from_s, to_s)) return false;
  return any_of(from_s, to_s, [&](const Rectangle& part) {
    const double far_m = part.radius_m() + other.radius_m();
    return (part.centre - other.centre).squaredNorm() <= far_m * far_m &&
           geometry::distance_m(part, other) <= 0.0;
  });
}

}  // namespace roadbed::planning::obstacles
