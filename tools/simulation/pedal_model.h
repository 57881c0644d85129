#pragma once

#include <optional>
#include <utility>

#include "roadbed/control/pedals.h"
#include "roadbed/tools/simulation/grade_profile.h"

namespace roadbed::tools::inline simulation {

/// Turns a desired acceleration into one that the vehicle has, through throttle, brake and the
/// forces that hold it back: the longer way round for control::actuate().
class PedalModel {
 public:
  explicit PedalModel(GradeProfile grades) : grades_(std::move(grades)) {}

  /// Acceleration after a step [m/s²].
  double press(double desired_mps2, double speed_mps, double s_m, double step_s);

  const control::Pedals& pedals() const { return pedals_; }

 private:
  GradeProfile grades_;
  control::DriveTrain train_;
  control::PedalController controller_{train_};
  control::Pedals pedals_;
  std::optional<double> force_N_;  ///< at the wheels; none: not begun, what keeps the speed
};

}  // namespace roadbed::tools
