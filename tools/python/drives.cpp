#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>

#include "roadbed/map/storage/output_folder.h"
#include "roadbed/tools/python/motion.h"
#include "roadbed/tools/python/routes.h"
#include "roadbed/tools/report/drive_files.h"

namespace roadbed::tools::inline python {
namespace {

/// What a planner of the user's sees, apart from the world that it was seen in.
struct Seen {
  double t_s;
  geometry::TrajectoryPoint ego;
  std::vector<SeenObstacle> obstacles;
  Eigen::Vector2d goal;
  double s_m, d_m;
  LineOfMap line;
  geometry::VehicleShape vehicle;
};

Seen seen_of(const Observation& seen) {
  const World& world = seen.world;
  return {.t_s = seen.t_s,
          .ego = seen.ego,
          .obstacles = seen.obstacles,
          .goal = seen.goal,
          .s_m = seen.s_m,
          .d_m = seen.d_m,
          .line = {world.kept_map, world.line, world.road_map.origin_in_source()},
          .vehicle = seen.scenario.vehicle};
}

Array1 pose_array(const geometry::Pose2& pose) {
  return owned(std::vector<double>{pose.x_m, pose.y_m, pose.heading_rad});
}

planning::ObstacleInSource keeps_on(const SeenObstacle& seen, double t_s, double horizon_s) {
  const geometry::Pose2& pose = seen.pose;
  const geometry::TrajectoryPoint now{t_s, pose.x_m, pose.y_m, pose.heading_rad, seen.speed_mps};
  std::vector<geometry::TrajectoryPoint> points{now};
  if (seen.speed_mps > 0.0) {
    geometry::TrajectoryPoint then = now;
    then.t_s += horizon_s;
    then.x_m += horizon_s * seen.speed_mps * std::cos(pose.heading_rad);
    then.y_m += horizon_s * seen.speed_mps * std::sin(pose.heading_rad);
    points.push_back(then);
  }
  return {.id = seen.id,
          .kind = seen.kind,
          .length_m = seen.length_m,
          .width_m = seen.width_m,
          .motion = geometry::Trajectory(std::move(points))};
}

/// None, a trajectory, a plan, or one of these with a reason.
OutsidePlan outside_plan(nb::handle answer) {
  if (answer.is_none()) return {};
  if (nb::isinstance<nb::tuple>(answer) && nb::len(answer) == 2 &&
      nb::isinstance<nb::str>(answer[1])) {
    OutsidePlan plan = outside_plan(answer[0]);
    plan.reason = nb::cast<std::string>(answer[1]);
    return plan;
  }
  if (nb::hasattr(answer, "trajectory")) return outside_plan(answer.attr("trajectory"));
  if (nb::isinstance<Trajectory>(answer)) return {nb::cast<const Trajectory&>(answer).drive};
  const Rows rows = rows_of(answer, "trajectory", 5, 8);
  return {rows.shape(0) == 0 ? geometry::Trajectory() : trajectory_of(answer).drive};
}

// Called by the loop, which runs without the interpreter's lock, and copies what it is given.
OutsidePlanner planner_of(nb::object callable) {
  return [kept = std::make_shared<nb::object>(std::move(callable))](const Observation& seen) {
    const nb::gil_scoped_acquire acquired;
    return outside_plan((*kept)(nb::cast(seen_of(seen))));
  };
}

struct DriveArguments {
  nb::handle scenario, planner, vehicle, noise, options;
  std::optional<bool> predict;
  bool candidates, mcap, drop_ego_recording;
  std::optional<std::uint64_t> seed;
  double planner_limit_s;
};

std::unique_ptr<DrivenScenario> simulate(const DriveArguments& given) {
  const auto file = [](nb::handle path) {
    return path.is_none() ? std::filesystem::path() : path_of(path);
  };
  DriveChoice choice{.predicts = given.predict,
                     .keeps_candidates = given.candidates,
                     .writes_mcap = given.mcap,
                     .noise_file = file(given.noise),
                     .planner_file = file(given.options),
                     .planner_limit_s = given.planner_limit_s};
  choice.changes.drops_ego_recording = given.drop_ego_recording;
  choice.changes.seed = given.seed;
  if (nb::isinstance<VehicleOfFile>(given.vehicle)) {
    choice.changes.vehicle = shape_of(given.vehicle);
  } else {
    choice.vehicle_file = file(given.vehicle);
  }
  if (nb::isinstance<nb::str>(given.planner)) {
    choice.planner_command = nb::cast<std::string>(given.planner);
  } else if (!given.planner.is_none()) {
    choice.outside_planner = planner_of(nb::borrow(given.planner));
  }
  const std::filesystem::path scenario = path_of(given.scenario);
  std::unique_ptr<DrivenScenario> driven;
  {
    const nb::gil_scoped_release released;
    choice.read_files();
    driven = std::make_unique<DrivenScenario>(drive_scenario(scenario, choice));
  }
  return driven;
}

const std::string& file_of(const DrivenScenario& driven, const std::string& name) {
  return std::ranges::find(driven.files, name, &std::pair<std::string, std::string>::first)->second;
}

nb::dict samples_of(const DrivenScenario& driven) {
  nb::dict columns;
  const auto add = [&](const char* name, double DriveSample::*member) {
    std::vector<double> values;
    for (const DriveSample& sample : driven.drive.samples) values.push_back(sample.*member);
    columns[name] = owned(std::move(values));
  };
  add("t_s", &DriveSample::t_s);
  add("s_m", &DriveSample::s_m);
  add("set_speed_mps", &DriveSample::set_speed_mps);
  add("speed_limit_mps", &DriveSample::speed_limit_mps);
  add("command_mps2", &DriveSample::command_mps2);
  add("cross_track_m", &DriveSample::cross_track_m);
  add("heading_error_rad", &DriveSample::heading_error_rad);
  add("clearance_m", &DriveSample::clearance_m);
  add("throttle", &DriveSample::throttle);
  add("brake", &DriveSample::brake);
  add("off_road_m", &DriveSample::off_road_m);
  return columns;
}

nb::list lines_of(const std::string& json_lines) {
  nb::list list;
  nb::object loads = nb::module_::import_("json").attr("loads");
  for (std::size_t at = 0; at < json_lines.size();) {
    const std::size_t end = json_lines.find('\n', at);
    list.append(loads(json_lines.substr(at, end - at)));
    at = end + 1;
  }
  return list;
}

void save(const DrivenScenario& driven, const std::filesystem::path& folder, bool force) {
  map::OutputFolder output(folder, {.force = force});
  for (const auto& [name, bytes] : driven.files) output.write(name, bytes);
  output.write(kDriveRecordName, write_drive_record(driven.record, folder));
  output.commit();
}

void bind_seen(nb::module_& module) {
  nb::class_<SeenObstacle>(module, "SeenObstacle", "Another road user, as it is at one time.")
      .def_ro("id", &SeenObstacle::id)
      .def_ro("kind", &SeenObstacle::kind)
      .def_ro("length_m", &SeenObstacle::length_m)
      .def_ro("width_m", &SeenObstacle::width_m)
      .def_ro("speed_mps", &SeenObstacle::speed_mps)
      .def_prop_ro(
          "pose", [](const SeenObstacle& seen) { return pose_array(seen.pose); },
          nb::rv_policy::reference, "x, y and heading of its centre (3) [m, rad].");
  nb::class_<Seen>(module, "Observation", "What a planner gets to see at one cycle of a drive.")
      .def_ro("t_s", &Seen::t_s, "Time of the drive [s].")
      .def_prop_ro(
          "pose", [](const Seen& seen) { return pose_array(seen.ego.pose()); },
          nb::rv_policy::reference, "Measured x, y and heading of the rear axle (3) [m, rad].")
      .def_prop_ro("speed_mps", [](const Seen& seen) { return seen.ego.speed_mps; })
      .def_prop_ro("acceleration_mps2", [](const Seen& seen) { return seen.ego.acceleration_mps2; })
      .def_prop_ro("steering_rad", [](const Seen& seen) { return seen.ego.steering_rad; })
      .def_ro("s_m", &Seen::s_m, "Station of the vehicle on the reference line [m].")
      .def_ro("d_m", &Seen::d_m, "Its offset to the line's left [m].")
      .def_ro("line", &Seen::line, "The reference line of the scenario's route.")
      .def_prop_ro(
          "goal",
          [](const Seen& seen) {
            return owned(std::vector<double>{seen.goal.x(), seen.goal.y()});
          },
          nb::rv_policy::reference, "Where the route ends (2) [m].")
      .def_prop_ro(
          "vehicle",
          [](const Seen& seen) {
            return VehicleOfFile{{seen.vehicle, {}, {}}, {}};
          },
          "The own vehicle.")
      .def_ro("obstacles", &Seen::obstacles, "Who else is there.")
      .def(
          "predict",
          [](const Seen& seen, double horizon_s) {
            std::vector<planning::ObstacleInSource> obstacles;
            for (const SeenObstacle& one : seen.obstacles) {
              obstacles.push_back(keeps_on(one, seen.t_s, horizon_s));
            }
            return obstacles;
          },
          nb::arg("horizon_s") = 8.0,
          "The obstacles as they would move if all kept speed and heading from now on.");
}

void bind_drive(nb::module_& module) {
  nb::class_<DrivenScenario>(module, "Drive",
                             "A closed-loop drive through a scenario: true where the goal was "
                             "reached.")
      .def("__bool__",
           [](const DrivenScenario& of) { return of.verdict.outcome == Outcome::goal_reached; })
      .def_prop_ro(
          "outcome",
          [](const DrivenScenario& of) { return std::string(to_string(of.verdict.outcome)); },
          "\"goal reached\", \"stopped\", \"collision\", \"timed out\" or \"left the road\".")
      .def_prop_ro(
          "text", [](const DrivenScenario& of) { return of.verdict.text; },
          "How it ended, in one line.")
      .def_prop_ro(
          "trajectory",
          [](const DrivenScenario& of) {
            return Trajectory{of.drive.trajectory, {}};
          },
          "The true states, every 0.1 s.")
      .def_prop_ro(
          "samples", &samples_of,
          nb::sig("def samples(self) -> dict[str, numpy.typing.NDArray[numpy.float64]]"),
          "What is known at each row of the trajectory, as columns: t_s, s_m, "
          "set_speed_mps, speed_limit_mps, command_mps2, cross_track_m, heading_error_rad, "
          "clearance_m, throttle, brake, off_road_m.")
      .def_prop_ro(
          "metrics",
          [](const DrivenScenario& of) {
            return object_of(nlohmann::ordered_json::parse(file_of(of, "metrics.json")));
          },
          nb::sig("def metrics(self) -> dict[str, typing.Any]"),
          "What `metrics.json` holds: extremes, comfort, time per behaviour, the audit.")
      .def_prop_ro(
          "cycles", [](const DrivenScenario& of) { return lines_of(file_of(of, "cycles.jsonl")); },
          nb::sig("def cycles(self) -> list[dict[str, typing.Any]]"),
          "What was decided in each cycle, and why.")
      .def_prop_ro(
          "events",
          [](const DrivenScenario& of) {
            std::vector<std::string> texts;
            for (const DriveEvent& event : of.drive.events) {
              texts.push_back(
                  fmt::format("{:.1f} s, {}: {}", event.t_s, to_string(event.level), event.text));
            }
            return texts;
          },
          "What happened, a line each.")
      .def_prop_ro(
          "report_html", [](const DrivenScenario& of) { return file_of(of, "report.html"); },
          "The page that plays the drive, without any other file.")
      .def(
          "save",
          [](const DrivenScenario& of, nb::handle folder, bool force) {
            save(of, path_of(folder), force);
          },
          nb::arg("folder"), nb::kw_only(), nb::arg("force") = false,
          nb::sig("def save(self, folder: str | os.PathLike[str], *, force: bool = False) -> None"),
          "Writes what `roadbed simulate -o` writes: trajectory.csv, cycles.jsonl, metrics.json, "
          "report.html, drive.svg, replay.json, with `mcap=True` drive.mcap, of CommonRoad "
          "solution.xml.\n\n"
          "Raises OutputError if the folder holds something, unless `force` is set.")
      .def("__str__", [](const DrivenScenario& of) { return of.name + ": " + of.verdict.text; })
      .def("__repr__",
           [](const DrivenScenario& of) {
             return fmt::format("<Drive {}: {}>", of.name, of.verdict.text);
           })
      .def("_repr_svg_", [](const DrivenScenario& of) { return file_of(of, "drive.svg"); });
}

}  // namespace

void bind_drives(nb::module_& module) {
  bind_seen(module);
  bind_drive(module);
  module.def(
      "simulate",
      [](nb::handle scenario, nb::handle planner, nb::handle vehicle, nb::handle noise,
         nb::handle options, std::optional<bool> predict, bool candidates, bool mcap,
         bool drop_ego_recording, std::optional<std::uint64_t> seed, double planner_limit_s) {
        return simulate({scenario, planner, vehicle, noise, options, predict, candidates, mcap,
                         drop_ego_recording, seed, planner_limit_s});
      },
      nb::arg("scenario"), nb::arg("planner") = nb::none(), nb::kw_only(),
      nb::arg("vehicle") = nb::none(), nb::arg("noise") = nb::none(),
      nb::arg("options") = nb::none(), nb::arg("predict") = nb::none(),
      nb::arg("candidates") = false, nb::arg("mcap") = false, nb::arg("drop_ego_recording") = false,
      nb::arg("seed") = nb::none(), nb::arg("planner_limit_s") = 60.0,
      nb::sig(
          "def simulate(scenario: str | os.PathLike[str], planner: "
          "collections.abc.Callable[[Observation], typing.Any] | str | None = None, *, vehicle: "
          "Vehicle | str | os.PathLike[str] | None = None, noise: str | os.PathLike[str] | None "
          "= None, options: str | os.PathLike[str] | None = None, predict: bool | None = None, "
          "candidates: bool = False, mcap: bool = False, drop_ego_recording: bool = False, seed: "
          "int | None = "
          "None, planner_limit_s: float = 60.0) -> Drive"),
      "Drives a scenario (.json, or CommonRoad .xml) in a closed loop: a cycle plans every 0.1 s, "
      "controllers steer and accelerate every 0.01 s.\n\n"
      "planner: drives in place of roadbed's own. It is called with an Observation once a cycle "
      "and "
      "returns where to drive: rows (N, 5) to (N, 8) of t, x, y, heading, speed, … from now on, a "
      "Trajectory or a Plan; None: the last one holds; or a pair of that and a reason in words. "
      "The loop follows it and the same report judges it. A text is the command of a process that "
      "answers a line of JSON with a line of JSON, within planner_limit_s each.\n"
      "vehicle, noise, options, seed: in place of the scenario's; predict: others are measured, "
      "tracked and foreseen, or (False) their true future is known; None: the first in roadbed's "
      "own scenarios, the second in CommonRoad's; candidates: keep what became of each candidate, "
      "for the report; mcap: "
      "make drive.mcap, too, a log for Foxglove, Lichtblick and Rerun.");
}

}  // namespace roadbed::tools::python
