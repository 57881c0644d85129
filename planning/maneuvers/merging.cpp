#include "roadbed/planning/maneuvers/merging.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "roadbed/planning/maneuvers/lane_course.h"
#include "roadbed/planning/speed/lead.h"
#include "roadbed/planning/speed/speed_controller.h"

namespace roadbed::planning::inline maneuvers {
namespace {

constexpr double kMergeFrom_m = 150.0, kMergeFromMost_m = 400.0;  // before the place
constexpr double kFarthestPlace_m = 200.0, kBetweenPlaces_m = 10.0;
constexpr double kGapWithin_s = 15.0;  // no gap until then: on to the end of the lane
constexpr double kStaysBegun_m = 5.0;  // that may be missing of a gap that is driven into
constexpr double kIsIn_m = 0.5, kInItsWay_m = 2.4;  // from the next lane's middle
constexpr double kBeyondHold_m = 0.3;               // the vehicle is on its way
constexpr double kWaits_mps2 = 1.5;
constexpr double kDrivesThere_m = 1.6;         // from the middle of the lane
constexpr double kOthersBrakeHard_mps2 = 4.0;  // from behind, at most
// Of a change's length: until the body is in the way, and from there until it is in the next lane.
constexpr double kUntilInTheWay = 0.46, kUntilIn = 0.35;

}  // namespace

double change_length_m(double speed_mps) {
  constexpr double kChangesIn_s = 3.0, kLeast_m = 15.0;
  return std::max(kLeast_m, kChangesIn_s * speed_mps);
}

Merging::Merging(const geometry::VehicleShape& vehicle, const DrivingTask& task,
                 const SpeedCeiling& ceiling)
    : vehicle_(vehicle),
      task_(task),
      ceiling_(ceiling),
      places_(merge_places(task.road_map, task.route, task.line)) {}

const MergePlace* Merging::next_place(const ViewOnLine& view) {
  const double s_m = view.at.s_m;
  while (next_ < places_.size() && s_m > places_[next_].out_s_m) {
    if (along_ != Along::route_line && scene_at(places_[next_], view, s_m).beside_m > kIsIn_m)
      break;
    ++next_;
    has_entered_ = false;
    taken_.reset();
    lines_.reset();
    has_no_lines_ = false;
    along_ = Along::route_line;
  }
  if (next_ == places_.size()) return nullptr;
  const MergePlace& place = places_[next_];
  const double to_enter_m = place.enter_s_m - s_m;
  const bool is_near = place.from_s_m - s_m < kMergeFrom_m && to_enter_m < kMergeFromMost_m;
  return is_near || to_enter_m < kMergeFrom_m ? &place : nullptr;
}

Merging::Scene Merging::scene_at(const MergePlace& place, const ViewOnLine& view,
                                 double driven_s_m) const {
  const ReferencePoint foot = task_.line.at(view.at.s_m);
  const Eigen::Vector2d left(-std::sin(foot.heading_rad), std::cos(foot.heading_rad));
  const geometry::LinePosition own = place.lane.project(foot.in_map + view.at.d_m * left);
  Scene scene{view, place, driven_s_m, own.s_m + vehicle_.front_m(), std::abs(own.d_m), {}};
  for (const MoverOnLane& mover :
       movers_on_lane(place.lane, view.traffic, view.t_s, kDrivesThere_m)) {
    scene.movers.push_back({.obstacle = mover.obstacle,
                            .behind_m = scene.front_m - mover.s_m,
                            .half_length_m = mover.half_length_m,
                            .speed_mps = mover.speed_mps});
  }
  std::ranges::sort(scene.movers, {}, &MergeMover::behind_m);
  return scene;
}

/// Whether the next lane's traffic is in its way already.
bool Merging::has_entered(const Scene& scene) const {
  if (along_ == Along::own_lane) return false;
  if (along_ == Along::next_lane) return has_entered_ || scene.beside_m < kInItsWay_m;
  const double front_s_m = scene.view.at.s_m + vehicle_.front_m();
  const bool is_past_hold = front_s_m > scene.place.hold_s_m + kBeyondHold_m;
  return has_entered_ || front_s_m > scene.place.enter_s_m || (is_past_hold && taken_);
}

/// As long as that makes no difference to the path.
void Merging::leave_route_line(const Scene& scene) {
  const double front_s_m = scene.view.at.s_m + vehicle_.front_m();
  if (lines_ || has_no_lines_ || front_s_m > scene.place.hold_s_m) return;
  auto lines = merge_lines(task_.road_map, task_.route, scene.place, task_.line_options);
  has_no_lines_ = !lines;
  if (!lines) return;
  lines_ = std::make_shared<const MergeLines>(*std::move(lines));
  along_ = Along::own_lane;
}

/// Until the body is in the way, of a change that begins now.
double Merging::to_enter_now_m(double speed_mps) const {
  constexpr double kLeast_m = 0.5;
  return std::max(kLeast_m, kUntilInTheWay * change_length_m(speed_mps) - vehicle_.front_m());
}

MergingVehicle Merging::before_places(const Scene& scene) const {
  const double speed_mps = scene.view.speed_mps;
  MergingVehicle vehicle{.length_m = vehicle_.length_m, .speed_mps = speed_mps};
  const double free_s_m = lines_ ? scene.place.out_s_m : scene.place.enter_s_m;
  vehicle.free_mps = std::max(1.0, ceiling_.at(free_s_m).speed_mps);
  if (along_ == Along::own_lane) {
    vehicle.to_enter_m = places_in_window_m(scene);
    vehicle.within_s = kGapWithin_s;
  } else if (along_ == Along::next_lane) {
    vehicle.to_enter_m = {std::max(0.0, begun_enter_m_ - scene.front_m)};
    vehicle.bears_m = kStaysBegun_m;
  } else {
    vehicle.to_enter_m = {scene.place.enter_s_m - scene.view.at.s_m - vehicle_.front_m()};
  }
  return vehicle;
}

/// The first, and from there on, at the same places in each cycle.
std::vector<double> Merging::places_in_window_m(const Scene& scene) const {
  const double speed_mps = scene.view.speed_mps;
  const double first_m = std::max(lines_->first_m, scene.front_m + to_enter_now_m(speed_mps));
  const double last_m = std::min(lines_->last_m - kUntilIn * change_length_m(speed_mps),
                                 scene.front_m + kFarthestPlace_m);
  std::vector<double> to_enter_m{first_m - scene.front_m};
  double at_m = kBetweenPlaces_m * (std::floor(first_m / kBetweenPlaces_m) + 1.0);
  for (; at_m < last_m; at_m += kBetweenPlaces_m) to_enter_m.push_back(at_m - scene.front_m);
  return to_enter_m;
}

Merging::Decision Merging::choosing(const Scene& scene) {
  const MergingVehicle vehicle = before_places(scene);
  const MergeGap gap = choose_merge_gap(vehicle, scene.movers, taken_);
  taken_.reset();
  merged_behind_.reset();
  if (!gap.is_good) {
    const Decision waits = waiting(gap, scene);
    if (along_ != Along::next_lane) return waits;
    if (waits.halt->is_hard) return entering(scene);  // too late for that
    along_ = Along::own_lane;
    return waiting(gap, scene);
  }
  taken_ = gap;
  merged_behind_ = gap.ahead;
  const bool is_now = gap.to_enter_m <= to_enter_now_m(vehicle.speed_mps);
  if (along_ == Along::own_lane && is_now) {
    along_ = Along::next_lane;
    begun_enter_m_ = scene.front_m + gap.to_enter_m;
  }
  return approaching(gap, scene);
}

/// Who comes from behind in the next lane keeps its distance, once the vehicle is there; not who is
/// too fast for that.
Merging::Decision Merging::entering(const Scene& scene) const {
  Decision decision{.along = along_,
                    .comes_behind = std::vector<bool>(scene.view.traffic.obstacles.size(), false),
                    .merged_behind = merged_behind_};
  for (const MergeMover& mover : scene.movers) {
    const double gap_m = mover.behind_m - mover.half_length_m - vehicle_.length_m;
    const double closing_mps = std::max(0.0, mover.speed_mps - scene.view.speed_mps);
    const double brakes_m = 0.5 * closing_mps * closing_mps / kOthersBrakeHard_mps2;
    decision.comes_behind[mover.obstacle] = gap_m > brakes_m;
  }
  return decision;
}

/// Drives up to a gap, in front of those who will follow.
Merging::Decision Merging::approaching(const MergeGap& gap, const Scene& scene) const {
  Decision decision{.along = along_,
                    .comes_behind = std::vector<bool>(scene.view.traffic.obstacles.size(), false)};
  bool is_behind = false;
  for (const MergeMover& mover : scene.movers) {
    is_behind = is_behind || gap.behind == mover.obstacle;
    decision.comes_behind[mover.obstacle] = is_behind;
  }
  if (along_ != Along::next_lane) decision.most_mps = gap.speed_mps;
  decision.merged_behind = gap.ahead;
  if (gap.ahead) {
    decision.reason = "merges behind " + name_of(*gap.ahead);
  } else if (gap.behind) {
    decision.reason = "merges before " + name_of(*gap.behind);
  }
  return decision;
}

double Merging::hold_s_m(const Scene& scene) const {
  if (!lines_) return scene.place.hold_s_m - vehicle_.front_m();
  return scene.driven_s_m + lines_->hold_m - scene.front_m;
}

/// A vehicle that is too fast for the place brakes harder, up to where it is in the way.
Merging::Decision Merging::waiting(const MergeGap& gap, const Scene& scene) const {
  std::string who =
      gap.lacks_ahead ? "behind " + name_of(*gap.ahead) : "before " + name_of(*gap.behind);
  if (gap.lacks_ahead && gap.lacks_behind) who += " and before " + name_of(*gap.behind);
  StopConstraint halt{.s_m = hold_s_m(scene),
                      .reason = fmt::format("no gap to merge into: {:.0f} m are missing {}",
                                            std::ceil(gap.missing_m), who)};
  const double speed_mps = scene.view.speed_mps;
  const double way_m = halt.s_m - scene.driven_s_m - speed_mps * kActuatorLag_s;
  const double needed_mps2 = 0.5 * speed_mps * speed_mps / std::max(0.5, way_m);
  halt.deceleration_mps2 = std::clamp(needed_mps2, kWaits_mps2, SafetyOptions{}.most_mps2);
  halt.is_hard = halt.deceleration_mps2 > kMostCommand_mps2;
  return {.along = along_,
          .halt = std::move(halt),
          .no_gap = NoGap{.leg = scene.place.leg, .braking_mps2 = needed_mps2}};
}

std::string Merging::name_of(std::size_t obstacle) const {
  return fmt::format("{} {}", task_.obstacles[obstacle].kind, task_.obstacles[obstacle].id);
}

Merging::Decision Merging::look(const ViewOnLine& view, double driven_s_m) {
  const MergePlace* place = next_place(view);
  if (place == nullptr) return {.merged_behind = merged_behind_};
  const Scene scene = scene_at(*place, view, driven_s_m);
  if (scene.beside_m < kIsIn_m) return {.along = along_, .merged_behind = merged_behind_};
  has_entered_ = has_entered(scene);
  if (along_ == Along::route_line && scene.movers.empty()) return {};
  if (has_entered_) return entering(scene);
  if (along_ == Along::route_line) leave_route_line(scene);
  return choosing(scene);
}

}  // namespace roadbed::planning::maneuvers
