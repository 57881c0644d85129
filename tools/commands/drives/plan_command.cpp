#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <filesystem>

#include "roadbed/map/files/json_text.h"
#include "roadbed/map/storage/output_folder.h"
#include "roadbed/planning/plan.h"
#include "roadbed/tools/commands/drives/commands.h"
#include "roadbed/tools/commands/drives/plan_output.h"
#include "roadbed/tools/files/json.h"
#include "roadbed/tools/report/drive_replay.h"
#include "roadbed/tools/simulation/cycle_log.h"
#include "roadbed/tools/simulation/scenario.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline commands::inline drives {
namespace {

using planning::Plan;

planning::PlanOptions options_of(const Scenario& scenario) {
  planning::PlanOptions options;
  options.clearance_m = scenario.options.clearance_m;
  options.keep_candidates = true;
  options.weights = scenario.options.weights;
  return options;
}

// The cycle at t = 0: the vehicle where the scenario puts it, at its speed, wheels straight.
planning::PlanInput input_of(const Scenario& scenario, const World& world) {
  const planning::LateralState start = lateral_state(world.line, world.start, 0.0, 0.0);
  const double limit_mps = world.line.corridor_at(start.s_m).speed_limit_mps;
  return {.line = world.line,
          .start = start,
          .speed = {.speed_mps = scenario.start_speed_mps,
                    .acceleration_mps2 = 0.0,
                    .target_mps = std::min(limit_mps, scenario.options.desired_speed_mps)},
          .obstacles = world.obstacles,
          .static_field = world.field.get(),
          .origin_in_source = world.road_map.origin_in_source()};
}

void print_circles(std::ostream& out, const geometry::VehicleShape& vehicle, int count) {
  const geometry::CoveringCircles circles = geometry::covering_circles(vehicle, count);
  fmt::print(out, "{} circles of {:.3f} m cover the vehicle; they stick out by {:.3f} m\n", count,
             circles.radius_m, circles.radius_m - 0.5 * vehicle.width_m);
}

class PlanCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description(
        "Run one planning cycle: every candidate, its cost, and why it was rejected");
    arguments
        .add(
            "SCENE", scene_,
            "Scenario (.json): the cycle at t = 0 is planned. Or DIR@T: the cycle at T seconds of "
            "the drive that simulate wrote to DIR is done again, byte for byte, as the drive up to "
            "there is")
        .required()
        .reads([](const std::filesystem::path& scene) {
          return names_drive_time(scene.string()) ? std::vector<std::filesystem::path>()
                                                  : files_named_by_scenario(scene);
        });
    arguments.add("-o,--output", folder_, "Folder for candidates.csv, trajectory.csv and plan.svg")
        .required()
        .writes("/");
    const Argument options = arguments.add(
        "--options", options_file_,
        "How to drive (.json): a style (gentle, normal, sporty), limits, and weights of the "
        "cost, in place of the scenario's; not with DIR@T");
    const Argument circles =
        arguments
            .add("--circles", circles_,
                 "Circles that cover the vehicle, for the first look; not with DIR@T")
            .within(1, 20)
            .with_default();
    arguments.flag("--explain", explain_,
                   "Each term's share of the cost, for the chosen candidate and the runner-up");
    arguments.flag("-j,--json", json_, "One JSON document on stdout");
    arguments.flag("-f,--force", force_, "Replace files in the folder");
    arguments.require([this, options, circles] {
      const bool has_changes = options.given() || circles.given();
      return has_changes && names_drive_time(scene_)
                 ? "--options and --circles do not go with DIR@T, which is done again as it was"
                 : "";
    });
    arguments.says_no_if("every candidate was rejected");
    arguments.example(
        "  roadbed plan data/scenarios/parked_car.json -o plan --explain\n"
        "  roadbed plan drive@4.2 -o cycle");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    const bool is_replay = names_drive_time(scene_);
    map::OutputFolder folder(
        folder_, {.force = force_,
                  .is_dropped = [](const std::string& name) { return name == "trajectory.csv"; },
                  .inputs = common.input_files});
    if (!is_replay) return plan_scenario(streams, folder);
    bool is_found = false;
    const DriveTime drive = parse_drive_time(scene_);
    refuse_own_drive(drive.folder);
    replay_cycle(drive, *common.inputs, [&](const ReplayedCycle& replayed) {
      show(streams.out, replayed, folder);
      is_found = replayed.explained.plan.chosen.has_value();
    });
    return is_found ? Exit::ok : Exit::no;
  }

 private:
  // Its trajectory would be replaced by that of one cycle.
  void refuse_own_drive(const std::filesystem::path& drive) const {
    std::error_code error;
    if (!std::filesystem::equivalent(drive, folder_, error)) return;
    map::refuse_output(folder_, "is the drive that the cycle is of", "choose another folder");
  }

  Exit plan_scenario(const Streams& streams, map::OutputFolder& folder) const {
    Scenario scenario = read_scenario(scene_);
    if (!options_file_.empty()) read_planner_options(options_file_).apply_to(scenario.options);
    planning::PlanOptions options = options_of(scenario);
    options.circles = circles_;
    const World world = make_world(scenario);
    const planning::PlanInput input = input_of(scenario, world);
    const Plan plan = planning::plan_path(input, scenario.vehicle, options);
    const PlannedCycle cycle{.world = world,
                             .vehicle = scenario.vehicle,
                             .input = input,
                             .plan = plan,
                             .weights = options.weights,
                             .title = scenario.name};
    write_plan(cycle, folder);
    if (json_) {
      fmt::print(streams.out, "{}\n", map::json_text(versioned("plan", plan_json(plan)), 2));
    } else {
      print_plan(streams.out, cycle, explain_);
      if (explain_) print_circles(streams.out, scenario.vehicle, circles_);
    }
    return plan.chosen ? Exit::ok : Exit::no;
  }

  void show(std::ostream& out, const ReplayedCycle& replayed, map::OutputFolder& folder) const {
    const auto& [scenario, world, decided, row, explained] = replayed;
    const PlannedCycle cycle{.world = world,
                             .vehicle = scenario.vehicle,
                             .input = explained.input,
                             .plan = explained.plan,
                             .weights = scenario.options.weights,
                             .title = fmt::format("{}, {:.2f} s", scenario.name, decided.t_s)};
    write_plan(cycle, folder);
    if (json_) {
      Json document = {{"cycle", cycle_json(decided, row)}};
      document.update(plan_json(cycle.plan));
      out << map::json_text(versioned("plan", document), 2) << '\n';
    } else {
      print_decision(out, replayed);
      print_plan(out, cycle, explain_);
    }
  }

  std::string scene_, folder_, options_file_;
  int circles_ = planning::PlanOptions{}.circles;
  bool json_ = false, force_ = false, explain_ = false;
};

}  // namespace

std::unique_ptr<Command> make_plan_command() { return std::make_unique<PlanCommand>(); }

}  // namespace roadbed::tools::commands::drives
