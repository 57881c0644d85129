#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "roadbed/map/edit/clipping/region_part.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/occupancy/octree/occupancy_merge.h"
#include "roadbed/tools/commands/maps/region_option.h"
#include "roadbed/tools/commands/occupancy/commands.h"
#include "roadbed/tools/commands/occupancy/occupancy_output.h"

namespace roadbed::tools::inline commands::inline occupancy {
namespace {

/// @param rounding_m  how far middles on an edge may be beside it.
map::Stays stays_in(map::RegionDescent& region, const Eigen::Vector2d& middle, double radius_m,
                    double rounding_m) {
  switch (region.side_of_disc(middle, radius_m + rounding_m)) {
    case map::Region::Side::inside:
      return map::Stays::all;
    case map::Region::Side::outside:
      return map::Stays::nothing;
    case map::Region::Side::border:
      break;
  }
  return radius_m == 0.0 ? map::Stays::all : map::Stays::part;
}

class OccupancyCropCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description(
        "Cut an octree to a part of space: cells stay whose middle lies in it, on its edge "
        "included");
    arguments.add("F", input_, "Octree (.bt .ot), or folder of tiles")
        .required()
        .reads()
        .ending(kOctreeEndings);
    region_.declare(arguments, "octree");
    arguments
        .add("--map", map_file_,
             "The map whose lane or route --within names, in the octree's coordinates (.xodr .osm "
             ".rbm)")
        .reads()
        .ending(kMapEndings);
    arguments
        .add("--heights", heights_m_,
             "FROM,TO: which heights stay [m], as the octree's coordinates have them")
        .within(-1e5, 1e5)
        .values(2)
        .separated_by(',');
    output_.declare(arguments);
    arguments.require([this] {
      const std::string fault = fault_of_part();
      return fault.empty() ? output_.fault() : fault;
    });
    arguments.says_no_if("nothing was measured in the part");
    arguments.example(
        "  roadbed occupancy crop town.bt --bbox=0,0,200,300 -o part.bt\n"
        "  roadbed occupancy crop city.tiles --polygon yard.geojson --heights=-1,3 -o yard.bt\n"
        "  roadbed occupancy crop town.bt --map town.xodr --within lane:1/0/-1,50m -o near.bt\n"
        "  roadbed occupancy crop town.bt --map town.xodr --within route:route.json,30m -o "
        "along.bt");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    output_.check();
    const OccupancyInputs inputs({input_});
    const map::OccupancyMerge merge(inputs.sources(), {.part = part(inputs.front())});
    return output_.write(merge, inputs, streams, common);
  }

 private:
  std::string fault_of_part() const {
    if (!region_.given() && heights_m_.empty()) {
      return "one of --bbox, --polygon and --within, or --heights, is required";
    }
    if (!heights_m_.empty() && !(heights_m_[0] < heights_m_[1])) {
      return "--heights: the first has to be below the second";
    }
    if (region_.needs_map() != !map_file_.empty()) return "--within and --map need each other";
    return region_.given() ? region_.fault() : "";
  }

  map::OccupancyPart part(const map::OccupancySource& occupancy) const {
    map::OccupancyPart part;
    if (!heights_m_.empty()) {
      part.box.min_in_source.z() = heights_m_[0];
      part.box.max_in_source.z() = heights_m_[1];
    }
    if (!region_.given()) return part;
    const auto region = std::make_shared<const map::Region>(region_of(occupancy));
    part.box.min_in_source.head<2>() = region->bounds().min();
    part.box.max_in_source.head<2>() = region->bounds().max();
    const double rounding_m = 1e-6 * occupancy.resolution_m();
    // Asked by one thread, from a cube to those in it; it refers to the region.
    const auto descent = std::make_shared<map::RegionDescent>(*region);
    part.in_plan = [region, descent, rounding_m](const Eigen::Vector2d& middle, double radius_m) {
      return stays_in(*descent, middle, radius_m, rounding_m);
    };
    return part;
  }

  map::Region region_of(const map::OccupancySource& occupancy) const {
    if (map_file_.empty()) return region_.region_in(occupancy.crs(), map::input_name(input_));
    return region_.region(map::read_file(map_file_), map::input_name(map_file_));
  }

  std::filesystem::path input_, map_file_;
  RegionOption region_;
  std::vector<double> heights_m_;
  OccupancyOutput output_;
};

}  // namespace

std::unique_ptr<Command> make_occupancy_crop_command() {
  return std::make_unique<OccupancyCropCommand>();
}

}  // namespace roadbed::tools::commands::occupancy
