#include "roadbed/map/occupancy/ground/ground.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace roadbed::map::inline occupancy::inline ground {
namespace {

std::vector<Eigen::Vector2d> points_of(const std::vector<GroundPlace>& places) {
  std::vector<Eigen::Vector2d> points;
  for (const GroundPlace& place : places) points.push_back(place.in_source);
  return points;
}

void check(const std::vector<GroundPlace>& places) {
  if (places.empty()) throw std::invalid_argument("Ground: needs at least 1 place, got 0");
  for (const GroundPlace& place : places) {
    if (std::isfinite(place.z_m) && place.slope.allFinite()) continue;
    throw std::invalid_argument("Ground: a height or slope is not finite");
  }
}

}  // namespace

Ground::Ground(std::vector<GroundPlace> places)
    : places_(std::move(places)), index_(points_of(places_)) {
  check(places_);
  const auto [lowest, highest] = std::ranges::minmax_element(places_, {}, &GroundPlace::z_m);
  lowest_m_ = lowest->z_m;
  highest_m_ = highest->z_m;
}

double Ground::height_m(const Eigen::Vector2d& in_source) const {
  const GroundPlace& place = places_[index_.nearest(in_source)->index];
  return place.z_m + place.slope.dot(in_source - place.in_source);
}

bool Ground::is_level() const {
  return lowest_m_ == highest_m_ && std::ranges::all_of(places_, [](const GroundPlace& place) {
           return place.slope.isZero(0.0);
         });
}

}  // namespace roadbed::map::occupancy::ground
