#include "roadbed/tools/simulation/pedal_model.h"

namespace roadbed::tools::inline simulation {

double PedalModel::press(double desired_mps2, double speed_mps, double s_m, double step_s) {
  const double grade_rad = grades_.grade_rad(s_m);
  if (!force_N_) force_N_ = control::resistance_N(speed_mps, grade_rad, train_);
  pedals_ = controller_.update(desired_mps2, speed_mps, grade_rad);
  force_N_ = control::drive({speed_mps, *force_N_}, pedals_, grade_rad, step_s, train_).force_N;
  return control::acceleration_mps2({speed_mps, *force_N_}, grade_rad, train_);
}

}  // namespace roadbed::tools
