#include <fmt/format.h>
#include <fmt/ostream.h>

#include <filesystem>
#include <string>
#include <vector>

#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/map/occupancy/octree/occupancy_merge.h"
#include "roadbed/map/occupancy/octree/tiled_occupancy.h"
#include "roadbed/map/occupancy/outputs/cell_centres.h"
#include "roadbed/map/occupancy/outputs/occupancy_changes.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/tools/commands/occupancy/commands.h"
#include "roadbed/tools/commands/occupancy/occupancy_output.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline commands::inline occupancy {
namespace {

class OccupancyDiffCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Say what appeared between two octrees of one place, and what vanished");
    arguments.add("A", before_, "Octree (.bt .ot) of before, or folder of tiles")
        .required()
        .reads()
        .ending(kOctreeEndings);
    arguments.add("B", now_, "The same of now").required().reads().ending(kOctreeEndings);
    arguments
        .add("--appeared", appeared_, "Cells occupied in B and not in A, as points (.pcd .ply)")
        .writes(".pcd");
    arguments
        .add("--vanished", vanished_, "Cells occupied in A and free in B, as points (.pcd .ply)")
        .writes(".pcd");
    arguments.require([this]() -> std::string {
      for (const std::filesystem::path& output : {appeared_, vanished_}) {
        const std::string suffix = output.extension().string();
        if (output.empty() || suffix == ".pcd" || suffix == ".ply") continue;
        return output.string() + " ends in neither .pcd nor .ply";
      }
      return {};
    });
    arguments.flag("-f,--force", force_, "Replace outputs that exist");
    arguments.flag("-j,--json", json_, "Print one JSON document");
    arguments.says_no_if("something appeared or vanished");
    arguments.example(
        "  roadbed occupancy diff town.bt street.bt --appeared new.pcd\n"
        "  roadbed occupancy diff city.tiles town.bt");
  }

  Exit run(const Streams& streams, const CommonOptions&) override {
    for (const std::filesystem::path& output : {appeared_, vanished_}) {
      if (!output.empty()) map::check_writable(output, force_);
    }
    const map::OccupancyMap before = octree_in(before_), now = octree_in(now_);
    const map::OccupancyChanges changes =
        map::changes_between(before, map::input_name(before_), now, map::input_name(now_));
    map::OutputFiles files(force_);
    if (!appeared_.empty()) files.add(appeared_, points_in(appeared_, changes.appeared));
    if (!vanished_.empty()) files.add(vanished_, points_in(vanished_, changes.vanished));
    files.commit();
    if (json_) {
      const Json document = {{"resolution_m", now.resolution_m()},
                             {"appeared_cells", changes.appeared.size()},
                             {"vanished_cells", changes.vanished.size()},
                             {"not_seen_again_cells", changes.not_seen_again},
                             {"stayed_cells", changes.stayed}};
      streams.out << map::json_text(versioned("occupancy_diff", document), 2) << '\n';
    } else {
      fmt::print(streams.out,
                 "appeared       {} cells of {} m\nvanished       {} cells\n"
                 "not seen again {} cells\nstayed         {} cells\n",
                 changes.appeared.size(), now.resolution_m(), changes.vanished.size(),
                 changes.not_seen_again, changes.stayed);
    }
    return changes.any() ? Exit::no : Exit::ok;
  }

 private:
  /// Of tiles all that they hold, as one.
  static map::OccupancyMap octree_in(const std::filesystem::path& path) {
    if (!map::is_tiled_occupancy(path)) return map::OccupancyMap::load(path);
    const OccupancyInputs tiles({path});
    return map::OccupancyMap::parse(map::OccupancyMerge(tiles.sources()).bt().bytes,
                                    map::input_name(path));
  }

  static std::string points_in(const std::filesystem::path& output,
                               const std::vector<Eigen::Vector3d>& points) {
    return output.extension() == ".pcd" ? map::points_as_pcd(points) : map::points_as_ply(points);
  }

  std::filesystem::path before_, now_, appeared_, vanished_;
  bool force_ = false, json_ = false;
};

}  // namespace

std::unique_ptr<Command> make_occupancy_diff_command() {
  return std::make_unique<OccupancyDiffCommand>();
}

}  // namespace roadbed::tools::commands::occupancy
