// Routes and reference lines between random pairs of drivable lanes, one row per map, drawn for a
// car whose wheels steer 0.2 1/m at most, as most cars' do, but of the default's size; with
// SURVEY_DEFAULT in the environment for the default itself:
//   reference_lines_survey MAP...

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"
#include "roadbed/planning/reference/line_driving.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/route/router.h"

namespace roadbed::tests {
namespace {

constexpr int kPairs = 100;
constexpr double kFine_m = 0.02;
constexpr double kSteered_per_m = 0.2;

struct Row {
  int found = 0, explained = 0, too_bent = 0, changes = 0;
  int rounded = 0, unsteerable = 0, off_road = 0, unsaid = 0;
  double length_m = 0.0, jump = 0.0, rate_jump = 0.0, peak_per_m = 0.0, move_m = 0.0;
  double rate_per_m2 = 0.0, slowest_mps = 1e300, off_road_m = 0.0;
  double slowest_route_ms = 0.0, line_ms = 0.0;
};

geometry::VehicleShape car() {
  geometry::VehicleShape vehicle;
  if (std::getenv("SURVEY_DEFAULT") != nullptr) return vehicle;
  vehicle.max_steering_rad = std::atan(kSteered_per_m * vehicle.wheelbase_m);
  return vehicle;
}

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
}

void measure_driving(const map::RoadMap& road_map, const planning::ReferenceLine& plain,
                     const planning::ReferenceLine& line, Row& row) {
  const auto on_road = [&](const Eigen::Vector2d& place) {
    return road_map.on_surface(place, 0.05);
  };
  const auto driving = planning::driving_along(line, line.goal_s_m(), car(), on_road);
  const auto before = planning::driving_along(plain, plain.goal_s_m(), car(), {});
  row.too_bent += before.bends.empty() ? 0 : 1;
  row.rounded += !before.bends.empty() && driving.bends.empty() ? 1 : 0;
  row.unsteerable += driving.bends.empty() ? 0 : 1;
  row.off_road += driving.leaves.empty() ? 0 : 1;
  row.off_road_m += planning::length_of(driving.leaves);
  row.unsaid += line.notes().size() < driving.bends.size() ? 1 : 0;
  row.rate_per_m2 = std::max(row.rate_per_m2, driving.peak_curvature_rate_per_m2.value);
  row.slowest_mps = std::min(row.slowest_mps, driving.slowest_mps.value);
}

double ms_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

void survey_pair(const map::RoadMap& road_map, const map::Lane& from, const map::Lane& to,
                 std::mt19937& random, Row& row) {
  std::uniform_real_distribution<double> fraction(0.0, 1.0);
  const map::LanePlace start{from.id, fraction(random) * from.length_m(), 0.0};
  const map::LanePlace goal{to.id, fraction(random) * to.length_m(), 0.0};
  const auto begin = std::chrono::steady_clock::now();
  const planning::RouteAnswer answer = planning::find_route(road_map, start, goal);
  row.slowest_route_ms = std::max(row.slowest_route_ms, ms_since(begin));
  if (!answer.route) {
    row.explained += answer.reason.empty() ? 0 : 1;
    return;
  }
  ++row.found;
  const auto drawn = std::chrono::steady_clock::now();
  const auto plain = planning::ReferenceLine::along(road_map, *answer.route);
  row.line_ms += ms_since(drawn);
  const auto line =
      planning::ReferenceLine::along(road_map, *answer.route, {.corner_vehicle = car()});
  row.length_m += line.goal_s_m();
  row.changes += answer.route->lane_changes;
  const double bent_before = row.peak_per_m, move_before = row.move_m;
  row.move_m = std::max(row.move_m, line.largest_move_m());
  measure_smoothness(line, row);
  measure_driving(road_map, plain, line, row);
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
      "{:<22} {:>5} {:>4} {:>4} {:>6.1f} {:>8.1e} {:>8.1e} {:>6.3f} {:>6.3f} {:>6.3f} {:>5.1f} "
      "{:>4} "
      "{:>5} {:>5} {:>4} {:>6.1f} {:>6} {:>6.2f} {:>6.2f}\n",
      file.filename().string(), row.found, row.explained, row.changes, row.length_m / 1e3, row.jump,
      row.rate_jump, row.peak_per_m, row.rate_per_m2, row.move_m, row.slowest_mps, row.too_bent,
      row.rounded, row.unsteerable, row.off_road, row.off_road_m, row.unsaid, row.slowest_route_ms,
      row.line_ms / std::max(1.0, row.length_m / 1e3));
}

}  // namespace
}  // namespace roadbed::tests

int main(int argc, char** argv) {
  fmt::print(
      "{:<22} {:>5} {:>4} {:>4} {:>6} {:>8} {:>8} {:>6} {:>6} {:>6} {:>5} {:>4} {:>5} {:>5} {:>4} "
      "{:>6} {:>6} {:>6} {:>6}\n",
      "map", "found", "none", "chg", "km", "k jump", "k' jump", "peak k", "k'", "move", "m/s",
      "bent", "round", "bends", "off", "off m", "unsaid", "rt ms", "ms/km");
  for (int i = 1; i < argc; ++i) {
    try {
      roadbed::tests::survey(argv[i]);
    } catch (const roadbed::map::InputError& error) {
      fmt::print(stderr, "{}\n", error.what());
    }
  }
}
