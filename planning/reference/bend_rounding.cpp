#include "roadbed/planning/reference/bend_rounding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "roadbed/geometry/primitives/cross.h"
#include "roadbed/planning/reference/bezier_places.h"
#include "roadbed/planning/reference/line_driving.h"

namespace roadbed::planning::inline reference {
namespace {

using Eigen::Vector2d;
using geometry::CurvePoint;
using geometry::QuinticBezier;
using geometry::VehicleShape;

constexpr double kReaches_m[] = {0.5, 1, 1.5, 2, 2.5, 3, 4, 5, 6, 7, 8, 10, 12, 14, 17, 20};
constexpr double kReachRatios[] = {1.0, 0.5, 2.0};  // behind the bend, of that before it
constexpr int kParts = 12;                          // of the first gap to the leg, up to a half
constexpr int kPlaces = 60;                         // of a curve that are looked at
constexpr double kReserve = 0.97;                   // for what the line differs from the curve
constexpr double kMostTurn_rad = 200.0 / 180.0 * std::numbers::pi;
constexpr double kLegTurn_rad = 150.0 / 180.0 * std::numbers::pi, kParallel_rad = 0.1;

struct Legs {
  double from_m, to_m;
};

// To where the tangents meet; where they do not, such that a half circle is about one.
Legs legs_of(const CurvePoint& from, const CurvePoint& to) {
  const Vector2d chord = to.position - from.position;
  const Vector2d u(std::cos(from.heading_rad), std::sin(from.heading_rad));
  const Vector2d v(std::cos(to.heading_rad), std::sin(to.heading_rad));
  const double turn_rad = std::abs(to.heading_rad - from.heading_rad), longest_m = 3 * chord.norm();
  if (turn_rad > kParallel_rad && turn_rad < kLegTurn_rad) {
    const Legs legs{geometry::cross(chord, v) / geometry::cross(u, v),
                    geometry::cross(u, chord) / geometry::cross(u, v)};
    if (std::min(legs.from_m, legs.to_m) > 0.0 && std::max(legs.from_m, legs.to_m) < longest_m) {
      return legs;
    }
  }
  const double share = turn_rad > kLegTurn_rad ? 1.0 : 0.5;
  return {share * chord.norm(), share * chord.norm()};
}

// One curve of the grid, and at least how far its body is outside, as far as that has been looked
// at.
struct Trial {
  RoundedBend bend;
  double peak_rate_per_m2;
  std::vector<BezierPlace> places;
};

class Search {
 public:
  Search(const BendQuestion& question, const VehicleShape& vehicle)
      : question_(question), vehicle_(vehicle), body_(body_outline(vehicle)) {}

  BendChoice choose() {
    for (const double reach_m : kReaches_m) {
      for (const double ratio : kReachRatios) try_between(reach_m, ratio * reach_m);
    }
    std::ranges::stable_sort(trials_, {}, &Trial::peak_rate_per_m2);
    for (const double outside_m : question_.steps_m) {
      for (Trial& trial : trials_) {
        if (keeps_within(trial, outside_m)) return {trial.bend, {}};
      }
    }
    return {std::nullopt, reason()};
  }

 private:
  void try_between(double before_m, double behind_m) {
    const double from_s_m = std::max(question_.from_s_m - before_m, question_.least_s_m);
    const double to_s_m = std::min(question_.to_s_m + behind_m, question_.most_s_m);
    const CurvePoint from = question_.curve.at(from_s_m), to = question_.curve.at(to_s_m);
    if (std::abs(to.heading_rad - from.heading_rad) > kMostTurn_rad) return;
    const Legs legs = legs_of(from, to);
    for (int i = 1; i < kParts; ++i) {
      const double part = 0.5 * i / kParts;
      add({from_s_m, to_s_m, QuinticBezier::joining(from, part * legs.from_m, to, part * legs.to_m),
           -1e9});
    }
  }

  void add(const RoundedBend& bend) {
    ++looked_at_;
    double curvature = 0.0, rate = 0.0, slowest_mps = 1e9;
    std::vector<BezierPlace> places = places_on(bend.curve, kPlaces);
    for (const BezierPlace& place : places) {
      curvature = std::max(curvature, std::abs(place.curvature_per_m));
      rate = std::max(rate, std::abs(place.rate_per_m2));
      slowest_mps =
          std::min(slowest_mps, steerable_mps(place.curvature_per_m, place.rate_per_m2, vehicle_));
    }
    if (!(curvature <= kReserve * drivable_curvature_per_m(vehicle_))) {
      ++too_bent_;
    } else if (!(kReserve * slowest_mps >= kWalkingSpeed_mps)) {
      ++too_quick_;
    } else {
      trials_.push_back({bend, rate, std::move(places)});
    }
  }

  // From the middle to the ends: what is outside mostly is so in the bend.
  bool keeps_within(Trial& trial, double most_m) const {
    if (trial.bend.outside_m > most_m) return false;
    const std::size_t count = trial.places.size(), middle = count / 2;
    double outside_m = -1e9;
    for (std::size_t i = 0; i < count && outside_m <= most_m; ++i) {
      const std::size_t at = i % 2 == 0 ? middle - i / 2 : middle + (i + 1) / 2;
      const std::size_t k = std::min(at, count - 1);
      const double part = static_cast<double>(k) / static_cast<double>(count - 1);
      outside_m = std::max(outside_m,
                           body_outside_m(trial.places[k].pose,
                                          std::lerp(trial.bend.from_s_m, trial.bend.to_s_m, part)));
    }
    trial.bend.outside_m = outside_m;
    return outside_m <= most_m;
  }

  double body_outside_m(const geometry::Pose2& pose, double s_m) const {
    double outside_m = -1e9;
    for (const Vector2d& place : body_) {
      outside_m = std::max(outside_m, question_.outside_m(pose * place, s_m + place.x()));
    }
    return outside_m;
  }

  std::string reason() const {
    return fmt::format(
        "none of {} curves will do: {} bend more than can be steered, {} would have to be steered "
        "faster than the wheels turn at {:.1f} m/s, {} leave the road",
        looked_at_, too_bent_, too_quick_, kWalkingSpeed_mps, trials_.size());
  }

  const BendQuestion& question_;
  const VehicleShape& vehicle_;
  std::vector<Vector2d> body_;
  std::vector<Trial> trials_;
  int looked_at_ = 0, too_bent_ = 0, too_quick_ = 0;
};

}  // namespace

BendChoice round_bend(const BendQuestion& question, const VehicleShape& vehicle) {
  return Search(question, vehicle).choose();
}

}  // namespace roadbed::planning::reference
