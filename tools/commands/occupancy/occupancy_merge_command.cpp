#include <filesystem>
#include <string>
#include <vector>

#include "roadbed/map/occupancy/octree/occupancy_merge.h"
#include "roadbed/tools/commands/occupancy/commands.h"
#include "roadbed/tools/commands/occupancy/occupancy_output.h"

namespace roadbed::tools::inline commands::inline occupancy {
namespace {

class OccupancyMergeCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description(
        "Put octrees together cell by cell: occupied where one of them says so, else free where "
        "one does. They need cells of one size in one grid and coordinate system");
    arguments.add("FILES", files_, "Octrees (.bt .ot), or folders of tiles")
        .required()
        .reads()
        .ending(kOctreeEndings);
    output_.declare(arguments);
    arguments.flag("--no-sticky", no_sticky_,
                   "Add up the log-odds of all instead, within OctoMap's limits, so that what is "
                   "free in many is free: of a .bt these are 3.5 and -2, of an .ot its own");
    arguments.require([this] { return output_.fault(); });
    arguments.says_no_if("nothing was measured in any of them");
    arguments.example(
        "  roadbed occupancy merge north.bt south.bt -o both.bt\n"
        "  roadbed occupancy merge monday.ot tuesday.ot --no-sticky -o both.ot\n"
        "  roadbed occupancy merge city.tiles street.bt -o new.tiles");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    output_.check();
    const OccupancyInputs inputs(files_);
    const map::OccupancyMerge merge(inputs.sources(), {.sticky_hits = !no_sticky_});
    return output_.write(merge, inputs, streams, common);
  }

 private:
  std::vector<std::filesystem::path> files_;
  OccupancyOutput output_;
  bool no_sticky_ = false;
};

}  // namespace

std::unique_ptr<Command> make_occupancy_merge_command() {
  return std::make_unique<OccupancyMergeCommand>();
}

}  // namespace roadbed::tools::commands::occupancy
