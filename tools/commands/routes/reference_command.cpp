#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

#include "roadbed/map/gis/lon_lat.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/planning/reference/line_driving.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tools/cli/output_format.h"
#include "roadbed/tools/cli/route_question.h"
#include "roadbed/tools/commands/routes/commands.h"
#include "roadbed/tools/commands/routes/way_point_line.h"

namespace roadbed::tools::inline commands::inline routes {
namespace {

constexpr double kOffRoad_m = 0.05;  // of the body; less still is on the road

/// From the start to the goal, the last step shortened.
std::vector<double> stations(double end_m, double step_m) {
  std::vector<double> stations_m;
  for (int i = 0; i * step_m < end_m - 1e-6; ++i) stations_m.push_back(i * step_m);
  stations_m.push_back(end_m);
  return stations_m;
}

/// A row for each station.
std::string line_csv(const map::RoadMap& road_map, const planning::ReferenceLine& line,
                     const std::vector<double>& stations_m, bool has_lon_lat) {
  std::vector<Eigen::Vector2d> lon_lat;
  if (has_lon_lat) {
    for (const double s_m : stations_m) {
      lon_lat.push_back(road_map.to_source(line.at(s_m).in_map));
    }
    map::source_to_lon_lat(road_map, lon_lat);
  }
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out,
                 "s_m,x_m,y_m,{}heading_rad,curvature_per_m,curvature_rate_per_m2,left_m,right_m,"
                 "speed_limit_mps\n",
                 has_lon_lat ? "lon_deg,lat_deg," : "");
  for (std::size_t i = 0; i < stations_m.size(); ++i) {
    const planning::ReferencePoint point = line.at(stations_m[i]);
    const planning::Corridor room = line.corridor_at(stations_m[i]);
    const Eigen::Vector2d in_source = road_map.to_source(point.in_map);
    fmt::format_to(out, "{},{},{},", stations_m[i], in_source.x(), in_source.y());
    if (has_lon_lat) fmt::format_to(out, "{},{},", lon_lat[i].x(), lon_lat[i].y());
    fmt::format_to(out, "{},{},{},{},{},{}\n", point.heading_rad, point.curvature_per_m,
                   point.curvature_d1_per_m2, room.left_m, room.right_m, room.speed_limit_mps);
  }
  return fmt::to_string(text);
}

class ReferenceCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Draw the smooth line to drive along a route, or through way-points");
    arguments.add("MAP", map_file_, "Any readable map; none with --waypoints")
        .reads()
        .ending(kMapEndings);
    question_.declare(arguments, true);
    way_points_.declare(arguments);
    arguments.add("-o,--output", output_, "CSV file to write; - for standard output")
        .required()
        .writes(".csv");
    arguments.add("--step", step_m_, "Distance between rows [m]")
        .within(1e-3, 100.0)
        .with_default();
    arguments
        .add("--max-move", options_.max_smoothing_m,
             "Largest distance of the line from the centreline or way-points [m]")
        .within(0.01, 2.0)
        .with_default();
    arguments.flag("--lonlat", wants_lon_lat_,
                   "Columns lon_deg and lat_deg (WGS 84) behind y_m; the map has to name its "
                   "coordinate system");
    arguments.flag("-f,--force", force_, "Replace the output if it exists");
    arguments.require([this] { return fault(); });
    arguments.says_no_if("there is no route");
    arguments.example(
        "  roadbed reference town.xodr --from lane:1/0/-1@10 --to lane:7/0/1@55 -o line.csv\n"
        "  roadbed reference --waypoints points.csv --interpolate --ends periodic -o ring.csv");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    map::check_writable(output_, force_);
    return way_points_.asked() ? through_way_points(streams, common) : along_route(streams, common);
  }

 private:
  std::string fault() const {
    if (way_points_.asked() == !map_file_.empty()) return "needs either MAP or --waypoints";
    if (!way_points_.asked() && !question_.has_places()) return "--from and --to are required";
    if (way_points_.asked() && wants_lon_lat_) return "--lonlat needs MAP";
    if (way_points_.asked() && question_.has_any_place())
      return "--from, --via and --to need MAP, not --waypoints";
    return way_points_.fault();
  }

  Exit through_way_points(const Streams& streams, const CommonOptions& common) const {
    const WayPointLine::Table table = way_points_.table(step_m_, options_.max_smoothing_m);
    map::write_output(output_, table.csv, force_);
    if (!common.quiet) {
      for (const std::string& note : table.notes) fmt::print(streams.err, "note: {}\n", note);
      fmt::print(streams.err,
                 "{}: {:.1f} m, peak curvature {:.3f} 1/m, at most {:.2f} m off the way-points\n",
                 output_name(output_), table.length_m, table.peak_curvature_per_m,
                 table.largest_move_m);
    }
    return Exit::ok;
  }

  Exit along_route(const Streams& streams, const CommonOptions& common) const {
    const map::RoadMap road_map = map::load_map(map_file_);
    const RouteQuestion::Asked asked = question_.on(road_map);
    const planning::RouteAnswer answer =
        planning::Router(road_map, asked.options).find(asked.places());
    if (!answer.route) {
      fmt::print(streams.err, "roadbed: no route: {}\n", answer.reason);
      return Exit::no;
    }
    planning::ReferenceLineOptions options = options_;
    options.corner_vehicle = way_points_.vehicle();
    const auto line = planning::ReferenceLine::along(road_map, *answer.route, options);
    map::write_output(output_,
                      line_csv(road_map, line, stations(line.goal_s_m(), step_m_), wants_lon_lat_),
                      force_);
    if (!common.quiet) {
      const planning::LineDriving driving = planning::driving_along(
          line, line.goal_s_m(), options.corner_vehicle.value_or(geometry::VehicleShape{}),
          [&](const Eigen::Vector2d& place) {
            return !options.corner_vehicle || road_map.on_surface(place, kOffRoad_m);
          });
      for (const auto& notes : {line.notes(), planning::notes_on(driving.leaves)}) {
        for (const std::string& note : notes) fmt::print(streams.err, "note: {}\n", note);
      }
      fmt::print(streams.err,
                 "{}: {:.1f} m, peak curvature {:.3f} 1/m at {:.0f} m, of its rate {:.3f} 1/m² at "
                 "{:.0f} m, at most {:.2f} m off the centreline\n",
                 output_name(output_), line.goal_s_m(), driving.peak_curvature_per_m.value,
                 driving.peak_curvature_per_m.s_m, driving.peak_curvature_rate_per_m2.value,
                 driving.peak_curvature_rate_per_m2.s_m, line.largest_move_m());
    }
    return Exit::ok;
  }

  std::filesystem::path map_file_, output_;
  RouteQuestion question_;
  WayPointLine way_points_;
  planning::ReferenceLineOptions options_;
  double step_m_ = 0.5;
  bool force_ = false, wants_lon_lat_ = false;
};

}  // namespace

std::unique_ptr<Command> make_reference_command() { return std::make_unique<ReferenceCommand>(); }

}  // namespace roadbed::tools::commands::routes
