#include "roadbed/map/argoverse/frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "roadbed/map/elements/lane_lines.h"

namespace roadbed::map::argoverse {
namespace {

constexpr double kOnGround_m = 0.3;  // what the data set takes as a point of the ground

}  // namespace

void Frame::to_map(Line3& points) {
  for (Eigen::Vector3d& point : points) {
    if (!origin_) origin_ = origin_near(point.head<2>());
    set_height(point);
    point.head<2>() -= *origin_;
  }
}

void Frame::set_height(Eigen::Vector3d& point) {
  const auto ground_m = ground_ ? ground_->at_m(point.head<2>()) : std::nullopt;
  if (std::isnan(point.z())) {
    point.z() = ground_m.value_or(0.0);
    filled_ += ground_m ? 1 : 0;
  } else if (ground_m) {
    const double off_m = std::abs(point.z() - *ground_m);
    ++compared_;
    far_ += off_m > kOnGround_m ? 1 : 0;
    farthest_m_ = std::max(farthest_m_, off_m);
  }
}

void Frame::report(RoadMapParts& parts) const {
  parts.origin_in_source = origin_in_source();
  if (!ground_) return;
  parts.attributes.emplace_back("ground_height", ground_->file());
  parts.remarks.push_back(
      {"import.ground-height", false, "file", 0,
       fmt::format("{} points have their height from {}; of {} others {} are more than {} m from "
                   "it, at most {:.2f} m",
                   filled_, ground_->file(), compared_, far_, kOnGround_m, farthest_m_)});
}

}  // namespace roadbed::map::argoverse
