#include "roadbed/map/repair/lane_seam.h"

#include <algorithm>
#include <cmath>

#include "roadbed/map/opendrive/rules/lane_links.h"

namespace roadbed::map::inline repair {
namespace {

using opendrive::ContactPoint;
using opendrive::CubicElement;
using opendrive::LaneRecord;
using opendrive::rules::linked_lanes;

constexpr double kStationRounding_m = 1e-3;

double station_m(const SeamSide& side) {
  return side.end == ContactPoint::start ? side.section->s_m : side.road->end_s_m(*side.section);
}

/// Of the record that holds on this side of the seam.
std::optional<double> value_at_seam(const std::vector<CubicElement>& listed, const SeamSide& side) {
  const double s_m = station_m(side);
  const bool begins = side.end == ContactPoint::start;
  const double last_s_m = begins ? s_m + kStationRounding_m : s_m - kStationRounding_m;
  std::optional<double> value;
  for (const CubicElement& element : opendrive::rules::whole(listed)) {
    if (element.record.s_m > last_s_m) break;
    value = geometry::cubic_at(element.record, s_m).value;
  }
  return value;
}

std::optional<double> outer_t_m(const LaneRecord& lane, double inner_t_m, double offset_m,
                                const SeamSide& side) {
  const bool by_width = !lane.width.listed.empty() || lane.border.listed.empty();
  const auto value = value_at_seam(by_width ? lane.width.listed : lane.border.listed, side);
  if (!value) return {};
  if (!by_width) return offset_m + *value;
  return lane.id > 0 ? inner_t_m + *value : inner_t_m - *value;
}

/// Whether a lane neither names lanes over the seam nor is named by any.
bool is_free(const LaneRecord& lane, const SeamSide& here, const SeamSide& there) {
  const auto names_it = [&](const LaneRecord& other) {
    return std::ranges::count(linked_lanes(other, there.end), lane.id) > 0;
  };
  return here.section->lanes.count(lane.id) == 1 && linked_lanes(lane, here.end).empty() &&
         std::ranges::none_of(there.section->listed(), names_it);
}

bool corners_meet(const SeamLanes& lanes, const SeamSide& here, const SeamSide& there,
                  double tolerance_m) {
  const auto a = lane_corners(here, lanes.here->id), b = lane_corners(there, lanes.there->id);
  if (!a || !b) return false;
  const auto has_width = [](const LaneCorners& corners) {
    return std::abs(corners.outer_t_m - corners.inner_t_m) >= opendrive::rules::kNoWidthM;
  };
  const auto meet = [&](double t_here_m, double t_there_m) {
    const Eigen::Vector2d corner_here = here.map_from_line * Eigen::Vector2d(0.0, t_here_m);
    const Eigen::Vector2d corner_there = there.map_from_line * Eigen::Vector2d(0.0, t_there_m);
    return (corner_here - corner_there).norm() <= tolerance_m;
  };
  return has_width(*a) && has_width(*b) && meet(a->inner_t_m, b->inner_t_m) &&
         meet(a->outer_t_m, b->outer_t_m);
}

}  // namespace

std::vector<SeamLanes> free_lanes(const SeamSide& here, const SeamSide& there) {
  std::vector<SeamLanes> found;
  for (const LaneRecord& lane : here.section->listed()) {
    const LaneRecord* next = there.section->find(here.end == there.end ? -lane.id : lane.id);
    if (lane.id == 0 || next == nullptr || next->type != lane.type) continue;
    if (is_free(lane, here, there) && is_free(*next, there, here)) found.push_back({&lane, next});
  }
  return found;
}

std::vector<SeamLanes> meeting_lanes(const SeamSide& here, const SeamSide& there,
                                     double tolerance_m) {
  std::vector<SeamLanes> found = free_lanes(here, there);
  std::erase_if(found, [&](const SeamLanes& lanes) {
    return !corners_meet(lanes, here, there, tolerance_m);
  });
  return found;
}

std::optional<LaneCorners> lane_corners(const SeamSide& side, int lane) {
  const int step = lane > 0 ? 1 : -1;
  const double offset_m = value_at_seam(side.road->record.lane_offset.listed, side).value_or(0.0);
  LaneCorners corners{offset_m, offset_m};
  for (int id = step;; id += step) {
    if (side.section->lanes.count(id) != 1) return {};
    const auto outer = outer_t_m(*side.section->find(id), corners.outer_t_m, offset_m, side);
    if (!outer) return {};
    corners = {corners.outer_t_m, *outer};
    if (id == lane) return corners;
  }
}

}  // namespace roadbed::map::repair
