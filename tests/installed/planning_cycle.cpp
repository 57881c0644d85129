// One planning cycle among obstacles of one's own: a car is parked on the line.
//
//     planning_cycle town.xodr 1/3/1 6 7/0/1 35
#include <roadbed/map/load_map.h>
#include <roadbed/planning/plan.h>
#include <roadbed/planning/reference/reference_line.h>
#include <roadbed/planning/route/router.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <vector>

using namespace roadbed;

namespace {

planning::Obstacle parked_car(const planning::ReferenceLine& line, double s_m, double d_m) {
  const planning::ReferencePoint at = line.at(s_m);
  const geometry::Pose2 on_line{at.in_map.x(), at.in_map.y(), at.heading_rad};
  const geometry::Pose2 beside = on_line * geometry::Pose2{0.0, d_m, 0.0};
  geometry::Trajectory stands({{.x_m = beside.position().x(),
                                .y_m = beside.position().y(),
                                .heading_rad = at.heading_rad}});
  return {.id = "parked", .length_m = 4.5, .width_m = 1.8, .motion = stands};
}

}  // namespace

int main(int count, char** arguments) try {
  if (count < 6) return 2;
  const map::RoadMap map = map::load_map(arguments[1]);
  const planning::RouteAnswer answer =
      planning::find_route(map, {map.find_lane(arguments[2]).value(), std::atof(arguments[3])},
                           {map.find_lane(arguments[4]).value(), std::atof(arguments[5])});
  if (!answer.route) return 1;
  const auto line = planning::ReferenceLine::along(map, *answer.route);

  // It sticks half a metre into the way.
  const std::vector<planning::Obstacle> obstacles{parked_car(line, 22.0, -1.6)};
  const planning::PlanInput input{.line = line,
                                  .start = {.s_m = 2.0},
                                  .speed = {.speed_mps = 6.0, .target_mps = 8.0},
                                  .obstacles = obstacles};
  const geometry::VehicleShape vehicle;
  const planning::Plan plan = planning::plan_path(input, vehicle, {.keep_candidates = true});
  if (!plan.chosen) {
    std::printf("nothing is feasible: %s\n", plan.reason.c_str());
    return 1;
  }
  std::printf("%zu candidates, the best ends %.1f m to the left after %.1f m\n",
              plan.candidates.size(), plan.chosen->end_d_m, plan.chosen->end_l_m);
  for (const geometry::TrajectoryPoint& point : plan.trajectory.points()) {
    std::printf("%.2f s: %.3f %.3f\n", point.t_s, point.x_m, point.y_m);
  }
} catch (const std::exception& fault) {
  std::fprintf(stderr, "%s\n", fault.what());
  return 1;
}
