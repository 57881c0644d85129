// A route over lanes, and the smooth line to drive along it.
//
//     route_line town.xodr 1/3/1 6 7/0/1 35        from and to: a lane's name, a station on it
#include <roadbed/map/load_map.h>
#include <roadbed/planning/reference/reference_line.h>
#include <roadbed/planning/route/router.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>

using namespace roadbed;

namespace {

planning::RoutePlace place(const map::RoadMap& map, const char* lane, const char* station) {
  return {map.find_lane(lane).value(), std::atof(station)};
}

}  // namespace

int main(int count, char** arguments) try {
  if (count < 6) return 2;
  const map::RoadMap map = map::load_map(arguments[1]);
  planning::Router router(map);  // asked as often as one likes
  const planning::RouteAnswer answer =
      router.find(place(map, arguments[2], arguments[3]), place(map, arguments[4], arguments[5]));
  if (!answer.route) {
    std::printf("no route: %s\n", answer.reason.c_str());
    return 1;
  }
  std::printf("%.6f m, %d lane changes:", answer.route->length_m, answer.route->lane_changes);
  for (const planning::RouteLeg& leg : answer.route->legs) {
    std::printf(" %s", map.lane(leg.lane).name.c_str());
  }
  const auto line = planning::ReferenceLine::along(map, *answer.route);
  double tightest_per_m = 0.0;
  for (double s_m = 0.0; s_m <= line.goal_s_m(); s_m += 0.5) {
    tightest_per_m = std::max(tightest_per_m, std::abs(line.at(s_m).curvature_per_m));
  }
  std::printf("\nline of %.3f m, at most %.4f 1/m\n", line.goal_s_m(), tightest_per_m);
} catch (const std::exception& fault) {
  std::fprintf(stderr, "%s\n", fault.what());
  return 1;
}
