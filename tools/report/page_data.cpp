#include "roadbed/tools/report/page_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "roadbed/geometry/primitives/polyline.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/page/map_page.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline report {
namespace {

constexpr double kPathTolerance_m = 0.002;

long long rounded(double value) { return std::llround(value); }

// Points in millimetres from `origin`, each as its difference from the one before.
Json coded_line(const LineInSource& line, const Eigen::Vector2d& origin) {
  Json codes = Json::array();
  long long last_x = 0, last_y = 0;
  for (const Eigen::Vector2d& point : line) {
    const long long x = rounded(1e3 * (point.x() - origin.x()));
    const long long y = rounded(1e3 * (point.y() - origin.y()));
    codes.push_back(x - last_x);
    codes.push_back(y - last_y);
    last_x = x;
    last_y = y;
  }
  return codes;
}

// Values in whole steps of `scale`, each as its difference from the last one that is finite.
Json coded_series(const std::vector<double>& values, double scale) {
  Json steps = Json::array();
  long long last = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) {
      steps.push_back(nullptr);
      continue;
    }
    const long long step = rounded(value / scale);
    steps.push_back(step - last);
    last = step;
  }
  return {{"scale", scale}, {"v", std::move(steps)}};
}

// A power of ten that leaves four or five digits to the largest value.
double scale_for(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double value : values) {
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  }
  for (const double scale : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1}) {
    if (largest < 2e4 * scale) return scale;
  }
  return 1.0;
}

constexpr double kTimeScale_s = 1e-3;

Json coded_motion(const geometry::Trajectory& motion, const Eigen::Vector2d& origin,
                  bool with_dynamics) {
  using Point = geometry::TrajectoryPoint;
  const auto field = [&](auto value, double scale) {
    std::vector<double> values;
    for (const Point& point : motion.points()) values.push_back(value(point));
    return coded_series(values, scale);
  };
  Json coded = {{"t", field([](const Point& p) { return p.t_s; }, kTimeScale_s)},
                {"x", field([&](const Point& p) { return p.x_m - origin.x(); }, 1e-3)},
                {"y", field([&](const Point& p) { return p.y_m - origin.y(); }, 1e-3)},
                {"h", field([](const Point& p) { return p.heading_rad; }, 1e-4)}};
  if (!with_dynamics) return coded;
  coded["v"] = field([](const Point& p) { return p.speed_mps; }, 1e-3);
  coded["a"] = field([](const Point& p) { return p.acceleration_mps2; }, 1e-3);
  coded["steering"] = field([](const Point& p) { return p.steering_rad; }, 1e-4);
  return coded;
}

// A round place near what is shown, so that numbers stay small.
Eigen::Vector2d choose_origin(const ReportInput& input) {
  Eigen::Vector2d near(0, 0);
  if (!input.drive.trajectory.empty()) {
    near = input.drive.trajectory.points().front().pose().position();
  } else if (input.scene.road_map) {
    near = input.scene.road_map->origin_in_source();
  }
  return near.array().round().matrix();
}

template <typename Items, typename Function>
Json list_of(const Items& items, Function coded) {
  Json list = Json::array();
  for (const auto& item : items) list.push_back(coded(item));
  return list;
}

Json coded_obstacle(const planning::ObstacleInSource& obstacle, const Eigen::Vector2d& origin) {
  return {{"id", obstacle.id},
          {"kind", obstacle.kind},
          {"length", obstacle.length_m},
          {"width", obstacle.width_m},
          {"motion", coded_motion(obstacle.motion, origin, false)}};
}

Json coded_plot(const ReportPlot& plot) {
  const auto bound = [](const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
  };
  return {{"title", plot.title},
          {"unit", plot.unit},
          {"lower", bound(plot.lower)},
          {"upper", bound(plot.upper)},
          {"t", coded_series(plot.t_s, kTimeScale_s)},
          {"series", list_of(plot.series, [](const ReportSeries& series) {
             Json coded = coded_series(series.values, scale_for(series.values));
             coded["name"] = series.name;
             return coded;
           })}};
}

Json coded_vehicle(const ReportInput& input) {
  const geometry::VehicleShape& vehicle = input.scene.vehicle;
  Json parts = Json::array();
  for (const LineInSource& outline : input.scene.parts_in_vehicle) {
    Json ring = Json::array();
    for (const Eigen::Vector2d& point : outline) ring.push_back({point.x(), point.y()});
    parts.push_back(std::move(ring));
  }
  return {{"back", -vehicle.rear_overhang_m},
          {"front", vehicle.front_m()},
          {"width", vehicle.width_m},
          {"wheelbase", vehicle.wheelbase_m},
          {"parts", std::move(parts)}};
}

// Weighted costs in thousandths.
Json coded_candidate(const std::optional<planning::Candidate>& candidate,
                     const planning::CostTerms& weights) {
  if (!candidate) return nullptr;
  Json costs = Json::array();
  for (std::size_t i = 0; i < weights.size(); ++i) {
    costs.push_back(rounded(1e3 * (weights[i] * candidate->terms[i])));
  }
  return {{"d", 1e-3 * static_cast<double>(rounded(1e3 * candidate->end_d_m))},
          {"l", 1e-3 * static_cast<double>(rounded(1e3 * candidate->end_l_m))},
          {"costs", std::move(costs)}};
}

// Equal causes in a row as their number and the cause.
Json coded_runs(const std::vector<std::uint8_t>& causes) {
  Json runs = Json::array();
  for (std::size_t i = 0; i < causes.size();) {
    std::size_t end = i;
    while (end < causes.size() && causes[end] == causes[i]) ++end;
    runs.push_back(end - i);
    runs.push_back(causes[i]);
    i = end;
  }
  return runs;
}

Json coded_grid(const std::optional<planning::CandidateGrid>& grid) {
  if (!grid || grid->end_d_m.empty() || grid->end_l_m.empty()) return nullptr;
  const auto axis = [](const std::vector<double>& ends) {
    return Json{ends.front(), ends.back(), ends.size()};
  };
  return {
      {"d", axis(grid->end_d_m)}, {"l", axis(grid->end_l_m)}, {"runs", coded_runs(grid->causes)}};
}

Json coded_start(const planning::LateralState& start) {
  return {rounded(1e3 * start.s_m), rounded(1e3 * start.d_m), rounded(1e5 * start.d_slope),
          rounded(1e6 * start.d_curvature_per_m)};
}

// "ends 0.4 m to the left after 22.0 m".
std::string note_of(const DriveCycle& cycle) {
  if (cycle.is_outside) return "planned by another planner";
  if (!cycle.chosen) return cycle.plan_reason.empty() ? "none feasible" : cycle.plan_reason;
  const double end_d_m = cycle.chosen->end_d_m;
  const char* side = end_d_m > 0.0 ? "to the left" : "to the right";
  return std::abs(end_d_m) < 0.05
             ? fmt::format("ends on the reference line after {:.1f} m", cycle.chosen->end_l_m)
             : fmt::format("ends {:.1f} m {} after {:.1f} m", std::abs(end_d_m), side,
                           cycle.chosen->end_l_m);
}

// Distances in centimetres: the drive's at each step; four numbers a part, its obstacle's index
// first, −1 for a light.
Json coded_st(const planning::StPicture& st) {
  if (st.drive_m.empty()) return nullptr;
  const auto cm = [](float metres) { return rounded(1e2 * static_cast<double>(metres)); };
  Json drive = Json::array(), parts = Json::array();
  for (const float ahead_m : st.drive_m) drive.push_back(cm(ahead_m));
  for (const planning::StPicture::Part& part : st.parts) {
    const bool is_light = part.obstacle == planning::StInterval::kNoObstacle;
    parts.push_back(is_light ? -1 : static_cast<std::int64_t>(part.obstacle));
    parts.push_back(part.step);
    parts.push_back(cm(part.from_m));
    parts.push_back(cm(part.to_m));
  }
  return {{"drive", std::move(drive)}, {"parts", std::move(parts)}};
}

Json coded_hypothesis(const planning::HypothesisOutcome& one) {
  const auto thousandths = [](const std::optional<double>& value) {
    return value && std::isfinite(*value) ? Json(1e-3 * static_cast<double>(rounded(1e3 * *value)))
                                          : Json();
  };
  return {{"maneuver", planning::to_string(one.maneuver)},
          {"d", thousandths(one.end_d_m)},
          {"l", thousandths(one.end_l_m)},
          {"path", thousandths(one.path_cost)},
          {"drive", thousandths(one.drive_cost)},
          {"driven", one.is_driven},
          {"reason", one.reason},
          {"st", coded_st(one.st)}};
}

Json coded_cycle(const Drive& drive, const DriveCycle& cycle, Json path,
                 const planning::CostTerms& weights, const Eigen::Vector2d& origin) {
  return {{"t", cycle.t_s},
          {"line", line_at(drive, cycle.t_s)},
          {"note", note_of(cycle)},
          {"reason", cycle.reason},
          {"path", std::move(path)},
          {"start", coded_start(cycle.start)},
          {"chosen", coded_candidate(cycle.chosen, weights)},
          {"runner", coded_candidate(cycle.grid ? cycle.grid->runner_up : std::nullopt, weights)},
          {"hypotheses", list_of(cycle.hypotheses, coded_hypothesis)},
          {"foreseen", list_of(cycle.foreseen,
                               [&](const ForeseenMotion& one) {
                                 return Json{{"obstacle", one.obstacle},
                                             {"probability", one.probability},
                                             {"points", coded_line(one.points, origin)}};
                               })},
          {"grid", coded_grid(cycle.grid)}};
}

// The names of the first `count` values of an enumeration, none for a drive without cycles.
template <typename Enum>
Json names_of(const Drive& drive, int count) {
  Json names = Json::array();
  if (drive.cycles.empty()) return names;
  for (int i = 0; i < count; ++i) names.push_back(planning::to_string(static_cast<Enum>(i)));
  return names;
}

void check_plots(const ReportInput& input) {
  for (const ReportPlot& plot : input.plots) {
    for (const ReportSeries& series : plot.series) {
      if (series.values.size() == plot.t_s.size()) continue;
      throw std::invalid_argument(
          fmt::format("drive_report_html: plot '{}': series '{}' has {} values for {} times",
                      plot.title, series.name, series.values.size(), plot.t_s.size()));
    }
  }
}

}  // namespace

std::string page_map_json(const ReportInput& input) {
  const map::RoadMap nothing{map::RoadMapParts{}};
  const map::RoadMap& road_map = input.scene.road_map ? *input.scene.road_map : nothing;
  const auto lines = [&](const std::vector<LineInSource>& full) {
    std::vector<LineInSource> in_map;
    for (const LineInSource& line : full) {
      in_map.push_back(geometry::simplify(line, kPathTolerance_m));
      for (Eigen::Vector2d& point : in_map.back()) point = road_map.to_map(point);
    }
    return in_map;
  };
  map::PageOverlay route{.kind = "route", .name = "Route"},
      occupied{.kind = "occupied", .name = "Occupancy"};
  map::PageOverlay reference{.kind = "reference", .name = "Reference line", .is_alternative = true};
  route.lines_in_map = lines(input.scene.route);
  reference.lines_in_map = lines(input.scene.references);
  for (const map::Box2& box : input.scene.occupied) {
    occupied.boxes_in_map.emplace_back(road_map.to_map(box.min_in_source),
                                       road_map.to_map(box.max_in_source));
  }
  return map::map_page_data(road_map, {.remarks = std::vector<map::PageRemark>{},
                                       .overlays = {route, reference, occupied}});
}

std::string page_data_json(const ReportInput& input) {
  check_plots(input);
  const Eigen::Vector2d origin = choose_origin(input);
  const auto line = [&](const LineInSource& full) {
    return coded_line(geometry::simplify(full, kPathTolerance_m), origin);
  };
  const Json data = {
      {"origin", {origin.x(), origin.y()}},
      {"vehicle", coded_vehicle(input)},
      {"goal", input.scene.goal ? coded_line({*input.scene.goal}, origin) : Json(nullptr)},
      {"drive", coded_motion(input.drive.trajectory, origin, true)},
      {"obstacles",
       list_of(input.scene.obstacles,
               [&](const planning::ObstacleInSource& one) { return coded_obstacle(one, origin); })},
      {"plans", list_of(input.drive.cycles,
                        [&](const DriveCycle& cycle) {
                          return coded_cycle(input.drive, cycle, line(cycle.path), input.weights,
                                             origin);
                        })},
      {"costNames", names_of<planning::CostTerm>(input.drive, planning::kCostTerms)},
      {"causeNames", names_of<planning::Rejection>(input.drive, planning::kRejections)},
      {"plots", list_of(input.plots, coded_plot)},
      {"events", list_of(input.drive.events,
                         [](const DriveEvent& event) {
                           return Json{{"t", event.t_s},
                                       {"severity", to_string(event.level)},
                                       {"text", event.text}};
                         })},
      {"decisions", list_of(input.decisions,
                            [](const ReportDecision& decision) {
                              return Json{{"from", decision.from_s},
                                          {"to", decision.to_s},
                                          {"state", decision.state},
                                          {"reason", decision.reason}};
                            })},
  };
  return map::json_text(data);
}

}  // namespace roadbed::tools::report
