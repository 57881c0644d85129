#include "roadbed/planning/maneuvers/overtaking.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace roadbed::planning::inline maneuvers {
namespace {

constexpr double kOvertakeStep_s = 0.1;
constexpr double kLongest_s = 25.0;  // that overtaking may take
// What the vehicle does: less than what the cruise control was seen to do, both times.
constexpr double kPassing_mps2 = 0.9, kFallingBack_mps2 = 2.0;
constexpr double kBackInLane_s = 3.5;  // from beside to back in the lane
// What others do at worst: speed up, to a tenth above the limit.
constexpr double kSpeedsUp_mps2 = 1.0, kAboveLimit = 1.1;
constexpr double kMargin_s = 1.5;  // of the way on which two come towards each other
constexpr double kBeside_m = 1.0, kLeastBeside_m = 0.4;   // kept from who is overtaken
constexpr double kNotInLane_m = 0.3;                      // as MoverOnLine::shares_way
constexpr double kReturnGap_m = 4.0, kReturnGap_s = 0.4;  // before who was overtaken
constexpr double kGapAhead_m = 5.0, kGapAhead_s = 1.0;    // to who drives ahead of that one
constexpr double kBehindRear_m = 3.0;                     // of who is not overtaken after all
constexpr double kMoves_mps = 1.0, kSlower_mps = 2.5;
// Towards a vehicle that passes who stands, and what that one keeps to pull out from where it
// waits.
constexpr double kComes_mps = 0.5, kRoomToPullOut_m = 8.0;
constexpr double kLeadWithin_m = 70.0;
constexpr double kBeforeEnd_m = 10.0;  // of the stretch, to be back in the lane
constexpr double kBehind_m = 3.0;      // kept from traffic that comes up behind in the other lane
constexpr double kSightStep_m = 2.5, kOncomingCar_m = 5.0, kHalfLane_m = 1.75;
constexpr std::size_t kHidden = std::numeric_limits<std::size_t>::max();
constexpr double kRelease_mps2 = 2.0;  // at which a faster vehicle closes up comfortably

/// Where one is at worst after some time, for who is to be met or followed in its lane.
double at_worst_m(const MoverOnLine& mover, double after_s, double limit_mps) {
  const double speed_mps = std::abs(mover.speed_mps);
  const double most_mps = kAboveLimit * limit_mps;
  const double way_m = geometry::speeding_up_m(speed_mps, kSpeedsUp_mps2, most_mps, after_s);
  return mover.s_m + (mover.speed_mps < 0.0 ? -way_m : way_m);
}

double worst_speed_mps(const MoverOnLine& mover, double after_s, double limit_mps) {
  const double speed_mps = std::abs(mover.speed_mps);
  return std::max(speed_mps,
                  std::min(speed_mps + kSpeedsUp_mps2 * after_s, kAboveLimit * limit_mps));
}

}  // namespace

/// Of the vehicle, as it is planned; station of the rear axle.
struct Overtaking::State {
  double after_s, s_m, speed_mps;
};

/// Now, past the one that is overtaken, and back in the lane.
struct Overtaking::Course {
  const State &from, &past, &back;
};

Overtaking::Overtaking(const geometry::VehicleShape& vehicle, const DrivingTask& task,
                       const SpeedCeiling& ceiling)
    : vehicle_(vehicle),
      task_(task),
      ceiling_(ceiling),
      stretches_(oncoming_lane_segments(task.road_map, task.route, task.line)) {}

/// In the vehicle's lane.
const MoverOnLine* Overtaking::nearest_ahead(const std::vector<MoverOnLine>& movers,
                                             const ViewOnLine& view) const {
  const MoverOnLine* nearest = nullptr;
  const double front_m = view.at.s_m + vehicle_.front_m();
  for (const MoverOnLine& mover : movers) {
    if (!mover.shares_way(0.0, vehicle_) || mover.s_m < view.at.s_m ||
        mover.rear_m() > front_m + kLeadWithin_m)
      continue;
    if (!nearest || mover.s_m < nearest->s_m) nearest = &mover;
  }
  return nearest;
}

/// Whether it stands now and will not always: in a queue, at a light, to let somebody by. Of those
/// who are measured who has stood for long is static.
bool Overtaking::waits(const MoverOnLine& mover, double t_s) const {
  constexpr double kWithin_s = 12.0, kSetsOff_m = 0.5;
  if (std::abs(mover.speed_mps) > kMoves_mps) return false;
  if (task_.others_within) return true;
  const geometry::Trajectory& motion = task_.obstacles[mover.obstacle].motion;
  const Eigen::Vector2d now = motion.at(t_s).pose().position();
  return (motion.at(t_s + kWithin_s).pose().position() - now).norm() > kSetsOff_m;
}

double Overtaking::pass_at_m(const MoverOnLine& lead, const OncomingLaneSegment& stretch) const {
  // Cyclists are wider than they are, for the room that is kept beside them.
  const double wider_m = lead.half_width_m - 0.5 * task_.obstacles[lead.obstacle].width_m;
  const double room_m = std::max(kLeastBeside_m, kBeside_m - std::max(0.0, wider_m));
  return lead.d_m + stretch.side * (lead.half_width_m + 0.5 * vehicle_.width_m + room_m);
}

const OncomingLaneSegment* Overtaking::stretch_at(double s_m) const {
  const auto found = std::ranges::find_if(stretches_, [&](const OncomingLaneSegment& stretch) {
    return s_m >= stretch.from_s_m && s_m <= stretch.to_s_m;
  });
  return found == stretches_.end() ? nullptr : &*found;
}

Overtaking::State Overtaking::step(State state) const {
  const double most = ceiling_.at(state.s_m).speed_mps;
  state.after_s += kOvertakeStep_s;
  state.speed_mps = std::min(state.speed_mps + kPassing_mps2 * kOvertakeStep_s, most);
  state.s_m += state.speed_mps * kOvertakeStep_s;
  return state;
}

/// Where the vehicle is when it is past the one that is overtaken; none: that takes too long.
std::optional<Overtaking::State> Overtaking::past(State state, const MoverOnLine& lead) const {
  const double gap_m = kReturnGap_m + kReturnGap_s * lead.speed_mps;
  const auto is_past = [&] {
    return state.s_m - vehicle_.rear_overhang_m >
           lead.front_m() + lead.speed_mps * state.after_s + gap_m;
  };
  while (!is_past()) {
    if (state.after_s > kLongest_s) return std::nullopt;
    state = step(state);
  }
  return state;
}

/// Back in the lane after that.
Overtaking::State Overtaking::back_from(const State& past) const {
  State back = past;
  while (back.after_s < past.after_s + kBackInLane_s) back = step(back);
  return back;
}

/// Whether somebody drives neither where the vehicle overtakes nor in its lane, or is past already,
/// or follows in its lane.
bool Overtaking::is_no_matter(const MoverOnLine& mover, const State& now, double pass_at_m) const {
  const bool in_lane = mover.shares_way(0.0, vehicle_),
             in_way = mover.shares_way(pass_at_m, vehicle_);
  if (!in_lane && !in_way) return true;
  const bool is_behind = mover.front_m() < now.s_m;
  return is_behind && (mover.speed_mps < 0.0 || !in_way);
}

/// Metres by which the gap to one of the others is too short until the vehicle is back in its lane;
/// 0 or less: none.
double Overtaking::missing_m(const MoverOnLine& mover, double now_s_m, const State& past,
                             const State& back, double limit_mps) const {
  const geometry::VehicleShape& vehicle = vehicle_;
  if (mover.speed_mps < 0.0) {
    const double closing_mps = back.speed_mps + worst_speed_mps(mover, back.after_s, limit_mps);
    const double nearest_m = at_worst_m(mover, back.after_s, limit_mps) - mover.half_length_m;
    return back.s_m + vehicle.front_m() + kMargin_s * closing_mps - nearest_m;
  }
  if (mover.s_m < now_s_m) {  // comes up behind in the other lane
    const double front_m = at_worst_m(mover, past.after_s, limit_mps) + mover.half_length_m;
    return front_m + kBehind_m - past.s_m + vehicle.rear_overhang_m;
  }
  const double closing_mps = std::max(0.0, back.speed_mps - mover.speed_mps);
  const double gap_m =
      kGapAhead_m + kGapAhead_s * mover.speed_mps + 0.5 * closing_mps * closing_mps / kRelease_mps2;
  return back.s_m + vehicle.front_m() + gap_m - mover.rear_m() - mover.speed_mps * back.after_s;
}

/// Why overtaking would not end in time; none: it does.
std::optional<std::string> Overtaking::why_not(const State& from, const MoverOnLine& lead,
                                               const std::vector<MoverOnLine>& movers,
                                               const OncomingLaneSegment& stretch) const {
  const std::optional<State> past = this->past(from, lead);
  if (!past) return fmt::format("it would take more than {:.0f} s", kLongest_s);
  const State back = back_from(*past);
  const double to_end_m = std::min(stretch.to_s_m, task_.line.goal_s_m()) - back.s_m;
  if (to_end_m < kBeforeEnd_m) {
    return fmt::format("it would end {:.0f} m past where it has to", kBeforeEnd_m - to_end_m);
  }
  return who_is_in_the_way({from, *past, back}, lead, movers, stretch);
}

/// Whose gap is too short; none: nobody's.
std::optional<std::string> Overtaking::who_is_in_the_way(const Course& course,
                                                         const MoverOnLine& lead,
                                                         const std::vector<MoverOnLine>& movers,
                                                         const OncomingLaneSegment& stretch) const {
  const double pass_m = pass_at_m(lead, stretch), from_s_m = course.from.s_m;
  for (const MoverOnLine& mover : movers) {
    if (mover.obstacle == lead.obstacle || is_no_matter(mover, course.from, pass_m)) continue;
    const double missing = missing_m(mover, from_s_m, course.past, course.back, stretch.limit_mps);
    if (missing <= 0.0) continue;
    if (mover.obstacle == kHidden) {
      return fmt::format("{:.0f} m of the other lane are seen, {:.0f} m are missing",
                         mover.s_m - from_s_m, missing);
    }
    const char* where = mover.speed_mps < 0.0             ? "oncoming"
                        : mover.shares_way(0.0, vehicle_) ? "ahead of it"
                                                          : "in the other lane";
    return fmt::format("{} is {}, the gap is {:.0f} m too short",
                       task_.obstacles[mover.obstacle].id, where, missing);
  }
  return std::nullopt;
}

/// Behind somebody who stands for good, and whom only the other lane leads past: as long as
/// somebody comes there before the vehicle would be back, at worst; unless it has left its lane
/// already.
std::optional<Overtaking::Decision> Overtaking::waits_for_oncoming(
    const ViewOnLine& view, const std::vector<MoverOnLine>& movers) const {
  const OncomingLaneSegment* stretch = stretch_at(view.at.s_m);
  if (stretch == nullptr || overtaken_) return std::nullopt;
  const std::vector<MoverOnLine> all = movers_on_line(task_.line, view.traffic, view.t_s, true);
  const MoverOnLine* next = nearest_ahead(all, view);
  if (next == nullptr || !next->stands) return std::nullopt;
  const double within_m = stretch->own_edge_m - 0.5 * vehicle_.width_m;
  const double least_m = next->half_width_m + 0.5 * vehicle_.width_m + kLeastBeside_m;
  const bool has_begun = stretch->side * view.at.d_m > within_m + kNotInLane_m;
  const bool has_room = stretch->side * next->d_m + least_m <= within_m + kNotInLane_m;
  const State now{0.0, view.at.s_m, view.speed_mps};
  const std::optional<State> past = this->past(now, *next);
  if (has_begun || has_room || !past) return std::nullopt;
  const State back = back_from(*past);
  std::vector<MoverOnLine> oncoming;
  std::ranges::copy_if(movers, std::back_inserter(oncoming),
                       [](const MoverOnLine& mover) { return mover.speed_mps < -kComes_mps; });
  const auto who = who_is_in_the_way({now, *past, back}, *next, oncoming, *stretch);
  if (!who) return std::nullopt;
  Decision decision{
      .keep_within_m = std::max(0.0, within_m),
      .side = stretch->side,
      .reason = fmt::format("{} is not passed: {}", task_.obstacles[next->obstacle].id, *who)};
  const double at_s_m = next->rear_m() - kRoomToPullOut_m - vehicle_.front_m();
  const double stopping_m = 0.5 * view.speed_mps * view.speed_mps / kFallingBack_mps2;
  if (at_s_m > view.at.s_m + stopping_m) decision.waits_at_s_m = at_s_m;
  return decision;
}

/// Somebody where the other lane is first hidden for as long as a car is, unless somebody is seen
/// to come before.
std::optional<MoverOnLine> Overtaking::hidden_oncoming(const ViewOnLine& view,
                                                       const std::vector<MoverOnLine>& movers,
                                                       const OncomingLaneSegment& stretch) const {
  if (!view.sight) return std::nullopt;
  const double d_m = stretch.side * (stretch.own_edge_m + kHalfLane_m);
  double hidden_m = 0.0;
  for (double s_m = view.at.s_m; s_m < stretch.to_s_m; s_m += kSightStep_m) {
    const ReferencePoint on_line = task_.line.at(s_m);
    const Eigen::Vector2d aside(-std::sin(on_line.heading_rad), std::cos(on_line.heading_rad));
    hidden_m = view.sight->sees(on_line.in_map + d_m * aside) ? 0.0 : hidden_m + kSightStep_m;
    if (hidden_m < kOncomingCar_m) continue;
    const bool is_behind_another = std::ranges::any_of(movers, [&](const MoverOnLine& mover) {
      return mover.speed_mps < 0.0 && mover.s_m > view.at.s_m && mover.rear_m() < s_m &&
             mover.shares_way(d_m, vehicle_);
    });
    if (is_behind_another) return std::nullopt;
    return MoverOnLine{.obstacle = kHidden,
                       .s_m = s_m,
                       .d_m = d_m,
                       .half_length_m = 0.5 * kOncomingCar_m,
                       .half_width_m = 0.5 * vehicle_.width_m,
                       .speed_mps = -stretch.limit_mps};
  }
  return std::nullopt;
}

/// Where the vehicle is when its front is beside the rear of the one that is overtaken.
Overtaking::State Overtaking::beside_rear(State state, const MoverOnLine& lead) const {
  const auto is_behind = [&] {
    return state.s_m + vehicle_.front_m() < lead.rear_m() + lead.speed_mps * state.after_s;
  };
  while (is_behind() && state.after_s < kLongest_s) state = step(state);
  return state;
}

/// Whether braking leads behind the one that was to be overtaken, and back into the lane, before
/// anybody comes.
bool Overtaking::can_fall_back(const State& from, const MoverOnLine& lead,
                               const std::vector<MoverOnLine>& movers,
                               const OncomingLaneSegment& stretch) const {
  const geometry::VehicleShape& vehicle = vehicle_;
  State state = from;
  const auto rear_m = [&] { return lead.rear_m() + lead.speed_mps * state.after_s; };
  while (state.s_m + vehicle.front_m() > rear_m() - kBehindRear_m) {
    if (state.after_s > from.after_s + kLongest_s) return false;
    state.after_s += kOvertakeStep_s;
    state.speed_mps = std::max(0.0, state.speed_mps - kFallingBack_mps2 * kOvertakeStep_s);
    state.s_m += state.speed_mps * kOvertakeStep_s;
  }
  state.after_s += kBackInLane_s;
  state.s_m += std::max(state.speed_mps, lead.speed_mps) * kBackInLane_s;
  const double pass_m = pass_at_m(lead, stretch);
  return std::ranges::none_of(movers, [&](const MoverOnLine& mover) {
    if (mover.obstacle == lead.obstacle || mover.speed_mps >= 0.0) return false;
    if (!mover.shares_way(pass_m, vehicle_) || mover.front_m() < from.s_m) return false;
    return at_worst_m(mover, state.after_s, stretch.limit_mps) - mover.half_length_m <
           state.s_m + vehicle.front_m();
  });
}

/// The one that is being overtaken, or else a slower one ahead.
const MoverOnLine* Overtaking::lead_of(const std::vector<MoverOnLine>& movers,
                                       const ViewOnLine& view) const {
  const auto found = std::ranges::find_if(
      movers, [&](const MoverOnLine& mover) { return overtaken_ == mover.obstacle; });
  if (found != movers.end()) return &*found;
  const MoverOnLine* nearest = nearest_ahead(movers, view);
  return nearest && nearest->speed_mps > kMoves_mps ? nearest : nullptr;
}

/// Whether it is over: past the other one, or behind it again.
bool Overtaking::has_ended(const ViewOnLine& view, const MoverOnLine& lead) const {
  const geometry::VehicleShape& vehicle = vehicle_;
  const double past_m = lead.front_m() + kReturnGap_m + kReturnGap_s * lead.speed_mps;
  const double front_m = view.at.s_m + vehicle.front_m();
  return view.at.s_m - vehicle.rear_overhang_m > past_m ||
         (falls_back_ && front_m < lead.rear_m() - kBehindRear_m);
}

Overtaking::Decision Overtaking::look(const ViewOnLine& view) {
  const OncomingLaneSegment* stretch = stretch_at(view.at.s_m);
  const std::vector<MoverOnLine> movers =
      stretch ? movers_on_line(task_.line, view.traffic, view.t_s) : std::vector<MoverOnLine>{};
  const MoverOnLine* lead = lead_of(movers, view);
  const geometry::VehicleShape& vehicle = vehicle_;
  const double within_m = stretch ? stretch->own_edge_m - 0.5 * vehicle.width_m : 0.0;
  if (auto waiting = waits_for_oncoming(view, movers)) return *std::move(waiting);
  if (const MoverOnLine* next = nearest_ahead(movers, view);
      !lead && next && waits(*next, view.t_s)) {
    overtaken_.reset();
    return {
        .keep_within_m = std::max(0.0, within_m),
        .side = stretch->side,
        .reason = fmt::format("{} is not overtaken: it waits", task_.obstacles[next->obstacle].id)};
  }
  if (!lead || stretch->side * pass_at_m(*lead, *stretch) <= within_m + kNotInLane_m) {
    overtaken_.reset();
    return {};
  }
  const State now{0.0, view.at.s_m, view.speed_mps};
  std::optional<std::string> why = why_not(now, *lead, movers, *stretch);
  if (!why && !overtaken_ && is_braking(task_.obstacles[lead->obstacle], view.t_s))
    why = "it brakes";
  const bool is_free_as_seen = !why;
  std::vector<MoverOnLine> with_hidden = movers;
  if (is_free_as_seen) {
    if (const auto hidden = hidden_oncoming(view, movers, *stretch)) {
      with_hidden.push_back(*hidden);
      why = why_not(now, *lead, with_hidden, *stretch);
    }
  }
  const std::string& name = task_.obstacles[lead->obstacle].id;
  Decision decision{.keep_within_m = std::max(0.0, within_m), .side = stretch->side};
  if (!overtaken_) {
    falls_back_ = false;
    const bool is_wanted = ceiling_.at(view.at.s_m).speed_mps >= lead->speed_mps + kSlower_mps;
    if (is_wanted && why) decision.reason = fmt::format("{} is not overtaken: {}", name, *why);
    decision.looks_past = is_wanted && is_free_as_seen && why;
    if (is_wanted && !why && can_fall_back(beside_rear(now, *lead), *lead, with_hidden, *stretch)) {
      overtaken_ = lead->obstacle;
    }
  } else if (has_ended(view, *lead)) {
    overtaken_.reset();
    if (why) decision.reason = fmt::format("{} is not overtaken: {}", name, *why);
  }
  if (!overtaken_) return decision;
  falls_back_ = falls_back_ || (why && can_fall_back(now, *lead, with_hidden, *stretch));
  decision.overtaken = overtaken_;
  decision.falls_back = falls_back_;
  decision.gap_m = lead->rear_m() - view.at.s_m - vehicle.front_m();
  decision.pass_at_m = pass_at_m(*lead, *stretch);
  decision.reason = falls_back_ ? fmt::format("falls back behind {} again", name)
                                : fmt::format("overtakes {}", name);
  return decision;
}

}  // namespace roadbed::planning::maneuvers
