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

// FaultStretches grow as places are added in order.
class FaultStretches {
 public:
  void add(double s_m, double value) {
    if (all_.empty() || s_m - all_.back().to_s_m > kSameStretch_m) all_.push_back({s_m, s_m, 0.0});
    all_.back().to_s_m = s_m;
    all_.back().most = std::max(all_.back().most, value);
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
    double from_s_m, to_s_m, most;
  };
  std::vector<Stretch> all_;
};

// Places on the body's outline, in its frame.
std::vector<Eigen::Vector2d> outline(const geometry::VehicleShape& vehicle) {
  std::vector<Eigen::Vector2d> places;
  const auto corners = vehicle.corners_in_vehicle();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d side = corners[(i + 1) % corners.size()] - corners[i];
    const int parts = static_cast<int>(std::ceil(side.norm() / kSidePart_m));
    for (int j = 0; j < parts; ++j) places.push_back(corners[i] + side * (1.0 * j / parts));
  }
  return places;
}

double steerable_mps(const ReferencePoint& at, const geometry::VehicleShape& vehicle) {
  const double tangent = vehicle.wheelbase_m * at.curvature_per_m;
  const double per_speed =
      vehicle.wheelbase_m * std::abs(at.curvature_d1_per_m2) / (1.0 + tangent * tangent);
  return vehicle.max_steering_rate_radps / std::max(per_speed, 1e-9);
}

void add_peaks(const ReferencePoint& at, const geometry::VehicleShape& vehicle,
               LineDriving& driving) {
  const double curvature = std::abs(at.curvature_per_m), rate = std::abs(at.curvature_d1_per_m2);
  const double speed_mps = steerable_mps(at, vehicle);
  if (curvature > driving.peak_curvature_per_m.value) {
    driving.peak_curvature_per_m = {curvature, at.s_m};
  }
  if (rate > driving.peak_curvature_rate_per_m2.value) {
    driving.peak_curvature_rate_per_m2 = {rate, at.s_m};
  }
  if (speed_mps < driving.slowest_mps.value) driving.slowest_mps = {speed_mps, at.s_m};
}

}  // namespace

double greatest_curvature_per_m(const geometry::VehicleShape& vehicle) {
  return std::tan(vehicle.max_steering_rad) / vehicle.wheelbase_m;
}

double length_of(const std::vector<LineFault>& faults) {
  double sum_m = 0.0;
  for (const LineFault& fault : faults) sum_m += kLookStep_m + fault.to_s_m - fault.from_s_m;
  return sum_m;
}

LineDriving driving_along(const LineView& line, double end_s_m,
                          const geometry::VehicleShape& vehicle,
                          const std::function<bool(const Eigen::Vector2d&)>& on_road) {
  const double limit_per_m = greatest_curvature_per_m(vehicle);
  const std::vector<Eigen::Vector2d> body = outline(vehicle);
  LineDriving driving;
  driving.slowest_mps.value = std::numeric_limits<double>::infinity();
  FaultStretches bends, leaves;
  for (double s_m = 0.0; s_m <= end_s_m; s_m += kLookStep_m) {
    const ReferencePoint at = line.at(s_m);
    add_peaks(at, vehicle, driving);
    const double curvature = std::abs(at.curvature_per_m);
    if (curvature > limit_per_m) bends.add(s_m, curvature);
    if (!on_road) continue;
    const geometry::Pose2 pose{at.in_map.x(), at.in_map.y(), at.heading_rad};
    const bool is_on_road = std::ranges::all_of(
        body, [&](const Eigen::Vector2d& place) { return on_road(pose * place); });
    if (!is_on_road) leaves.add(s_m, 0.0);
  }
  driving.bends = bends.faults([&](double most_per_m) {
    return fmt::format("bends up to {:.3f} 1/m, more than the {:.3f} 1/m that the vehicle steers",
                       most_per_m, limit_per_m);
  });
  driving.leaves = leaves.faults([](double) { return "leads the body off the road"; });
  return driving;
}

}  // namespace roadbed::planning::reference
