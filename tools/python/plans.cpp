#include <fmt/format.h>
#include <nanobind/stl/map.h>

#include <cmath>
#include <map>
#include <stdexcept>

#include "roadbed/planning/lateral/planned_path.h"
#include "roadbed/planning/plan.h"
#include "roadbed/tools/commands/audits/audit_frames.h"
#include "roadbed/tools/python/occupancy.h"
#include "roadbed/tools/python/routes.h"
#include "roadbed/tools/report/plan_svg.h"

namespace roadbed::tools::inline python {
namespace {

using planning::Candidate;
using planning::CostTerm;
using planning::CostTerms;
using planning::PlanOptions;

constexpr std::size_t kCandidateDoubles = sizeof(Candidate) / sizeof(double);
static_assert(sizeof(Candidate) % sizeof(double) == 0);

/// What a planning cycle found, and all that it was asked with.
struct PlanOf {
  LineOfMap line;
  geometry::VehicleShape vehicle;
  std::vector<planning::Obstacle> obstacles = {};
  std::shared_ptr<const map::OccupancySource> occupancy = nullptr;  ///< none: no occupancy
  std::shared_ptr<const map::ClearanceField> field = nullptr;
  map::HeightBand band = {};
  PlanOptions options = {};
  std::optional<planning::PlanInput> input = {};  ///< refers to the members before it
  planning::Plan plan = {};
};

CostTerm term_of(const std::string& name) {
  for (int i = 0; i < planning::kCostTerms; ++i) {
    const auto term = static_cast<CostTerm>(i);
    if (planning::to_string(term) == name) return term;
  }
  throw std::invalid_argument(
      fmt::format("weights: no term \"{}\"; see roadbed.default_weights()", name));
}

nb::dict by_term(const CostTerms& terms) {
  nb::dict dict;
  for (int i = 0; i < planning::kCostTerms; ++i) {
    const auto term = static_cast<CostTerm>(i);
    dict[std::string(planning::to_string(term)).c_str()] = planning::of(terms, term);
  }
  return dict;
}

PlanOptions plan_options(const nb::kwargs& given) {
  PlanOptions options;
  options.keep_candidates = true;
  const std::map<std::string, double PlanOptions::*> numbers = {
      {"d_step_m", &PlanOptions::d_step_m},
      {"l_step_m", &PlanOptions::l_step_m},
      {"min_d_m", &PlanOptions::min_d_m},
      {"max_d_m", &PlanOptions::max_d_m},
      {"min_l_m", &PlanOptions::min_l_m},
      {"max_l_m", &PlanOptions::max_l_m},
      {"clearance_m", &PlanOptions::clearance_m},
      {"max_lateral_acceleration_mps2", &PlanOptions::max_lateral_acceleration_mps2},
      {"border_margin_m", &PlanOptions::border_margin_m},
      {"recovery_m", &PlanOptions::recovery_m},
      {"horizon_s", &PlanOptions::horizon_s},
      {"completion_horizon_s", &PlanOptions::completion_horizon_s},
      {"completion_deceleration_mps2", &PlanOptions::completion_deceleration_mps2}};
  for (const auto [key, value] : given) {
    const auto name = nb::cast<std::string>(key);
    if (const auto number = numbers.find(name); number != numbers.end()) {
      options.*number->second = nb::cast<double>(value);
    } else if (name == "points") {
      options.points = nb::cast<int>(value);
    } else if (name == "circles") {
      options.circles = nb::cast<int>(value);
    } else if (name == "limit_steering_rate") {
      options.limit_steering_rate = nb::cast<bool>(value);
    } else if (name == "keep_candidates") {
      options.keep_candidates = nb::cast<bool>(value);
    } else {
      throw nb::type_error(fmt::format("there is no option of a plan \"{}\"", name).c_str());
    }
  }
  return options;
}

planning::Obstacle on_line(const LineOfMap& line, const planning::ObstacleInSource& obstacle) {
  if (line.road_map) return obstacle_in_map(*line.road_map, obstacle);
  std::vector<geometry::TrajectoryPoint> points = obstacle.motion.points();
  for (geometry::TrajectoryPoint& point : points) {
    point.x_m -= line.origin_in_source.x();
    point.y_m -= line.origin_in_source.y();
  }
  return {.id = obstacle.id,
          .kind = obstacle.kind,
          .length_m = obstacle.length_m,
          .width_m = obstacle.width_m,
          .motion = geometry::Trajectory(std::move(points)),
          .validity = obstacle.validity};
}

struct PlanArguments {
  nb::handle pose, target_mps, obstacles, occupancy, vehicle, weights, previous;
  double speed_mps, acceleration_mps2, steering_rad, t_s;
  const nb::kwargs& options;
};

planning::LateralState start_of(const PlanOf& made, nb::handle pose, double steering_rad) {
  const Rows row = rows_of(pose, "pose", 3);
  if (row.shape(0) != 1) throw std::invalid_argument("pose: is many, needs x, y, heading");
  const Eigen::Vector2d place =
      Eigen::Vector2d(row.data()[0], row.data()[1]) - made.line.origin_in_source;
  return planning::lateral_state(made.line.line, {place.x(), place.y(), row.data()[2]},
                                 std::tan(steering_rad) / made.vehicle.wheelbase_m,
                                 made.line.line.project(place).s_m);
}

std::unique_ptr<PlanOf> plan(const LineOfMap& line, const PlanArguments& given) {
  auto made = std::make_unique<PlanOf>(PlanOf{.line = line, .vehicle = shape_of(given.vehicle)});
  made->options = plan_options(given.options);
  if (!given.weights.is_none()) {
    for (const auto& [name, weight] : nb::cast<std::map<std::string, double>>(given.weights)) {
      planning::of(made->options.weights, term_of(name)) = weight;
    }
  }
  for (const planning::ObstacleInSource& obstacle : obstacles_of(given.obstacles).in_source) {
    made->obstacles.push_back(on_line(line, obstacle));
  }
  if (!given.occupancy.is_none()) {
    const auto& occupancy = nb::cast<const Occupancy&>(given.occupancy);
    made->occupancy = occupancy.source;
    made->band = {.to_m = made->vehicle.height_m};
    const nb::gil_scoped_release released;
    made->field = occupancy.field(made->band);
  }
  const planning::LateralState start = start_of(*made, given.pose, given.steering_rad);
  const double target_mps = given.target_mps.is_none()
                                ? line.line.corridor_at(start.s_m).speed_limit_mps
                                : nb::cast<double>(given.target_mps);
  std::optional<planning::Plan> before;
  if (!given.previous.is_none()) before = nb::cast<const PlanOf&>(given.previous).plan;
  const nb::gil_scoped_release released;
  made->input.emplace(planning::PlanInput{.line = made->line.line,
                                          .start = start,
                                          .start_t_s = given.t_s,
                                          .speed = {.speed_mps = given.speed_mps,
                                                    .acceleration_mps2 = given.acceleration_mps2,
                                                    .target_mps = target_mps},
                                          .obstacles = made->obstacles,
                                          .static_field = made->field.get(),
                                          .origin_in_source = made->line.origin_in_source});
  if (before && before->chosen) {
    made->input->previous_d_m = [&](double s_m) { return before->lateral_at(s_m).d_m; };
  }
  made->plan = planning::plan_path(*made->input, made->vehicle, made->options);
  made->input->previous_d_m = {};
  return made;
}

Trajectory trajectory_in_source(const PlanOf& of) {
  std::vector<geometry::TrajectoryPoint> points = of.plan.trajectory.points();
  if (points.empty()) return {};
  for (geometry::TrajectoryPoint& point : points) {
    point.x_m += of.line.origin_in_source.x();
    point.y_m += of.line.origin_in_source.y();
  }
  return {geometry::Trajectory(std::move(points))};
}

// Columns of the plan's own memory: a candidate is a row of doubles but for its last member.
template <typename Value>
Array1 candidate_column(nb::handle self, Value Candidate::*member) {
  const auto& candidates = nb::cast<const PlanOf&>(self).plan.candidates;
  const std::size_t shape[] = {candidates.size()};
  const std::int64_t stride[] = {kCandidateDoubles};
  static const double none = 0.0;
  return {candidates.empty() ? &none : &(candidates.front().*member), 1, shape, self, stride};
}

nb::dict candidates_of(nb::handle self) {
  const auto& candidates = nb::cast<const PlanOf&>(self).plan.candidates;
  nb::dict columns;
  columns["end_d_m"] = candidate_column(self, &Candidate::end_d_m);
  columns["end_l_m"] = candidate_column(self, &Candidate::end_l_m);
  columns["cost"] = candidate_column(self, &Candidate::cost);
  const std::size_t shape[] = {candidates.size(), planning::kCostTerms};
  const std::int64_t stride[] = {kCandidateDoubles, 1};
  static const double none = 0.0;
  columns["terms"] =
      Array2(candidates.empty() ? &none : candidates.front().terms.data(), 2, shape, self, stride);
  nb::list rejections;
  for (const Candidate& candidate : candidates) {
    const std::string_view name = planning::to_string(candidate.rejection);
    rejections.append(nb::str(name.data(), name.size()));
  }
  columns["rejection"] = nb::module_::import_("numpy").attr("array")(rejections);
  return columns;
}

nb::object chosen_of(const PlanOf& of) {
  if (!of.plan.chosen) return nb::none();
  nb::dict dict;
  dict["end_d_m"] = of.plan.chosen->end_d_m;
  dict["end_l_m"] = of.plan.chosen->end_l_m;
  dict["cost"] = of.plan.chosen->cost;
  dict["terms"] = by_term(of.plan.chosen->terms);
  return dict;
}

std::string plan_picture(const PlanOf& of) {
  std::vector<map::Box2> occupied;
  if (of.occupancy) {
    constexpr double reach_m = 60.0;
    const Eigen::Vector2d at = of.input->line.at(of.plan.start.s_m).in_map +
                               of.line.origin_in_source,
                          reach = Eigen::Vector2d::Constant(reach_m);
    occupied = occupied_boxes(*of.occupancy, of.band, {at - reach, at + reach});
  }
  return plan_svg({*of.input, of.plan, of.vehicle, of.obstacles, std::move(occupied), "plan"});
}

void bind_plan(nb::module_& module) {
  nb::class_<PlanOf>(module, "Plan",
                     "What one planning cycle found: true if a candidate is chosen; else `reason` "
                     "says why none is.")
      .def("__bool__", [](const PlanOf& of) { return of.plan.chosen.has_value(); })
      .def_prop_ro("trajectory", &trajectory_in_source,
                   "The chosen drive, from the time of the cycle on; empty if there is none.")
      .def_prop_ro("chosen", &chosen_of,
                   nb::sig("def chosen(self) -> dict[str, typing.Any] | None"),
                   "The chosen candidate: end_d_m and end_l_m, its end beside and along the line, "
                   "`cost`, and `terms`, its twelve parts before they are weighted.")
      .def_prop_ro("candidates", &candidates_of,
                   nb::sig("def candidates(self) -> dict[str, numpy.typing.NDArray[typing.Any]]"),
                   "All candidates as columns: end_d_m, end_l_m, cost (N), terms (N, 12) in the "
                   "order of `default_weights()`, and rejection (N): \"none\", \"off road\", … .")
      .def_prop_ro(
          "reason", [](const PlanOf& of) { return of.plan.reason; },
          "Counts by cause, where nothing is feasible; else empty.")
      .def("__repr__",
           [](const PlanOf& of) {
             if (!of.plan.chosen) return fmt::format("<Plan: none, {}>", of.plan.reason);
             return fmt::format("<Plan: ends {:+.1f} m beside the line after {:.1f} m>",
                                of.plan.chosen->end_d_m, of.plan.chosen->end_l_m);
           })
      .def("_repr_svg_", &plan_picture);
}

}  // namespace

void bind_plans(nb::module_& module) {
  bind_plan(module);
  module.def(
      "default_weights", [] { return by_term(planning::default_weights()); },
      nb::sig("def default_weights() -> dict[str, float]"),
      "The weight of each term of a candidate's cost.");
  auto line = nb::borrow<nb::class_<LineOfMap>>(module.attr("ReferenceLine"));
  line.def(
      "plan",
      [](const LineOfMap& of, nb::handle pose, double speed_mps, nb::handle target_mps,
         nb::handle obstacles, nb::handle occupancy, nb::handle vehicle, nb::handle weights,
         nb::handle previous, double acceleration_mps2, double steering_rad, double t_s,
         const nb::kwargs& options) {
        return plan(of, {pose, target_mps, obstacles, occupancy, vehicle, weights, previous,
                         speed_mps, acceleration_mps2, steering_rad, t_s, options});
      },
      nb::arg("pose"), nb::arg("speed_mps"), nb::arg("target_mps") = nb::none(), nb::kw_only(),
      nb::arg("obstacles") = nb::none(), nb::arg("occupancy") = nb::none(),
      nb::arg("vehicle") = nb::none(), nb::arg("weights") = nb::none(),
      nb::arg("previous") = nb::none(), nb::arg("acceleration_mps2") = 0.0,
      nb::arg("steering_rad") = 0.0, nb::arg("t_s") = 0.0, nb::arg("options"),
      nb::sig("def plan(self, pose: numpy.typing.ArrayLike, speed_mps: float, target_mps: float | "
              "None = None, *, obstacles: str | os.PathLike[str] | "
              "collections.abc.Iterable[Obstacle] | None = None, occupancy: Occupancy | None = "
              "None, vehicle: Vehicle | str | os.PathLike[str] | None = None, weights: "
              "collections.abc.Mapping[str, float] | None = None, previous: Plan | None = None, "
              "acceleration_mps2: float = 0.0, steering_rad: float = 0.0, t_s: float = 0.0, "
              "d_step_m: float = 0.1, l_step_m: float = 0.2, min_d_m: float = -3.5, max_d_m: float "
              "= 3.5, min_l_m: float = 15.0, max_l_m: float = 30.0, points: int = 31, circles: int "
              "= 3, clearance_m: float = 0.3, max_lateral_acceleration_mps2: float = 4.0, "
              "border_margin_m: float = 0.0, recovery_m: float = 10.0, horizon_s: float = 5.0, "
              "completion_horizon_s: float = 10.0, completion_deceleration_mps2: float = 3.0, "
              "limit_steering_rate: bool = True, keep_candidates: bool = True) -> Plan"),
      "One planning cycle along the line: of all candidates d(l) with ends on a grid beside and "
      "along it, the cheapest that can be driven and collides with nothing.\n\n"
      "pose: x, y, heading of the rear axle; target_mps: the speed that is planned for, by default "
      "the line's limit; weights: of terms of the cost, in place of their defaults; previous: the "
      "plan of the cycle before, which the cost's consistency is about; t_s: the time that "
      "obstacles' motions are told in. The grid, in steps of d_step_m and l_step_m, holds 5,396 "
      "candidates as it stands; keep_candidates: judge every one, which takes longer.");
}

}  // namespace roadbed::tools::python
