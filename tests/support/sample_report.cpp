#include "roadbed/tests/support/sample_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace roadbed::tests {
namespace {

using geometry::Pose2;
using geometry::TrajectoryPoint;

constexpr double kStep_m = 2.0;
constexpr double kParkedAt_m = 120.0;
const Eigen::Vector2d kOffset(358000.0, 5702000.0);  // as large as UTM coordinates are

// Middle line of a road that bends left, then right.
double bend_per_m(double s_m) { return 0.012 * std::sin(s_m / 55.0); }

constexpr double kPiece_m = 0.25;

Pose2 moved(Pose2 pose, double s_m, double piece_m) {
  pose.heading_rad += bend_per_m(s_m) * piece_m;
  pose.x_m += std::cos(pose.heading_rad) * piece_m;
  pose.y_m += std::sin(pose.heading_rad) * piece_m;
  return pose;
}

std::vector<Pose2> middle_line() {
  std::vector<Pose2> poses{{kOffset.x(), kOffset.y(), 0.2}};
  for (int i = 0; i < 2400; ++i) poses.push_back(moved(poses.back(), kPiece_m * i, kPiece_m));
  return poses;
}

Pose2 middle_at(double s_m) {
  static const std::vector<Pose2> poses = middle_line();
  const auto piece = static_cast<std::size_t>(s_m / kPiece_m);
  const double start_m = kPiece_m * static_cast<double>(piece);
  return moved(poses.at(piece), start_m, s_m - start_m);
}

Pose2 beside(double s_m, double d_m) { return middle_at(s_m) * Pose2{0.0, d_m, 0.0}; }

tools::LineInSource line_beside(double d_m, bool backwards, double length_m) {
  tools::LineInSource line;
  for (double s = 0.0; s <= length_m; s += kStep_m) line.push_back(beside(s, d_m).position());
  if (backwards) std::ranges::reverse(line);
  return line;
}

map::LaneLine lane_line(double d_m, bool backwards) {
  constexpr double kLength_m = 420.0;
  tools::LineInSource points = line_beside(d_m, backwards, kLength_m);
  for (Eigen::Vector2d& point : points) point -= kOffset;
  map::LaneLine line{.in_map = geometry::Polyline(std::move(points)), .z_m = {}, .station_m = {}};
  line.station_m = line.in_map.stations_m();
  line.z_m.assign(line.station_m.size(), 0.0);
  return line;
}

void add_lane(map::RoadMapParts& parts, const char* name, map::LaneType type, double left_d_m,
              double right_d_m) {
  const bool backwards = left_d_m < right_d_m;
  map::Lane lane;
  lane.id = {static_cast<std::uint32_t>(parts.lanes.size())};
  lane.name = name;
  lane.type = type;
  lane.left = lane_line(left_d_m, backwards);
  lane.centre = lane_line(0.5 * (left_d_m + right_d_m), backwards);
  lane.right = lane_line(right_d_m, backwards);
  lane.polygon = map::lane_ring(lane.left.in_map, lane.right.in_map);
  parts.lanes.push_back(std::move(lane));
  parts.links.emplace_back();
}

// A smooth bump of height 1 around `middle`, `half` to each side.
double bump(double s_m, double middle_m, double half_m) {
  const double fraction = (s_m - middle_m) / half_m;
  return std::abs(fraction) < 1.0 ? std::pow(std::cos(0.5 * M_PI * fraction), 2) : 0.0;
}

double offset_of_ego_m(double s_m) { return -1.75 + 2.2 * bump(s_m, kParkedAt_m, 38.0); }

double speed_of_ego_mps(double t_s) {
  return 12.0 - 4.0 / (1.0 + std::exp(-(t_s - 19.0) / 1.5)) - 0.02 * t_s;
}

geometry::Trajectory ego_drive() {
  std::vector<TrajectoryPoint> points;
  double s_m = 12.0;
  constexpr double kTick_s = 0.05;
  for (int i = 0; i <= 800; ++i) {
    const double t_s = kTick_s * i, v = speed_of_ego_mps(t_s);
    const Pose2 pose = beside(s_m, offset_of_ego_m(s_m));
    const Pose2 ahead = beside(s_m + 0.1, offset_of_ego_m(s_m + 0.1));
    const double heading = std::atan2(ahead.y_m - pose.y_m, ahead.x_m - pose.x_m);
    const double curvature = bend_per_m(s_m);
    points.push_back({t_s, pose.x_m, pose.y_m, heading, v,
                      (speed_of_ego_mps(t_s + 0.01) - v) / 0.01, std::atan(2.58 * curvature),
                      curvature});
    s_m += v * kTick_s;
  }
  return geometry::Trajectory(points);
}

planning::ObstacleInSource parked_car() {
  const Pose2 pose = beside(kParkedAt_m, -2.9);
  return {.id = "parked-1",
          .kind = "car",
          .length_m = 4.4,
          .width_m = 1.8,
          .motion = geometry::Trajectory(
              {{.x_m = pose.x_m, .y_m = pose.y_m, .heading_rad = pose.heading_rad}})};
}

planning::ObstacleInSource car_along(const char* id, double from_s_m, double d_m,
                                     double speed_mps) {
  std::vector<TrajectoryPoint> points;
  for (int i = 0; i <= 80; ++i) {
    const double t_s = 0.5 * i;
    Pose2 pose = beside(std::max(0.0, from_s_m + speed_mps * t_s), d_m);
    if (speed_mps < 0.0) pose.heading_rad += M_PI;
    points.push_back({.t_s = t_s,
                      .x_m = pose.x_m,
                      .y_m = pose.y_m,
                      .heading_rad = pose.heading_rad,
                      .speed_mps = std::abs(speed_mps)});
  }
  return {.id = id, .length_m = 4.6, .width_m = 1.85, .motion = geometry::Trajectory(points)};
}

std::vector<tools::DriveCycle> cycles_of(const geometry::Trajectory& drive) {
  std::vector<tools::DriveCycle> cycles;
  for (int i = 0; i < 400; ++i) {
    tools::DriveCycle cycle{.t_s = 0.1 * i};
    for (double ahead_s = 0.0; ahead_s <= 2.5; ahead_s += 0.25) {
      cycle.path.push_back(drive.at(cycle.t_s + ahead_s).pose().position());
    }
    cycle.chosen = planning::Candidate{.end_d_m = 0.4, .end_l_m = 22.0, .terms = {0.1, 0.2}};
    cycle.grid = planning::CandidateGrid{
        .end_d_m = {-0.1, 0.0, 0.1},
        .end_l_m = {15.0, 30.0},
        .causes = {0, 0, 1, 5, 5, 0},
        .runner_up = planning::Candidate{.end_d_m = 0.5, .end_l_m = 21.0, .terms = {0.15, 0.2}}};
    cycle.hypotheses = {
        {.maneuver = planning::Maneuver::overtake, .reason = "oncoming-3 comes: 40 m are missing"},
        {.maneuver = planning::Maneuver::keep_lane,
         .end_d_m = 0.4,
         .end_l_m = 22.0,
         .path_cost = 0.3,
         .drive_cost = 1.25,
         .is_driven = true,
         .st = {.parts = {{.step = 0, .from_m = 20.0F, .to_m = 26.0F, .obstacle = 1},
                          {.step = 1, .from_m = 23.0F, .to_m = 29.0F, .obstacle = 1}},
                .drive_m = {0.0F, 5.0F, 9.5F}}}};
    cycle.foreseen = {{.obstacle = 1, .probability = 0.8, .points = {{0.0, 0.0}, {3.0, 0.0}}}};
    cycles.push_back(std::move(cycle));
  }
  return cycles;
}

tools::ReportPlot plot_of(
    const geometry::Trajectory& drive, const char* title, const char* unit,
    std::vector<std::pair<const char*, double (*)(const TrajectoryPoint&)>> fields) {
  tools::ReportPlot plot{
      .title = title, .unit = unit, .t_s = {}, .series = {}, .lower = {}, .upper = {}};
  for (const auto& point : drive.points()) plot.t_s.push_back(point.t_s);
  for (const auto& [name, value] : fields) {
    tools::ReportSeries series{.name = name, .values = {}};
    for (const auto& point : drive.points()) series.values.push_back(value(point));
    plot.series.push_back(std::move(series));
  }
  return plot;
}

std::vector<tools::ReportPlot> plots_of(const geometry::Trajectory& drive) {
  using Point = TrajectoryPoint;
  std::vector<tools::ReportPlot> plots = {
      plot_of(drive, "Speed", "m/s",
              {{"speed", [](const Point& p) { return p.speed_mps; }},
               {"target", [](const Point& p) { return p.t_s < 18.0 ? 12.0 : 7.5; }},
               {"limit", [](const Point&) { return 50.0 / 3.6; }}}),
      plot_of(drive, "Acceleration", "m/s²",
              {{"along", [](const Point& p) { return p.acceleration_mps2; }},
               {"across",
                [](const Point& p) { return p.speed_mps * p.speed_mps * p.curvature_per_m; }}}),
      plot_of(drive, "Curvature", "1/m",
              {{"curvature", [](const Point& p) { return p.curvature_per_m; }}}),
      plot_of(drive, "Lateral error", "m",
              {{"front axle", [](const Point& p) { return 0.04 * std::sin(p.t_s); }}}),
      plot_of(drive, "Clearance", "m", {{"least", [](const Point& p) {
                                           return p.t_s < 3.0
                                                      ? std::numeric_limits<double>::quiet_NaN()
                                                      : 0.6 + 0.1 * std::abs(p.t_s - 9.5);
                                         }}})};
  plots[1].lower = -4.05;
  plots[1].upper = 2.40;
  plots[4].lower = 0.3;
  return plots;
}

std::vector<map::Box2> wall() {
  std::vector<map::Box2> cells;
  for (double s = 150.0; s < 175.0; s += 0.2) {
    const Eigen::Vector2d corner = beside(s, -6.0).position();
    cells.push_back({corner, corner + Eigen::Vector2d(0.2, 0.2)});
  }
  return cells;
}

}  // namespace

map::RoadMapParts sample_road() {
  using map::LaneType;
  map::RoadMapParts parts;
  parts.origin_in_source = kOffset;
  add_lane(parts, "12/0/-1", LaneType::driving, 0.0, -3.5);
  add_lane(parts, "12/0/1", LaneType::driving, 0.0, 3.5);
  add_lane(parts, "12/0/-2", LaneType::shoulder, -3.5, -5.0);
  add_lane(parts, "12/0/2", LaneType::sidewalk, 3.5, 5.5);
  return parts;
}

tools::ReportInput sample_report() {
  tools::ReportInput input;
  input.title = "Drive past a parked car";
  input.scenario = "data/scenarios/parked_car.json";
  input.verdict = {tools::Tone::good, "goal reached after 40 s, 390 m; nothing was touched"};
  input.audit = tools::ReportVerdict{tools::Tone::good, "clear, at least 0.61 m"};
  input.scene.road_map = std::make_shared<const map::RoadMap>(sample_road());
  input.scene.route = {line_beside(-1.75, false, 410.0)};
  input.scene.references = {line_beside(-1.75, false, 410.0)};
  input.scene.goal = beside(405.0, -1.75).position();
  input.scene.occupied = wall();
  input.drive.trajectory = ego_drive();
  input.scene.obstacles = {parked_car(), car_along("slow-2", 150.0, -1.75, 6.2),
                           car_along("oncoming-3", 400.0, 1.75, -9.0)};
  input.drive.cycles = cycles_of(input.drive.trajectory);
  input.plots = plots_of(input.drive.trajectory);
  input.drive.events = {{0.0, tools::EventLevel::info, "start at 12.0 m/s"},
                        {9.5, tools::EventLevel::warning, "least clearance 0.61 m to parked-1"},
                        {19.0, tools::EventLevel::info, "slows down behind slow-2"},
                        {40.0, tools::EventLevel::info, "goal reached"}};
  input.decisions = {{0.0, 5.2, "keep lane", "nothing ahead"},
                     {5.2, 13.6, "pass", "parked-1 narrows the lane; 2.1 m to the left are free"},
                     {13.6, 16.8, "keep lane", "nothing ahead"},
                     {16.8, 40.0, "follow", "slow-2 ahead drives 6.2 m/s"}};
  input.checks = {{"collisions", 0.0, "", "= 0", true, {}},
                  {"least clearance", 0.612, "m", "≥ 0.3", true, 9.5},
                  {"largest lateral acceleration", 1.72, "m/s²", "≤ 4.89", true, 7.1},
                  {"largest jerk", 9.1, "m/s³", "≤ 8.37", false, 18.3, "comfort, nuPlan"},
                  {"time-to-collision", std::nullopt, "s", "≥ 1.5", true, {}}};
  input.origin.command = "roadbed simulate data/scenarios/parked_car.json -o out";
  input.origin.version = "roadbed 0.1.0";
  input.origin.crs = "EPSG:25832";
  input.origin.sources = {{"map", "data/maps/town.xodr", "9f1c2ab0d4e5f607"},
                          {"scenario", "data/scenarios/parked_car.json", "01234567890abcde"}};
  return input;
}

}  // namespace roadbed::tests
