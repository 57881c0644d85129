// Routes and reference lines between random pairs of drivable lanes, one row per map:
//   reference_lines_survey MAP...

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <random>

#include "roadbed/geometry/vehicle_shape.h"
#include "roadbed/map/input_error.h"
#include "roadbed/map/load_map.h"
#include "roadbed/planning/reference_line.h"

namespace roadbed::tests {
namespace {

constexpr int kPairs = 100;
constexpr double kFine_m = 0.02;
constexpr double kPose_m = 0.5;

struct Row {
  int found = 0, explained = 0, too_bent = 0, changes = 0;
  double length_m = 0.0, jump = 0.0, rate_jump = 0.0, peak_per_m = 0.0, move_m = 0.0;
  double slowest_route_ms = 0.0, line_ms = 0.0;
  long points = 0, inside = 0;
};

// What the change of a value over a step differs from the integral of its derivative: a jump, if
// there is one (Simpson's rule).
double unexplained(double before, double after, double slope_before, double slope_middle,
                   double slope_after) {
  const double change = kFine_m / 6.0 * (slope_before + 4.0 * slope_middle + slope_after);
  return std::abs(after - before - change);
}

void measure_smoothness(const planning::ReferenceLine& line, Row& row) {
  planning::ReferencePoint a = line.at(0.0);
  double peak = std::abs(a.curvature_per_m);
  for (double s = kFine_m; s < line.length_m(); s += kFine_m) {
    const planning::ReferencePoint m = line.at(s - 0.5 * kFine_m), b = line.at(s);
    row.jump =
        std::max(row.jump, unexplained(a.curvature_per_m, b.curvature_per_m, a.curvature_d1_per_m2,
                                       m.curvature_d1_per_m2, b.curvature_d1_per_m2));
    row.rate_jump =
        std::max(row.rate_jump,
                 unexplained(a.curvature_d1_per_m2, b.curvature_d1_per_m2, a.curvature_d2_per_m3,
                             m.curvature_d2_per_m3, b.curvature_d2_per_m3));
    peak = std::max(peak, std::abs(b.curvature_per_m));
    a = b;
  }
  row.peak_per_m = std::max(row.peak_per_m, peak);
  row.too_bent += peak > 0.2 ? 1 : 0;
}

void measure_body(const map::RoadMap& road_map, const planning::ReferenceLine& line, Row& row) {
  const auto corners = geometry::VehicleShape{}.corners_in_vehicle();
  for (double s = 0.0; s < line.goal_s_m(); s += kPose_m) {
    const planning::ReferencePoint at = line.at(s);
    const geometry::Pose2 map_from_vehicle{at.in_map.x(), at.in_map.y(), at.heading_rad};
    for (std::size_t i = 0; i < 4; ++i) {
      for (const double share : {0.0, 0.25, 0.5, 0.75}) {
        const Eigen::Vector2d edge = corners[i] + share * (corners[(i + 1) % 4] - corners[i]);
        ++row.points;
        row.inside += road_map.on_surface(map_from_vehicle * edge, 0.01) ? 1 : 0;
      }
    }
  }
}

double ms_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

void survey_pair(const map::RoadMap& road_map, const map::Lane& from, const map::Lane& to,
                 std::mt19937& random, Row& row) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const map::LanePlace start{from.id, share(random) * from.length_m(), 0.0};
  const map::LanePlace goal{to.id, share(random) * to.length_m(), 0.0};
  const auto begin = std::chrono::steady_clock::now();
  const planning::RouteAnswer answer = planning::find_route(road_map, start, goal);
  row.slowest_route_ms = std::max(row.slowest_route_ms, ms_since(begin));
  if (!answer.route) {
    row.explained += answer.reason.empty() ? 0 : 1;
    return;
  }
  ++row.found;
  const auto drawn = std::chrono::steady_clock::now();
  const auto line = planning::ReferenceLine::along(road_map, *answer.route);
  row.line_ms += ms_since(drawn);
  row.length_m += line.goal_s_m();
  row.changes += answer.route->lane_changes;
  const double bent_before = row.peak_per_m, move_before = row.move_m;
  row.move_m = std::max(row.move_m, line.largest_move_m());
  measure_smoothness(line, row);
  measure_body(road_map, line, row);
  if (std::getenv("SURVEY_WORST") != nullptr &&
      (row.peak_per_m > std::max(0.2, bent_before) || row.move_m > std::max(0.31, move_before))) {
    fmt::print(stderr, "  {}@{:.3f} to {}@{:.3f}: peak {:.3f}, move {:.3f}\n", from.name, start.s_m,
               to.name, goal.s_m, row.peak_per_m, row.move_m);
  }
}

void survey(const std::filesystem::path& file) {
  const map::RoadMap road_map = map::load_map(file);
  std::vector<const map::Lane*> lanes;
  for (const map::Lane& lane : road_map.lanes()) {
    if (is_drivable(lane.type)) lanes.push_back(&lane);
  }
  if (lanes.empty()) return;
  std::mt19937 random(20261121);
  std::uniform_int_distribution<std::size_t> any(0, lanes.size() - 1);
  Row row;
  for (int i = 0; i < kPairs; ++i) {
    const map::Lane &from = *lanes[any(random)], &to = *lanes[any(random)];
    survey_pair(road_map, from, to, random, row);
  }
  fmt::print(
      "{:<42} {:>5} {:>5} {:>4} {:>7.1f} {:>8.1e} {:>8.1e} {:>6.3f} {:>4} {:>6.3f} {:>8.3f} "
      "{:>7.2f} {:>7.2f}\n",
      file.filename().string(), row.found, row.explained, row.changes, row.length_m / 1e3, row.jump,
      row.rate_jump, row.peak_per_m, row.too_bent, row.move_m,
      row.points > 0 ? 100.0 * static_cast<double>(row.inside) / static_cast<double>(row.points)
                     : 0.0,
      row.slowest_route_ms, row.line_ms / std::max(1.0, row.length_m / 1e3));
}

}  // namespace
}  // namespace roadbed::tests

int main(int argc, char** argv) {
  fmt::print("{:<42} {:>5} {:>5} {:>4} {:>7} {:>8} {:>8} {:>6} {:>4} {:>6} {:>8} {:>7} {:>7}\n",
             "map", "found", "none", "chg", "km", "k jump", "k' jump", "peak", ">0.2", "move",
             "on road%", "rt ms", "ms/km");
  for (int i = 1; i < argc; ++i) {
    try {
      roadbed::tests::survey(argv[i]);
    } catch (const roadbed::map::InputError& error) {
      fmt::print(stderr, "{}\n", error.what());
    }
  }
}
