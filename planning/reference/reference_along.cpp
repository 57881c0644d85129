#include <fmt/format.h>

#include <utility>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/reference/reference_line_data.h"
#include "roadbed/planning/reference/route_curve.h"

namespace roadbed::planning::inline reference {
namespace {

constexpr double kLookAhead_m = 15.0;  // beyond corners that rounding leaves out

std::vector<Corridor> corridor_along(const map::RoadMap& road_map, const RoutePath& path,
                                     const RouteCurve& route, double step_m, double look_ahead_m,
                                     double default_speed_mps) {
  std::vector<Corridor> corridor;
  double s_m = route.start_m;
  for (const std::size_t i :
       points_beside(path, route.curve, route.start_m, step_m, look_ahead_m)) {
    const RoutePathPoint& beside = path.points[i];
    corridor.push_back(room_beside(road_map, beside.lane, beside.fraction, route.curve.at(s_m),
                                   default_speed_mps, beside.reversed));
    s_m += step_m;
  }
  return corridor;
}

void refuse_too_long(const Route& route, double step_m) {
  const double most_m = kMostSupportPoints * step_m;
  if (route.length_m <= most_m) return;
  throw map::InputError({.file = "route",
                         .found = fmt::format("{:.0f} m long", route.length_m),
                         .needed = fmt::format("at most {:.0f} m for a reference line", most_m),
                         .remedy = "choose a nearer goal, and drive in parts"});
}

}  // namespace

ReferenceLine ReferenceLine::along(const map::RoadMap& road_map, const Route& route,
                                   const ReferenceLineOptions& options) {
  refuse_too_long(route, options.step_m);
  const RoutePath path = path_along(road_map, route,
                                    {.step_m = options.step_m,
                                     .lane_change_length_m = options.lane_change_length_m,
                                     .placed_change = options.placed_change,
                                     .extend_m = options.extend_m});
  RouteCurve drawn = draw_curve(path, centreline_of(path), fit_options(options));
  auto data = std::make_shared<ReferenceLineData>();
  BendsRounded rounded;
  if (options.corner_vehicle) {
    rounded = round_bends(road_map, path, *options.corner_vehicle, fit_options(options), drawn);
  }
  data->corridor = corridor_along(road_map, path, drawn, data->corridor_step_m,
                                  rounded.any ? kLookAhead_m : 0.0, options.default_speed_mps);
  data->notes = std::move(rounded.notes);
  data->curve = std::move(drawn.curve);
  data->largest_move_m = drawn.largest_move_m;
  data->start_m = drawn.start_m;
  data->goal_s_m = drawn.goal_s_m;
  return ReferenceLine(std::move(data));
}

}  // namespace roadbed::planning::reference
