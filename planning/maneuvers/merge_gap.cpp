#include "roadbed/planning/maneuvers/merge_gap.h"

#include <algorithm>
#include <cmath>

namespace roadbed::planning::inline maneuvers {
namespace {

constexpr double kComfortSpeedUp_mps2 = 0.9,
                 kComfortBraking_mps2 = 1.5;  // the vehicle, comfortably
constexpr double kIntoGap_mps2 = 0.8;         // slowing down to the gap's speed, at the end
constexpr double kSettled_s = 1.0;
constexpr double kFollowerBraking_mps2 = 2.0;
constexpr double kMergeAhead_m = 1.0, kMergeAhead_s = 0.5;
constexpr double kMergeSpeedStep_mps = 0.5, kSlowestMerge_mps = 1.0;
constexpr double kForEachSlower_s = 0.3;  // m/s

/// A change of speed on the way.
struct SpeedChange {
  double duration_s, length_m;
};

SpeedChange speed_change(double from_mps, double to_mps, double braking_mps2) {
  const double rate_mps2 = to_mps > from_mps ? kComfortSpeedUp_mps2 : braking_mps2;
  const double duration_s = std::abs(to_mps - from_mps) / rate_mps2;
  return {duration_s, 0.5 * (from_mps + to_mps) * duration_s};
}

struct MergeArrival {
  double after_s, speed_mps;
  double next_mps;  ///< to drive at for now
};

/// By way of one speed to another; none: that takes more than there is. Who slows down to the gap's
/// speed has it some time before.
std::optional<MergeArrival> arrival_by(const MergingVehicle& vehicle, double to_enter_m,
                                       double by_mps, double at_mps) {
  const double settled_s = at_mps < by_mps ? kSettled_s : 0.0;
  const double way_m = std::max(0.0, to_enter_m - settled_s * at_mps);
  const SpeedChange first = speed_change(vehicle.speed_mps, by_mps, kComfortBraking_mps2);
  const SpeedChange last = speed_change(by_mps, at_mps, kIntoGap_mps2);
  const double kept_m = way_m - first.length_m - last.length_m;
  if (kept_m >= 0.0 && by_mps > 0.0) {
    const double after_s = first.duration_s + kept_m / by_mps + last.duration_s + settled_s;
    return MergeArrival{after_s, at_mps, by_mps};
  }
  // Who speeds up goes on with that in the gap; who is too fast has to slow down before.
  const bool speeds_up = at_mps > by_mps;
  const double left_m = std::max(0.0, to_enter_m) - first.length_m;
  if (first.length_m > 0.0 && (left_m < 0.0 || !speeds_up)) return std::nullopt;
  const double rate_mps2 = speeds_up ? kComfortSpeedUp_mps2 : -kIntoGap_mps2;
  const double speed_mps = std::sqrt(std::max(0.0, by_mps * by_mps + 2.0 * rate_mps2 * left_m));
  const double after_s = first.duration_s + (speed_mps - by_mps) / rate_mps2;
  return MergeArrival{after_s, speed_mps, by_mps < vehicle.speed_mps ? by_mps : at_mps};
}

using MergeMovers = std::vector<MergeMover>;

/// Between the movers i − 1 and i of the list.
MergeGap merge_gap_at(const MergingVehicle& vehicle, const MergeMovers& movers, std::size_t i,
                      double enter_m, const MergeArrival& arrival) {
  MergeGap gap{.speed_mps = arrival.next_mps, .to_enter_m = enter_m, .after_s = arrival.after_s};
  const auto to_enter_m = [&](const MergeMover& mover) {
    return enter_m + mover.behind_m - mover.speed_mps * arrival.after_s;
  };
  double lacks_ahead_m = 0.0, lacks_behind_m = 0.0;
  if (i > 0) {
    const MergeMover& ahead = movers[i - 1];
    gap.ahead = ahead.obstacle;
    lacks_ahead_m =
        room_ahead_m(arrival.speed_mps, ahead.speed_mps) + to_enter_m(ahead) + ahead.half_length_m;
  }
  if (i < movers.size()) {
    const MergeMover& behind = movers[i];
    gap.behind = behind.obstacle;
    lacks_behind_m = room_behind_m(arrival.speed_mps, behind.speed_mps) + vehicle.length_m -
                     to_enter_m(behind) + behind.half_length_m;
  }
  gap.lacks_ahead = lacks_ahead_m > 0.0;
  gap.lacks_behind = lacks_behind_m > 0.0;
  gap.missing_m = std::max(0.0, lacks_ahead_m) + std::max(0.0, lacks_behind_m);
  gap.is_good = gap.missing_m <= 0.0;
  return gap;
}

double speed_in_gap_mps(const MergingVehicle& vehicle, const MergeMovers& movers, std::size_t i) {
  if (i == 0) return vehicle.free_mps;
  return std::clamp(movers[i - 1].speed_mps, kSlowestMerge_mps, vehicle.free_mps);
}

std::vector<double> speeds_to_try(const MergingVehicle& vehicle) {
  std::vector<double> speeds;
  for (double mps = vehicle.free_mps; mps >= kSlowestMerge_mps; mps -= kMergeSpeedStep_mps) {
    speeds.push_back(mps);
  }
  const bool may_keep =
      vehicle.speed_mps >= kSlowestMerge_mps && vehicle.speed_mps <= vehicle.free_mps;
  if (may_keep) speeds.push_back(vehicle.speed_mps);
  std::ranges::sort(speeds, std::greater<>());
  return speeds;
}

bool is_same_gap(const MergeGap& gap, const std::optional<MergeGap>& taken) {
  return taken && gap.ahead == taken->ahead && gap.behind == taken->behind;
}

/// Until the merging point, speed that is lost by then counted in.
double lateness_s(const MergingVehicle& vehicle, const MergeGap& gap) {
  return gap.after_s + kForEachSlower_s * std::max(0.0, vehicle.speed_mps - gap.speed_mps);
}

/// The best so far, of the ways into one gap, or any.
struct BestGap {
  std::optional<MergeGap> gap = {};
  double late_s = 0.0;

  /// Of those that miss nothing the soonest, else the one that misses least.
  void improve(const MergeGap& other, double other_late_s) {
    const bool is_better =
        !gap ||
        (other.is_good && gap->is_good ? other_late_s < late_s : other.missing_m < gap->missing_m);
    if (is_better) *this = {other, other_late_s};
  }
};

}  // namespace

double room_ahead_m(double own_mps, double ahead_mps) {
  const double closing_mps = std::max(0.0, own_mps - ahead_mps);
  return kMergeAhead_m + kMergeAhead_s * std::max(0.0, ahead_mps) +
         0.5 * closing_mps * closing_mps / kComfortBraking_mps2;
}

double room_behind_m(double own_mps, double behind_mps) {
  constexpr double kStandstill_m = 2.0, kHeadway_s = 1.2, kIdmSpeedsUp_mps2 = 1.5,
                   kIdmBrakes_mps2 = 2.0;
  const double speed_mps = std::max(0.0, behind_mps);
  const double dynamic_m =
      speed_mps * kHeadway_s +
      speed_mps * (speed_mps - own_mps) / (2.0 * std::sqrt(kIdmSpeedsUp_mps2 * kIdmBrakes_mps2));
  const double wanted_m = kStandstill_m + std::max(0.0, dynamic_m);
  return wanted_m / std::sqrt(1.0 + kFollowerBraking_mps2 / kIdmSpeedsUp_mps2);
}

MergeGap choose_merge_gap(const MergingVehicle& vehicle, const MergeMovers& movers,
                          const std::optional<MergeGap>& taken) {
  BestGap best, kept;
  const auto look_at_gaps = [&](double to_enter_m, double by_mps, double within_s) {
    for (std::size_t i = 0; i <= movers.size(); ++i) {
      const auto there =
          arrival_by(vehicle, to_enter_m, by_mps, speed_in_gap_mps(vehicle, movers, i));
      if (!there || there->after_s > within_s) continue;
      const MergeGap gap = merge_gap_at(vehicle, movers, i, to_enter_m, *there);
      const double late_s = lateness_s(vehicle, gap);
      best.improve(gap, late_s);
      if (is_same_gap(gap, taken)) kept.improve(gap, late_s);
    }
  };
  const std::vector<double> speeds = speeds_to_try(vehicle);
  for (const double to_enter_m : vehicle.to_enter_m) {
    for (const double by_mps : speeds) look_at_gaps(to_enter_m, by_mps, vehicle.within_s);
  }
  // Too near to take on any other speed before the merging point, or too far.
  constexpr double kEver_s = std::numeric_limits<double>::infinity();
  if (!best.gap) look_at_gaps(vehicle.to_enter_m.front(), vehicle.speed_mps, kEver_s);
  if (!kept.gap || kept.gap->missing_m > vehicle.bears_m) return best.gap.value();
  kept.gap->is_good = true;
  return *kept.gap;
}

}  // namespace roadbed::planning::maneuvers
