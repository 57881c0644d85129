#include "roadbed/tools/report/page_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "roadbed/tools/files/json.h"
#include "roadbed/tools/report/lane_look.h"
#include "roadbed/tools/report/thin_line.h"

namespace roadbed::tools::inline report {
namespace {

constexpr double kLaneTolerance_m = 0.01;  // less than a pixel at the nearest zoom that is of use
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
  if (!input.drive.empty()) {
    near = input.drive.points().front().pose().position();
  } else if (!input.lanes.empty() && !input.lanes.front().centre.empty()) {
    near = input.lanes.front().centre.front();
  }
  return near.array().round().matrix();
}

template <typename Items, typename Function>
Json list_of(const Items& items, Function coded) {
  Json list = Json::array();
  for (const auto& item : items) list.push_back(coded(item));
  return list;
}

Json coded_lanes(const ReportInput& input, const Eigen::Vector2d& origin) {
  Json lanes = Json::array();
  const auto line = [&](const LineInSource& full) {
    return coded_line(thin_line(full, kLaneTolerance_m), origin);
  };
  for (const ReportLane& lane : input.lanes) {
    const std::string_view look = lane_look(lane);
    if (look.empty()) continue;
    lanes.push_back({{"name", lane.name},
                     {"look", look},
                     {"left", line(lane.left)},
                     {"centre", line(lane.centre)},
                     {"right", line(lane.right)}});
  }
  return lanes;
}

Json coded_obstacle(const planning::Obstacle& obstacle, const Eigen::Vector2d& origin) {
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

std::string_view severity_name(Severity severity) {
  switch (severity) {
    case Severity::info:
      return "info";
    case Severity::warning:
      return "warning";
    case Severity::fault:
      return "fault";
  }
  return "info";
}

Json coded_vehicle(const ReportInput& input) {
  const geometry::VehicleShape& vehicle = input.vehicle;
  Json parts = Json::array();
  for (const LineInSource& outline : input.parts_in_vehicle) {
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

// Costs in thousandths.
Json coded_candidate(const std::optional<ReportCandidate>& candidate) {
  if (!candidate) return nullptr;
  Json costs = Json::array();
  for (const double cost : candidate->costs) costs.push_back(rounded(1e3 * cost));
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

Json coded_grid(const std::optional<ReportGrid>& grid) {
  if (!grid || grid->end_d_m.empty() || grid->end_l_m.empty()) return nullptr;
  const auto axis = [](const std::vector<double>& ends) {
    return Json{ends.front(), ends.back(), ends.size()};
  };
  return {
      {"d", axis(grid->end_d_m)}, {"l", axis(grid->end_l_m)}, {"runs", coded_runs(grid->causes)}};
}

Json coded_start(const ReportStart& start) {
  return {rounded(1e3 * start.s_m), rounded(1e3 * start.d_m), rounded(1e5 * start.d_slope),
          rounded(1e6 * start.d_curvature_per_m)};
}

Json coded_plan(const ReportPlan& plan, Json path) {
  return {{"t", plan.t_s},
          {"note", plan.note},
          {"reason", plan.reason},
          {"path", std::move(path)},
          {"start", coded_start(plan.start)},
          {"chosen", coded_candidate(plan.chosen)},
          {"runner", coded_candidate(plan.runner_up)},
          {"grid", coded_grid(plan.grid)}};
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

std::string page_data_json(const ReportInput& input) {
  check_plots(input);
  const Eigen::Vector2d origin = choose_origin(input);
  const auto line = [&](const LineInSource& full) {
    return coded_line(thin_line(full, kPathTolerance_m), origin);
  };
  const Json data = {
      {"origin", {origin.x(), origin.y()}},
      {"vehicle", coded_vehicle(input)},
      {"lanes", coded_lanes(input, origin)},
      {"route", list_of(input.route, line)},
      {"reference", line(input.reference)},
      {"goal", input.goal ? coded_line({*input.goal}, origin) : Json(nullptr)},
      {"occupied", list_of(input.occupied,
                           [&](const map::Box2& box) {
                             return coded_line({box.min_in_source, box.max_in_source}, origin);
                           })},
      {"drive", coded_motion(input.drive, origin, true)},
      {"obstacles",
       list_of(input.obstacles,
               [&](const planning::Obstacle& one) { return coded_obstacle(one, origin); })},
      {"plans", list_of(input.plans,
                        [&](const ReportPlan& plan) { return coded_plan(plan, line(plan.path)); })},
      {"costNames", input.cost_names},
      {"causeNames", input.cause_names},
      {"plots", list_of(input.plots, coded_plot)},
      {"events", list_of(input.events,
                         [](const ReportEvent& event) {
                           return Json{{"t", event.t_s},
                                       {"severity", severity_name(event.severity)},
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
  return data.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace roadbed::tools
