#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/tools/audit/obstacle_finder.h"
#include "roadbed/tools/commands/occupancy/cloud_inputs.h"
#include "roadbed/tools/commands/occupancy/commands.h"
#include "roadbed/tools/commands/occupancy/object_arguments.h"
#include "roadbed/tools/files/json.h"
#include "roadbed/tools/files/obstacles_csv.h"

namespace roadbed::tools::inline commands::inline occupancy {
namespace {

class OccupancyObjectsCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description(
        "Find what stands above the ground in point clouds and follow it from cloud to cloud: "
        "boxes over time, with ids, for audit --obstacles and obstacles_file of scenarios");
    clouds_.declare(arguments, false);
    arguments
        .add(
            "-o,--output", output_,
            "Boxes over time (.csv: t_s,id,x_m,y_m,heading_rad,length_m,width_m, poses of the "
            "centre). What does not move has one row and stands for ever; what moves is there from "
            "when it was first seen to the next cloud after the last")
        .required()
        .writes(".csv");
    arguments
        .add(
            "--period", period_s_,
            "Time from one cloud to the next [s], where they do not say theirs as messages of logs "
            "and sweeps of Argoverse 2 do, whose times are since the first pose of their drive")
        .within(1e-3, 1e3)
        .with_default();
    arguments.heading("Objects");
    objects_.declare(arguments);
    arguments.heading("Clouds");
    clouds_.declare_sensor(arguments);
    clouds_.declare_changes(arguments);
    arguments.says_no_if("nothing stands above the ground; then no file is written");
    arguments.flag("-j,--json", json_, "Print one JSON document");
    arguments.flag("-f,--force", force_, "Replace the output if it exists");
    arguments.example(
        "  roadbed occupancy objects scan_1.pcd scan_2.pcd -o obstacles.csv\n"
        "  roadbed occupancy objects scans/*.pcd --range 2,40 --threads 2 -o near.csv\n"
        "  roadbed occupancy objects scans/*.pcd --period 0.5 --longest 20 -o street.csv");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    map::check_writable(output_, force_);
    const auto note = [&](const std::string& name, const std::string& text) {
      if (!common.quiet) fmt::print(streams.err, "note: {}: {}\n", name, text);
    };
    ObstacleFinder finder(objects_.options(),
                          CloudClock([&] { return drive_start_ns(note); }, period_s_),
                          common.threads);
    clouds_.for_each([&](map::PointCloud cloud) { finder.take(std::move(cloud)); }, note);
    const std::vector<planning::ObstacleInSource> obstacles = finder.obstacles();
    if (!obstacles.empty()) map::write_output(output_, write_obstacles_csv(obstacles), force_);
    print(streams.out, finder, obstacles);
    return obstacles.empty() ? Exit::no : Exit::ok;
  }

 private:
  std::optional<std::int64_t> drive_start_ns(const CloudInputs::Note& note) const {
    try {
      return clouds_.drive_start_ns();
    } catch (const map::InputError& unknown) {
      note(clouds_.first_name(), std::string("times are since the first cloud, as its drive is not "
                                             "known: ") +
                                     unknown.what());
      return std::nullopt;
    }
  }

  void print(std::ostream& out, const ObstacleFinder& finder,
             const std::vector<planning::ObstacleInSource>& obstacles) const {
    const auto standing = std::ranges::count_if(obstacles, &planning::ObstacleInSource::is_static);
    if (json_) {
      const Json document{{"clouds", finder.clouds()},
                          {"points", finder.points()},
                          {"objects", obstacles.size()},
                          {"standing", standing}};
      out << map::json_text(versioned("objects", document), 2) << '\n';
    } else {
      fmt::print(out, "{} objects in {} clouds of {} points: {} stand, {} move or were seen once\n",
                 obstacles.size(), finder.clouds(), finder.points(), standing,
                 obstacles.size() - static_cast<std::size_t>(standing));
    }
  }

  CloudInputs clouds_;
  ObjectArguments objects_;
  std::filesystem::path output_;
  double period_s_ = 0.1;
  bool json_ = false, force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_occupancy_objects_command() {
  return std::make_unique<OccupancyObjectsCommand>();
}

}  // namespace roadbed::tools::commands::occupancy
