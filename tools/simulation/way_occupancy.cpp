#include "roadbed/tools/simulation/way_occupancy.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "roadbed/tools/simulation/lead.h"

namespace roadbed::tools {
namespace {

using geometry::Rectangle;

/// Samples that can be passed over: the body comes nearer by no more than what it drives.
std::size_t samples_to_skip(const DrivenWay& way, std::size_t from, double too_far_m) {
  std::size_t next = from + 1;
  while (next < way.ahead_m.size() && way.ahead_m[next] - way.ahead_m[from] < too_far_m) ++next;
  return next - from;
}

/// The part of the way from the first to the last sample that touches.
std::optional<Blocked> blocked_part(const DrivenWay& way, const Rectangle& obstacle,
                                    double margin_m) {
  std::optional<Blocked> part;
  for (std::size_t i = 0; i < way.body.size();) {
    const Rectangle& body = way.body[i];
    const double apart = (body.centre - obstacle.centre).norm();
    const double too_far = apart - body.radius_m() - obstacle.radius_m() - margin_m;
    if (too_far > 0.0) {
      i += samples_to_skip(way, i, too_far);
      continue;
    }
    if (geometry::distance_m(body, obstacle) <= margin_m) {
      if (!part) part = Blocked{.from_m = way.ahead_m[i > 0 ? i - 1 : 0]};
      part->to_m = way.ahead_m[std::min(i + 1, way.ahead_m.size() - 1)];
      if (i == 0) part->from_m = -1.0;
    }
    ++i;
  }
  return part;
}

}  // namespace

WayOccupancy::WayOccupancy(const DrivenWay& way, const Traffic& traffic, double start_s, int steps,
                           double margin_m)
    : blocked_(static_cast<std::size_t>(steps) + 1) {
  for (std::size_t o = 0; o < traffic.obstacles.size(); ++o) {
    for (std::size_t k = 0; k < blocked_.size(); ++k) {
      const double t_s = start_s + kStep_s * static_cast<double>(k);
      if (!traffic.is_there(o, t_s)) continue;
      auto part = blocked_part(way, rectangle_at(traffic.obstacles[o], t_s), margin_m);
      if (!part) continue;
      part->obstacle = o;
      blocked_[k].push_back(*part);
    }
  }
}

const std::vector<Blocked>& WayOccupancy::at(int step) const {
  return blocked_[std::min(static_cast<std::size_t>(step), blocked_.size() - 1)];
}

bool WayOccupancy::is_blocked(int step, double distance_m) const {
  return std::ranges::any_of(at(step), [&](const Blocked& part) {
    return distance_m > part.from_m && distance_m < part.to_m;
  });
}

}  // namespace roadbed::tools
