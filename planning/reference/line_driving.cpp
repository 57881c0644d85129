#include "roadbed/planning/reference/line_driving.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "roadbed/geometry/primitives/pose2.h"

namespace roadbed::planning::inline reference {
namespace {

constexpr double kLookStep_m = 0.25;
constexpr double kSidePart_m = 0.5;  // between places of the body's outline
constexpr double kSameStretch_m = 2.0;
constexpr double kSteeringShare = 0.9;  // of the greatest curvature

// Of a vehicle, at one place or most on a stretch.
struct Asked {
  double curvature_per_m = 0.0, speed_mps = std::numeric_limits<double>::infinity();
};

// FaultStretches grow as places are added in order.
class FaultStretches {
 public:
  void add(double s_m, const Asked& asked) {
    if (all_.empty() || s_m - all_.back().to_s_m > kSameStretch_m) all_.push_back({s_m, s_m, {}});
    Stretch& last = all_.back();
    last.to_s_m = s_m;
    last.most = {std::max(last.most.curvature_per_m, asked.curvature_per_m),
                 std::min(last.most.speed_mps, asked.speed_mps)};
  }

  template <typename Reason>
  std::vector<LineFault> faults(const Reason& reason) const {
    std::vector<LineFault> result;
    for (const Stretch& stretch : all_) {
      result.push_back({stretch.from_s_m, stretch.to_s_m, reason(stretch.most)});
    }
    return result;
  }

 private:
  struct Stretch {
    double from_s_m, to_s_m;
    Asked most;
  };
  std::vector<Stretch> all_;
};

void add_peaks(const ReferencePoint& at, const geometry::VehicleShape& vehicle,
               LineDriving& driving) {
  const double curvature = std::abs(at.curvature_per_m), rate = std::abs(at.curvature_d1_per_m2);
  const double speed_mps = steerable_mps(at.curvature_per_m, at.curvature_d1_per_m2, vehicle);
  if (curvature > driving.peak_curvature_per_m.value) {
    driving.peak_curvature_per_m = {curvature, at.s_m};
  }
  if (rate > driving.peak_curvature_rate_per_m2.value) {
    driving.peak_curvature_rate_per_m2 = {rate, at.s_m};
  }
  if (speed_mps < driving.slowest_mps.value) driving.slowest_mps = {speed_mps, at.s_m};
}

}  // namespace

double drivable_curvature_per_m(const geometry::VehicleShape& vehicle) {
  return kSteeringShare * std::tan(vehicle.max_steering_rad) / vehicle.wheelbase_m;
}

double steerable_mps(double curvature_per_m, double rate_per_m2,
                     const geometry::VehicleShape& vehicle) {
  const double tangent = vehicle.wheelbase_m * curvature_per_m;
  const double per_speed = vehicle.wheelbase_m * std::abs(rate_per_m2) / (1.0 + tangent * tangent);
  return vehicle.max_steering_rate_radps / std::max(per_speed, 1e-9);
}

std::vector<Eigen::Vector2d> body_outline(const geometry::VehicleShape& vehicle) {
  std::vector<Eigen::Vector2d> places;
  const auto corners = vehicle.corners_in_vehicle();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d side = corners[(i + 1) % corners.size()] - corners[i];
    const int parts = static_cast<int>(std::ceil(side.norm() / kSidePart_m));
    for (int j = 0; j < parts; ++j) places.push_back(corners[i] + side * (1.0 * j / parts));
  }
  return places;
}

double length_of(const std::vector<LineFault>& faults) {
  double sum_m = 0.0;
  for (const LineFault& fault : faults) sum_m += kLookStep_m + fault.to_s_m - fault.from_s_m;
  return sum_m;
}

std::vector<std::string> notes_on(const std::vector<LineFault>& faults) {
  std::vector<std::string> notes;
  for (const LineFault& fault : faults) {
    notes.push_back(fmt::format("from {:.1f} m to {:.1f} m the line {}", fault.from_s_m,
                                fault.to_s_m, fault.reason));
  }
  return notes;
}

LineDriving driving_along(const LineView& line, double end_s_m,
                          const geometry::VehicleShape& vehicle,
                          const std::function<bool(const Eigen::Vector2d&)>& on_road) {
  const double limit_per_m = drivable_curvature_per_m(vehicle);
  const std::vector<Eigen::Vector2d> body = body_outline(vehicle);
  LineDriving driving;
  driving.slowest_mps.value = std::numeric_limits<double>::infinity();
  FaultStretches bends, leaves;
  for (double s_m = 0.0; s_m <= end_s_m; s_m += kLookStep_m) {
    const ReferencePoint at = line.at(s_m);
    add_peaks(at, vehicle, driving);
    const double curvature = std::abs(at.curvature_per_m);
    const double speed_mps = steerable_mps(curvature, at.curvature_d1_per_m2, vehicle);
    if (curvature > limit_per_m || speed_mps < kWalkingSpeed_mps) {
      bends.add(s_m, {curvature, speed_mps});
    }
    if (!on_road) continue;
    const geometry::Pose2 pose{at.in_map.x(), at.in_map.y(), at.heading_rad};
    const bool is_on_road = std::ranges::all_of(
        body, [&](const Eigen::Vector2d& place) { return on_road(pose * place); });
    if (!is_on_road) leaves.add(s_m, {});
  }
  driving.bends = bends.faults([&](const Asked& most) {
    return most.curvature_per_m > limit_per_m
               ? fmt::format(
                     "bends up to {:.3f} 1/m, more than the {:.3f} 1/m that are driven of "
                     "the {:.3f} 1/m that the vehicle steers",
                     most.curvature_per_m, limit_per_m, limit_per_m / kSteeringShare)
               : fmt::format("can be steered at {:.2f} m/s at most", most.speed_mps);
  });
  driving.leaves = leaves.faults([](const Asked&) { return "leads the body off the road"; });
  return driving;
}

}  // namespace roadbed::planning::reference
