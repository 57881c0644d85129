#include "roadbed/map/edit/elevation/road_stations.h"

#include <algorithm>
#include <cmath>

#include "roadbed/geometry/curves/plan_view.h"
#include "roadbed/map/opendrive/lane_borders.h"

namespace roadbed::map::inline edit::inline elevation {
namespace {

using Eigen::Vector2d;

Vector2d to_the_left(const geometry::Pose2& pose) {
  return {-std::sin(pose.heading_rad), std::cos(pose.heading_rad)};
}

bool is_carriageway(LaneType type) {
  return type != LaneType::sidewalk && type != LaneType::curb && type != LaneType::median &&
         type != LaneType::none;
}

/// From the right to the left; empty: reversed.
struct Width {
  double right_t_m = INFINITY, left_t_m = -INFINITY;

  bool empty() const { return right_t_m > left_t_m; }
  void extend(double t_m) {
    right_t_m = std::min(right_t_m, t_m);
    left_t_m = std::max(left_t_m, t_m);
  }
};

class Stations {
 public:
  Stations(const opendrive::RoadRecord& road, const Vector2d& origin_in_source, double apart_m)
      : road_(road), plan_view_(road.plan_pieces), origin_(origin_in_source), apart_m_(apart_m) {}

  std::vector<RoadStation> run() {
    std::vector<RoadStation> stations{at(0.0)};
    for (double s_m = apart_m_; s_m < road_.length_m - 0.25 * apart_m_; s_m += apart_m_) {
      stations.push_back(at(s_m));
    }
    stations.push_back(at(road_.length_m));
    return stations;
  }

 private:
  RoadStation at(double s_m) {
    RoadStation station{s_m, plan_view_.at(s_m).pose};
    const Width width = width_at(s_m, station.reference_in_source);
    if (!width.empty()) station.right_t_m = width.right_t_m, station.left_t_m = width.left_t_m;
    station.reference_in_source.x_m += origin_.x();
    station.reference_in_source.y_m += origin_.y();
    return station;
  }

  Width width_at(double s_m, const geometry::Pose2& reference) {
    while (section_ + 1 < road_.sections.size() && road_.sections[section_ + 1].s_m <= s_m) {
      ++section_;
    }
    Width driven, all;
    if (road_.sections.empty()) return all;
    for (const int sign : {1, -1}) {
      const opendrive::SectionSide side = opendrive::section_side(road_, section_, sign);
      opendrive::SideBorders borders(road_, plan_view_, side);
      borders.enter(s_m, s_m);
      borders.evaluate(s_m, row_);
      for (std::size_t i = 0; i < side.lanes.size(); ++i) {
        for (const std::size_t border : {i, i + 1}) {
          const double t_m =
              (row_.border_in_map[border] - reference.position()).dot(to_the_left(reference));
          all.extend(t_m);
          if (is_carriageway(side.lanes[i]->type)) driven.extend(t_m);
        }
      }
    }
    return driven.empty() ? all : driven;
  }

  const opendrive::RoadRecord& road_;
  const geometry::PlanView plan_view_;
  const Vector2d origin_;
  double apart_m_;
  std::size_t section_ = 0;
  opendrive::CrossSection row_;
};

}  // namespace

double RoadStation::t_m(std::size_t place) const {
  return std::lerp(right_t_m, left_t_m, static_cast<double>(place) / (kPlaces - 1));
}

Vector2d RoadStation::place_in_source(double t_m) const {
  return reference_in_source.position() + t_m * to_the_left(reference_in_source);
}

CrossLine RoadStation::line_through(
    const std::array<std::optional<double>, kPlaces>& heights_m) const {
  constexpr double kLeastWidthM = 1.0;
  constexpr std::size_t kFewest = 3;
  double count = 0.0, t_sum = 0.0, z_sum = 0.0;
  std::size_t first = kPlaces, last = 0;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    if (!heights_m[i]) continue;
    count += 1.0, t_sum += t_m(i), z_sum += *heights_m[i];
    first = std::min(first, i), last = i;
  }
  if (count < kFewest) return {};
  const double t_mean = t_sum / count, z_mean = z_sum / count;
  if (left_t_m - right_t_m < kLeastWidthM) return {z_mean, {}};
  if (2 * (last - first) < kPlaces - 1) return {};
  double squares = 0.0, products = 0.0;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    if (!heights_m[i]) continue;
    squares += (t_m(i) - t_mean) * (t_m(i) - t_mean);
    products += (t_m(i) - t_mean) * (*heights_m[i] - z_mean);
  }
  const double slope = products / squares;
  return {z_mean - slope * t_mean, slope};
}

std::vector<RoadStation> stations_of(const opendrive::RoadRecord& road,
                                     const Vector2d& origin_in_source, double apart_m) {
  return Stations(road, origin_in_source, apart_m).run();
}

}  // namespace roadbed::map::edit::elevation
