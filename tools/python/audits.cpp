#include <fmt/format.h>

#include <array>
#include <span>
#include <sstream>
#include <stdexcept>

#include "roadbed/map/storage/output_file.h"
#include "roadbed/planning/audit/audit_drive.h"
#include "roadbed/tools/audit/audit_clock.h"
#include "roadbed/tools/audit/audited_drive.h"
#include "roadbed/tools/audit/certificate_file_check.h"
#include "roadbed/tools/audit/certificate_json.h"
#include "roadbed/tools/cli/build_id.h"
#include "roadbed/tools/commands/audits/audit_frames.h"
#include "roadbed/tools/commands/audits/audit_output.h"
#include "roadbed/tools/files/json.h"
#include "roadbed/tools/files/trajectory_csv.h"
#include "roadbed/tools/python/occupancy.h"
#include "roadbed/tools/report/audit_pictures.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline python {
namespace {

constexpr double kAround_m = 60.0;  // that a picture shows

/// An audit, and all that it was asked with, so that it can be drawn and certified.
struct Audit {
  std::shared_ptr<const map::OccupancySource> occupancy;
  std::filesystem::path occupancy_file;
  Trajectory trajectory;
  VehicleOfFile vehicle = {};
  bool has_usual_vehicle = true;
  Obstacles obstacles = {};
  double underside_m = 0.2;
  RoadMapPointer road_map = nullptr;
  std::filesystem::path map_file = {};
  planning::AuditQuestion question = {};
  AuditedDrive audited = {};
};

planning::UnknownPolicy policy_of(const std::string& name) {
  for (const auto policy : {planning::UnknownPolicy::free, planning::UnknownPolicy::occupied,
                            planning::UnknownPolicy::report}) {
    if (planning::to_string(policy) == name) return policy;
  }
  throw std::invalid_argument(fmt::format("unknown: \"{}\", needs report, free or occupied", name));
}

// As on the command line: a height, "map" or "measured".
std::string ground_text(nb::handle ground) {
  if (ground.is_none()) return {};
  const std::string text = nb::isinstance<nb::str>(ground)
                               ? nb::cast<std::string>(ground)
                               : fmt::format("{}", nb::cast<double>(ground));
  const std::string fault = ground_rule_fault(text);
  if (!fault.empty()) throw std::invalid_argument(fmt::format("ground: \"{}\" {}", text, fault));
  return text;
}

struct AuditArguments {
  nb::handle trajectory, vehicle, map, obstacles, ground;
  double from_height_m;
  planning::AuditOptions options;
};

// Without one, that of a CommonRoad solution.
void take_vehicle(nb::handle given, Audit& audit) {
  const std::string& named = audit.trajectory.vehicle_of_solution;
  if (!given.is_none() || named.empty()) {
    audit.vehicle = vehicle_of(given);
    return;
  }
  audit.vehicle = {read_vehicle(named), named};
  audit.audited.vehicle_of_drive = named;
}

// In the time of the drive. Whoever checks a certificate reads them in that of their own problem.
void take_obstacles(nb::handle given, Audit& audit) {
  if (given.is_none()) return;
  const bool is_file = nb::isinstance<nb::str>(given) || nb::hasattr(given, "__fspath__");
  if (!is_file) {
    audit.obstacles = obstacles_of(given);
    return;
  }
  const std::array files{path_of(given), audit.map_file};
  const bool has_steps = !audit.trajectory.vehicle_of_solution.empty();
  const long start_step = has_steps ? 0 : second_0_step({}, files);
  audit.obstacles = obstacles_of(given, start_step);
  const bool is_own_time =
      !is_common_road(files[0]) || second_0_step({}, std::span(files).first(1)) == start_step;
  if (!is_own_time) audit.obstacles.file.clear();
}

Audit audit(const Occupancy& occupancy, const AuditArguments& given) {
  Audit made{.occupancy = occupancy.source,
             .occupancy_file = occupancy.file,
             .trajectory = trajectory_of(given.trajectory),
             .has_usual_vehicle = given.vehicle.is_none(),
             .underside_m = given.from_height_m};
  take_vehicle(given.vehicle, made);
  if (!given.map.is_none()) {
    const Map& map = nb::cast<const Map&>(given.map);
    made.road_map = map.road_map;
    made.map_file = map.file;
  }
  take_obstacles(given.obstacles, made);
  const std::string ground = ground_text(given.ground);
  if (ground == "map" && !made.road_map) throw std::invalid_argument("ground: \"map\" needs a map");
  const nb::gil_scoped_release released;
  if (made.road_map) {
    check_overlap(road_bounds(*made.road_map), measured_bounds(*made.occupancy),
                  occupancy.file.empty() ? "occupancy" : occupancy.file.string());
  }
  made.question = {.parts = made.vehicle.vehicle.parts(given.from_height_m),
                   .ground = ground_rule(ground, made.road_map.get()),
                   .options = given.options,
                   .moving_in_source = made.obstacles.in_source};
  made.audited.name = made.trajectory.file.filename().string();
  made.audited.take({.drive = made.trajectory.drive, .gaps = made.trajectory.gaps});
  audit_one({.occupancy = made.occupancy.get(), .question = made.question}, made.audited);
  return made;
}

// What the command `audit --certificate` writes of the same files.
void save_certificate(Audit& audit, nb::handle path, nb::handle trajectory) {
  const std::filesystem::path certificate = path_of(path);
  if (!trajectory.is_none()) {
    audit.trajectory.file = path_of(trajectory);
    map::write_output(audit.trajectory.file, write_trajectory_csv(audit.trajectory.drive), true);
  }
  const auto require = [](bool is_there, const char* what) {
    if (!is_there)
      throw std::invalid_argument(std::string("a certificate is about files: ") + what);
  };
  require(!audit.occupancy_file.empty(), "save the occupancy before the audit");
  require(!audit.trajectory.file.empty(), "say trajectory=, where the drive is to be written");
  require(audit.has_usual_vehicle || !audit.vehicle.file.empty(), "open the vehicle from its file");
  require(audit.obstacles.in_source.empty() || !audit.obstacles.file.empty(),
          "give the obstacles as their file; as a table (.csv), if they are of a CommonRoad file "
          "that begins at another time step than the drive's second 0");
  const nb::gil_scoped_release released;
  planning::AuditQuestion question = audit.question;
  question.certifies = true;
  planning::DriveAudit certified =
      planning::audit_drive(*audit.occupancy, audit.audited.drive, question);
  const auto& between_poses = audit.audited.between_poses;
  if (!between_poses.empty()) planning::leave_unknown(between_poses, certified);
  CertificateFile file{.program = name_and_version(),
                       .occupancy = certified_file(audit.occupancy_file),
                       .trajectory = certified_file(audit.trajectory.file),
                       .underside_m = audit.underside_m,
                       .ground = {question.ground.kind, certified.ground},
                       .least_measured = question.options.least_measured,
                       .parts = certified.certificates};
  if (!audit.obstacles.file.empty()) {
    file.obstacles = certified_obstacles(audit.obstacles.file, question.moving_in_source);
  }
  if (!audit.vehicle.file.empty()) file.vehicle = certified_file(audit.vehicle.file);
  if (audit.road_map) file.roads = certified_file(audit.map_file);
  map::write_output(certificate, write_certificate_json(file), true);
}

std::string picture_of(const Audit& audit) {
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(kAround_m);
  const map::Box2 reach =
      planning::audited_region(audit.audited.drive, audit.question.parts, audit.question.options)
          .around;
  const map::Box2 around{reach.min_in_source - margin, reach.max_in_source + margin};
  std::vector<geometry::Ring> lanes;
  if (audit.road_map) lanes = drivable_rings(*audit.road_map, around);
  return audit_svg(
      {audit.audited.drive, audit.question.inflated_parts(), audit.audited.audit.report,
       occupied_boxes(*audit.occupancy, audit.question.heights(audit.audited.audit.ground), around),
       std::move(lanes), audit.question.moving_in_source});
}

Array2 profile_of(const Audit& audit) {
  std::vector<double> values;
  for (const auto& sample : audit.audited.audit.report.profile) {
    values.insert(values.end(), {sample.t_s, sample.clearance_m});
  }
  return owned<double, 2>(std::move(values), {audit.audited.audit.report.profile.size(), 2});
}

nb::object audit_document(const Audit& audit) {
  return object_of(versioned("audit", audit_json(audit.audited)));
}

/// Whether a certificate holds, with all that was looked at.
struct CertificateCheck {
  bool holds = false;
  nlohmann::ordered_json document;
};

CertificateCheck check(const std::filesystem::path& certificate,
                       const CertificateDemands& demands) {
  const nb::gil_scoped_release released;
  std::ostringstream printed;
  CertificateCheck found;
  found.holds = check_certificate_file(certificate, demands, true, Inputs(), printed);
  found.document = nlohmann::ordered_json::parse(printed.str());
  return found;
}

void bind_audit_results(nb::class_<Audit>& bound) {
  bound
      .def_prop_ro(
          "verdict", [](const Audit& of) { return std::string(of.audited.outcome()); },
          "\"clear\", \"conflict\", \"unknown\" (too little was measured), or \"undecided\".")
      .def_prop_ro(
          "least_clearance_m",
          [](const Audit& of) { return of.audited.audit.report.least_clearance_m; },
          "Least distance of the vehicle from what is occupied or moves [m], to within 0.02 m and "
          "over all times, between the rows too.")
      .def_prop_ro(
          "least_clearance_at_s",
          [](const Audit& of) { return of.audited.audit.report.least_clearance_at_s; },
          "When that is [s].")
      .def_prop_ro("profile", &profile_of, nb::rv_policy::reference,
                   "Clearance over time: rows (N, 2) of t [s] and distance [m], beyond 5 m a lower "
                   "bound of it.")
      .def_prop_ro(
          "conflicts", [](const Audit& of) { return nb::object(audit_document(of)["conflicts"]); },
          nb::sig("def conflicts(self) -> list[dict[str, typing.Any]]"),
          "Stretches of time in which it is too near, in order: from_s, to_s, least_clearance_m, "
          "the state `at` it, the `part` of the vehicle, the `obstacle` or the cell (`witness`).")
      .def("to_dict", &audit_document, nb::sig("def to_dict(self) -> dict[str, typing.Any]"),
           "All of it, as `roadbed audit --json` prints it.")
      .def(
          "save_certificate", &save_certificate, nb::arg("path"), nb::kw_only(),
          nb::arg("trajectory") = nb::none(),
          nb::sig("def save_certificate(self, path: str | os.PathLike[str], *, trajectory: str | "
                  "os.PathLike[str] | None = None) -> None"),
          "Writes the proof (.json), which `check` verifies by brute force. It is about files, by "
          "their hashes: the occupancy's, the drive's, which is written to `trajectory` if that is "
          "given, and those of vehicle, map and obstacles.")
      .def("__bool__", [](const Audit& of) { return of.audited.is_clear(); })
      .def("__str__", [](const Audit& of) { return audit_text(of.audited); })
      .def("__repr__",
           [](const Audit& of) {
             return fmt::format("<Audit: {}, least clearance {:.2f} m at {:.2f} s>",
                                of.audited.outcome(), of.audited.audit.report.least_clearance_m,
                                of.audited.audit.report.least_clearance_at_s);
           })
      .def("_repr_svg_", &picture_of);
}

void bind_check(nb::module_& module) {
  nb::class_<CertificateCheck>(module, "CertificateCheck",
                               "Whether every claim of a certificate holds: true if so.")
      .def("__bool__", [](const CertificateCheck& of) { return of.holds; })
      .def(
          "to_dict", [](const CertificateCheck& of) { return object_of(of.document); },
          nb::sig("def to_dict(self) -> dict[str, typing.Any]"),
          "What does not hold, and the files that were looked at, as `roadbed audit --check "
          "--json` prints it.")
      .def("__repr__", [](const CertificateCheck& of) {
        return fmt::format("<CertificateCheck: {}>", of.holds ? "holds" : "does not hold");
      });
  module.def(
      "check",
      [](nb::handle certificate, nb::handle occupancy, nb::handle trajectory, nb::handle vehicle,
         nb::handle map, nb::handle obstacles, nb::handle ground, std::optional<double> clearance_m,
         std::optional<double> inflate_m, std::optional<double> from_height_m,
         std::optional<double> least_measured, std::optional<std::string> unknown) {
        const auto file = [](nb::handle path) {
          return path.is_none() ? std::filesystem::path() : path_of(path);
        };
        CertificateDemands demands{.occupancy = file(occupancy),
                                   .trajectory = file(trajectory),
                                   .vehicle = file(vehicle),
                                   .map = file(map),
                                   .obstacles = file(obstacles),
                                   .ground = ground_text(ground),
                                   .clearance_m = clearance_m,
                                   .inflate_m = inflate_m,
                                   .underside_m = from_height_m,
                                   .least_measured = least_measured};
        if (unknown) demands.unknown = policy_of(*unknown);
        return check(path_of(certificate), demands);
      },
      nb::arg("certificate"), nb::kw_only(), nb::arg("occupancy") = nb::none(),
      nb::arg("trajectory") = nb::none(), nb::arg("vehicle") = nb::none(),
      nb::arg("map") = nb::none(), nb::arg("obstacles") = nb::none(),
      nb::arg("ground") = nb::none(), nb::arg("clearance_m") = nb::none(),
      nb::arg("inflate_m") = nb::none(), nb::arg("from_height_m") = nb::none(),
      nb::arg("least_measured") = nb::none(), nb::arg("unknown") = nb::none(),
      nb::sig("def check(certificate: str | os.PathLike[str], *, occupancy: str | os.PathLike[str] "
              "| None = None, trajectory: str | os.PathLike[str] | None = None, vehicle: str | "
              "os.PathLike[str] | None = None, map: str | os.PathLike[str] | None = None, "
              "obstacles: str | os.PathLike[str] | None = None, ground: float | "
              "typing.Literal['map', 'measured'] | None = None, clearance_m: float | None = None, "
              "inflate_m: float | None = None, from_height_m: float | None = None, "
              "least_measured: float | None = None, unknown: typing.Literal['report', 'free', "
              "'occupied'] | None = None) -> CertificateCheck"),
      "Verifies a certificate by brute force, from the files that it names; what is given besides "
      "it has to be about.\n\nRaises InputError if the certificate or a file is unusable.");
}

}  // namespace

void bind_audits(nb::module_& module) {
  nb::class_<Audit> bound(module, "Audit",
                          "Whether a drive keeps clear, with proof for every time of it, between "
                          "its rows too: true where it is clear.");
  bind_audit_results(bound);
  bind_check(module);
  auto occupancy = nb::borrow<nb::class_<Occupancy>>(module.attr("Occupancy"));
  occupancy.def(
      "audit",
      [](const Occupancy& of, nb::handle trajectory, nb::handle vehicle, nb::handle map,
         nb::handle obstacles, double clearance_m, double inflate_m, const std::string& unknown,
         double least_measured, nb::handle ground, double from_height_m) {
        return audit(of, {trajectory,
                          vehicle,
                          map,
                          obstacles,
                          ground,
                          from_height_m,
                          {.clearance_m = clearance_m,
                           .inflate_m = inflate_m,
                           .unknown = policy_of(unknown),
                           .least_measured = least_measured}});
      },
      nb::arg("trajectory"), nb::kw_only(), nb::arg("vehicle") = nb::none(),
      nb::arg("map") = nb::none(), nb::arg("obstacles") = nb::none(), nb::arg("clearance_m") = 0.0,
      nb::arg("inflate_m") = 0.0, nb::arg("unknown") = "report", nb::arg("least_measured") = 0.0,
      nb::arg("ground") = nb::none(), nb::arg("from_height_m") = map::HeightBand{}.from_m,
      nb::sig("def audit(self, trajectory: Trajectory | str | os.PathLike[str] | "
              "numpy.typing.ArrayLike, *, vehicle: Vehicle | str | os.PathLike[str] | None = None, "
              "map: Map | None = None, obstacles: str | os.PathLike[str] | "
              "collections.abc.Iterable[Obstacle] | None = None, clearance_m: float = 0.0, "
              "inflate_m: float = 0.0, unknown: typing.Literal['report', 'free', 'occupied'] = "
              "'report', least_measured: float = 0.0, ground: float | typing.Literal['map', "
              "'measured'] | None = None, from_height_m: float = 0.2) -> Audit"),
      "Proves that a drive keeps clear of occupied space and of what moves, or shows where it does "
      "not.\n\n"
      "trajectory: rows (N, 4) to (N, 8), see Trajectory; vehicle: by default that of a CommonRoad "
      "solution, else CommonRoad's vehicle 2; obstacles: see read_obstacles, but beside such a "
      "solution they have its absolute time steps; clearance_m: less distance is a "
      "conflict; "
      "inflate_m: margin around the vehicle; unknown: what space counts as that was not measured; "
      "least_measured: fraction of the space that the vehicle takes that has to be measured; "
      "ground: what heights are above: a height, the lanes of the `map`, or what was measured; by "
      "default the map's where there is one, else 0.");
}

}  // namespace roadbed::tools::python
