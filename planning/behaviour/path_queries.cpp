#include "roadbed/planning/behaviour/path_queries.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace roadbed::planning::inline behaviour {
namespace {

using Offsets = LateralReplanner::Offsets;
using Question = LateralReplanner::Question;

constexpr double kPassTolerance_m = 0.25;  // more or less than asked for
constexpr double kBehindToReturn_m = 1.0;  // overtaking given up
constexpr double kLook_m = 0.4;            // beside the edge, at most
constexpr double kMerging_m = 0.8;         // beside the line
constexpr double kSetsOff_mps = 1.0, kNearRest_mps = 2.0, kShortEnds_m = 7.0;
constexpr double kPullsOut_mps = 0.5, kPullsOut_mps2 = 1.0;
constexpr double kNearGoal_m = 60.0, kBesideGoal_m = 0.15;

constexpr std::array<Offsets, 6> kBeside{
    {{-0.9, -0.4}, {0.4, 0.9}, {-1.8, -1.0}, {1.0, 1.8}, {-3.5, -2.0}, {2.0, 3.5}}};
constexpr std::array<Offsets, 2> kOtherLanes{{{-3.5, -2.6}, {2.6, 3.5}}};

/// A change to an offset takes a while, at any speed.
PathQuery at_offset(GoalLine& on, Maneuver maneuver, double offset_m, Question question) {
  const double speed = question.speed.speed_mps;
  question.ends.least_m = change_length_m(speed);
  question.ends.most_m = std::max(question.ends.most_m, question.ends.least_m + speed);
  question.checks_completion = false;
  return {.goal_line = &on,
          .maneuver = maneuver,
          .question = question,
          .offsets = {offset_m - kPassTolerance_m, offset_m + kPassTolerance_m}};
}

/// As the cruise control speeds up on a free road.
SpeedPlan free_speed(const GoalLine& on, SpeedPlan speed) {
  constexpr double kFreeSpeedUp_mps2 = 1.0;
  speed.target_mps = on.ceiling.at(on.replanner.s_m()).speed_mps;
  if (speed.speed_mps < speed.target_mps) speed.acceleration_mps2 = kFreeSpeedUp_mps2;
  return speed;
}

SpeedPlan pulling_out(double speed_mps) {
  return {.speed_mps = speed_mps,
          .acceleration_mps2 = speed_mps < kPullsOut_mps ? kPullsOut_mps2 : -kPullsOut_mps2,
          .target_mps = kPullsOut_mps};
}

bool somebody_moves_near(const Question& question) {
  constexpr double kNear_m = 40.0, kMovesNear_mps = 0.5;
  const Eigen::Vector2d here = question.measured.map_from_vehicle.position();
  return std::ranges::any_of(question.obstacles, [&](const Obstacle& obstacle) {
    if (!obstacle.is_there(question.t_s)) return false;
    const geometry::TrajectoryPoint at = obstacle.motion.at(question.t_s);
    return at.speed_mps > kMovesNear_mps && (at.pose().position() - here).norm() < kNear_m;
  });
}

/// Whether somebody drives in the same direction in the next lane of that side, beside or near.
bool somebody_drives_beside(const Question& question, double side) {
  constexpr double kFarBehind_m = 30.0, kNotFarAhead_m = 15.0, kLeastAside_m = 1.5,
                   kMostAside_m = 6.0;
  constexpr double kDrives_mps = 0.1, kSameWay = 0.7;
  const geometry::Pose2& here = question.measured.map_from_vehicle;
  return std::ranges::any_of(question.obstacles, [&](const Obstacle& obstacle) {
    if (!obstacle.is_there(question.t_s)) return false;
    const geometry::TrajectoryPoint at = obstacle.motion.at(question.t_s);
    const Eigen::Vector2d there = here.inverse() * at.pose().position();
    return at.speed_mps > kDrives_mps && std::cos(at.heading_rad - here.heading_rad) > kSameWay &&
           there.x() > -kFarBehind_m && there.x() < kNotFarAhead_m &&
           side * there.y() > kLeastAside_m && side * there.y() < kMostAside_m;
  });
}

void keep_within(const std::optional<double>& offset_m, double side, Offsets& offsets) {
  if (!offset_m) return;
  if (side > 0.0) {
    offsets.most_m = std::min(offsets.most_m, *offset_m);
  } else {
    offsets.least_m = std::max(offsets.least_m, -*offset_m);
  }
}

std::vector<PathQuery> ending_at(std::span<const Offsets> ends, GoalLine& on,
                                 const Question& question) {
  std::vector<PathQuery> queries;
  for (const Offsets& offsets : ends) {
    queries.push_back({.goal_line = &on,
                       .maneuver = Maneuver::beside,
                       .question = question,
                       .offsets = offsets,
                       .may_leave_lanes = false});
  }
  return queries;
}

}  // namespace

Offsets offsets_in_lane(const PassingDecision& passing) {
  Offsets offsets;
  keep_within(passing.overtaking.keep_within_m, passing.overtaking.side, offsets);
  keep_within(passing.in_lane.keep_within_m, passing.in_lane.side, offsets);
  keep_within(passing.in_lane.keep_within_on_wrong_side_m, -passing.in_lane.side, offsets);
  return offsets;
}

std::vector<PathQuery> queries_on_route(GoalLine& on, const Question& question,
                                        const PassingDecision& passing) {
  const Overtaking::Decision& overtaking = passing.overtaking;
  const LanePassing::Decision& lane = passing.in_lane;
  std::vector<PathQuery> queries;
  const bool stays_beside =
      overtaking.overtaken && (!overtaking.falls_back || overtaking.gap_m < kBehindToReturn_m);
  if (stays_beside) {
    queries.push_back(at_offset(on, Maneuver::overtake, *overtaking.pass_at_m, question));
  }
  if (lane.offset_m) {
    Question at_free_speed = question;
    at_free_speed.speed.target_mps = on.ceiling.at(on.replanner.s_m()).speed_mps;
    queries.push_back(at_offset(on, Maneuver::pass_in_lane, *lane.offset_m, at_free_speed));
  }
  if (passing.merging.along == Merging::Along::next_lane) {
    queries.push_back(at_offset(on, Maneuver::merge, 0.0, question));
  }
  PathQuery keep{.goal_line = &on,
                 .maneuver = Maneuver::keep_lane,
                 .question = question,
                 .offsets = offsets_in_lane(passing),
                 .bounds_kept_path = queries.empty()};
  // Nobody is passed on the way from lane to lane, but who stands.
  if (passing.merging.is_near() && somebody_moves_near(question)) {
    keep_within(kMerging_m, 1.0, keep.offsets);
    keep_within(kMerging_m, -1.0, keep.offsets);
  }
  // Nor is the marking crossed to the side of who drives there, but as far as it has been.
  const double beside_m = on.replanner.expected_path().lateral_at(on.replanner.s_m()).d_m;
  for (const double side : {1.0, -1.0}) {
    if (!somebody_drives_beside(question, side)) continue;
    keep_within(std::max(kMerging_m, side * beside_m), side, keep.offsets);
  }
  if (passing.within_lane.passed) {
    PathQuery pass = keep;
    pass.maneuver = Maneuver::pass_within_lane;
    pass.question.speed = free_speed(on, question.speed);
    queries.push_back(pass);
  }
  if (overtaking.looks_past) {
    PathQuery look = keep;
    const auto [least_m, most_m] =
        std::minmax({overtaking.side * (*overtaking.keep_within_m - kLook_m),
                     overtaking.side * *overtaking.keep_within_m});
    look.offsets = {least_m, most_m};
    queries.push_back(look);
  }
  queries.push_back(keep);
  // From close behind who stands no longer path leads round, and past who stays none at the speed
  // of the free way.
  if (question.speed.speed_mps < (passing.is_blocked ? kNearRest_mps : kSetsOff_mps)) {
    if (passing.is_blocked) keep.question.speed = pulling_out(question.speed.speed_mps);
    keep.question.ends = {.least_m = kShortEnds_m, .most_m = 2.0 * kShortEnds_m};
    queries.push_back(keep);
  }
  return queries;
}

std::vector<PathQuery> queries_to_goal(GoalLine& on, const Question& question) {
  std::vector<PathQuery> queries;
  for (const GoalStretch& stretch : on.stretches) {
    const double ahead_m = stretch.s_m.most - on.replanner.s_m();
    if (std::abs(stretch.d_m) < kBesideGoal_m || !(ahead_m > 0.0 && ahead_m < kNearGoal_m))
      continue;
    queries.push_back({.goal_line = &on,
                       .maneuver = Maneuver::beside,
                       .question = question,
                       .offsets = {stretch.d_m - kBesideGoal_m, stretch.d_m + kBesideGoal_m},
                       .may_leave_lanes = false});
  }
  queries.push_back({.goal_line = &on, .maneuver = Maneuver::keep_lane, .question = question});
  return queries;
}

std::vector<PathQuery> queries_beside(GoalLine& on, const Question& question) {
  return ending_at(kBeside, on, question);
}

std::vector<PathQuery> queries_in_other_lanes(GoalLine& on, const Question& question) {
  return ending_at(kOtherLanes, on, question);
}

}  // namespace roadbed::planning::behaviour
