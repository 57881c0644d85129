#include "roadbed/map/edit/clipping/clip.h"

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "roadbed/map/files/read_file.h"
#include "roadbed/tools/commands/maps/commands.h"
#include "roadbed/tools/commands/maps/edit_output.h"
#include "roadbed/tools/commands/maps/region_option.h"

namespace roadbed::tools::inline commands::inline maps {
namespace {

class ClipCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Cut a map to a part of the plane, in its own format");
    arguments.add("MAP", input_, "An OpenDRIVE, Lanelet2 or CommonRoad file")
        .required()
        .reads()
        .ending(kMapEndings);
    region_.declare(arguments);
    arguments.flag("--whole", options_.whole,
                   "Keep roads and lanelets that the part touches whole, in place of cutting them");
    output_.declare(arguments);
    arguments.require([this] {
      const std::string fault = region_.fault();
      return fault.empty() ? output_.fault() : fault;
    });
    arguments.says_no_if("nothing of the map is inside");
    arguments.example(
        "  roadbed map clip town.xodr --bbox=0,0,200,300 -o part.xodr\n"
        "  roadbed map clip town.xodr --within lane:1/0/-1,150m --whole -o near.xodr");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    output_.check();
    const std::string name = map::input_name(input_);
    std::string bytes = map::read_file(input_);
    const map::Region region = region_.region(bytes, name);
    return output_.finish(map::clip(std::move(bytes), name, region, options_), "map_clip", streams,
                          common);
  }

 private:
  std::filesystem::path input_;
  RegionOption region_;
  map::ClipOptions options_;
  EditOutput output_;
};

}  // namespace

std::unique_ptr<Command> make_map_clip_command() { return std::make_unique<ClipCommand>(); }

}  // namespace roadbed::tools::commands::maps
