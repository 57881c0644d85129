#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "roadbed/control/lower_controller.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/route/route.h"

namespace roadbed::tools::inline simulation {

/// How steep a route is, from the heights of its lanes' centres; level where there are none.
class GradeProfile {
 public:
  GradeProfile(const map::RoadMap& road_map, const planning::Route& route,
               const planning::ReferenceLine& line);

  /// Grade over the 10 m around a station of the line, positive uphill.
  double grade_rad(double s_m) const;

 private:
  double height_m(double s_m) const;

  struct Height {
    double s_m, z_m;
  };
  std::vector<Height> heights_;  ///< stations increase
};

/// Turns a desired acceleration into one that the vehicle has, through throttle, brake and the
/// forces that hold it back: the detailed alternative to control::actuate().
class PedalModel {
 public:
  explicit PedalModel(GradeProfile grades) : grades_(std::move(grades)) {}

  /// Acceleration after a step [m/s²].
  double press(double desired_mps2, double speed_mps, double s_m, double step_s);

  /// Goes on along another line.
  void take_grades(GradeProfile grades) { grades_ = std::move(grades); }

  const control::Pedals& pedals() const { return pedals_; }

 private:
  GradeProfile grades_;
  control::DriveTrain train_;
  control::PedalController controller_{train_};
  control::Pedals pedals_;
  std::optional<double> force_N_;  ///< at the wheels; none: not begun, what keeps the speed
};

}  // namespace roadbed::tools::simulation
