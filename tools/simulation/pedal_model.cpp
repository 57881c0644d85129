#include "roadbed/tools/simulation/pedal_model.h"

#include <algorithm>
#include <cmath>

namespace roadbed::tools::inline simulation {
namespace {

constexpr double kApart_m = 1.0;  // least, between heights
constexpr double kHalfBase_m = 5.0;

}  // namespace

double PedalModel::press(double desired_mps2, double speed_mps, double s_m, double step_s) {
  const double grade_rad = grades_.grade_rad(s_m);
  if (!force_N_) force_N_ = control::resistance_N(speed_mps, grade_rad, train_);
  pedals_ = controller_.update(desired_mps2, speed_mps, grade_rad);
  force_N_ = control::drive({speed_mps, *force_N_}, pedals_, grade_rad, step_s, train_).force_N;
  return control::acceleration_mps2({speed_mps, *force_N_}, grade_rad, train_);
}

GradeProfile::GradeProfile(const map::RoadMap& road_map, const planning::Route& route,
                           const planning::ReferenceLine& line) {
  for (const planning::RouteLeg& leg : route.legs) {
    const map::LaneLine& centre = road_map.lane(leg.lane).centre;
    const auto& points = centre.in_map.points();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::size_t at = leg.reversed ? points.size() - 1 - i : i;
      const double s_m = line.project(points[at]).s_m;
      if (!heights_.empty() && s_m < heights_.back().s_m + kApart_m) continue;
      heights_.push_back({s_m, centre.z_m[at]});
    }
  }
}

double GradeProfile::height_m(double s_m) const {
  const auto after = std::ranges::upper_bound(heights_, s_m, {}, &Height::s_m);
  if (after == heights_.begin()) return heights_.front().z_m;
  if (after == heights_.end()) return heights_.back().z_m;
  const Height& before = *std::prev(after);
  const double ratio = (s_m - before.s_m) / (after->s_m - before.s_m);
  return before.z_m + ratio * (after->z_m - before.z_m);
}

double GradeProfile::grade_rad(double s_m) const {
  if (heights_.empty()) return 0.0;
  return std::atan((height_m(s_m + kHalfBase_m) - height_m(s_m - kHalfBase_m)) /
                   (2.0 * kHalfBase_m));
}

}  // namespace roadbed::tools::simulation
