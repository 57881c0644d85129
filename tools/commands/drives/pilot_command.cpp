#include <fmt/format.h>
#include <fmt/ostream.h>

#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "roadbed/planning/pilot/pilot.h"
#include "roadbed/tools/cli/place.h"
#include "roadbed/tools/commands/drives/commands.h"
#include "roadbed/tools/files/vehicle_file.h"
#include "roadbed/tools/simulation/pilot_lines.h"
#include "roadbed/tools/simulation/planner_options.h"

namespace roadbed::tools::inline commands::inline drives {
namespace {

class PilotCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description(
        "Plan for a simulator or a vehicle: for each line of JSON on standard input (time, ego, "
        "objects, lights) one on standard output (trajectory, command, behaviour, reasons)");
    arguments.add("MAP", map_file_, "Any readable map").required().reads().ending(kMapEndings);
    arguments.add("--goal", goal_, std::string("Where to stop: ") + kPlaceSyntax)
        .required()
        .checked(place_syntax_fault);
    arguments.add("--vehicle", vehicle_file_, std::string("Vehicle: ") + kVehicleSyntax)
        .reads()
        .ending(".json .yaml");
    arguments
        .add("--options", planner_file_,
             "How to drive (.json): a style (gentle, normal, sporty), limits, and weights of the "
             "cost")
        .reads()
        .ending(".json");
    arguments
        .add("--occupancy", occupancy_files_, "Octree or clouds of what is to be kept clear of")
        .reads()
        .ending(kCloudEndings);
    arguments
        .add("--position-noise", tracker_.noise.position_m,
             "Standard deviation of objects' measured coordinates [m]")
        .within(0.0, 10.0)
        .with_default();
    arguments
        .add("--speed-noise", tracker_.noise.speed_mps,
             "Standard deviation of objects' measured speeds [m/s]")
        .within(0.0, 10.0)
        .with_default();
    arguments
        .add("--sight", sight_m_,
             "How far objects are measured [m], where no other one hides them: somebody may come "
             "from where nothing is seen; left out: all are measured")
        .within(1.0, 10000.0);
    arguments.flag(
        "--tracks", tells_objects_,
        "Tell in each answer what is believed of the objects, too, and what they may do");
    arguments.says_no_if("a line could not be used");
    arguments.example(
        "  roadbed simulate data/scenarios/pass_car.json -o drive "
        "--planner 'roadbed pilot data/town.xodr --goal lane:6/0/-1@100'\n"
        "  roadbed pilot data/town.xodr --goal lane:6/0/-1@100 < data/seen.jsonl");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    planning::PilotSetup setup{.road_map = common.inputs->road_map(map_file_), .goal = {}};
    const map::RoadMap& road_map = *setup.road_map;
    setup.goal = find_place(road_map, goal_).for_route();
    if (!vehicle_file_.empty()) setup.vehicle = read_vehicle_shape(vehicle_file_);
    if (!planner_file_.empty()) read_planner_options(planner_file_).apply_to(setup.driving);
    if (!occupancy_files_.empty()) {
      setup.occupied = common.inputs->field_of(occupancy_files_, setup.vehicle.height_m);
    }
    setup.tracker = tracker_;
    if (sight_m_ > 0.0) setup.sight_m = sight_m_;
    planning::Pilot pilot(setup);
    const std::size_t refused =
        answer_lines(pilot, road_map, std::cin, streams.out, {.tells_objects = tells_objects_});
    if (refused == 0) return Exit::ok;
    fmt::print(streams.err, "roadbed: {} line{} could not be used\n", refused,
               refused == 1 ? "" : "s");
    return Exit::no;
  }

 private:
  std::filesystem::path map_file_, vehicle_file_, planner_file_;
  std::vector<std::filesystem::path> occupancy_files_;
  std::string goal_;
  planning::TrackerOptions tracker_;
  double sight_m_ = 0.0;  ///< 0: all are measured
  bool tells_objects_ = false;
};

}  // namespace

std::unique_ptr<Command> make_pilot_command() { return std::make_unique<PilotCommand>(); }

}  // namespace roadbed::tools::commands::drives
