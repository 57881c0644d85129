#include <fmt/format.h>
#include <fmt/ostream.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/map/occupancy/octree/tiled_occupancy.h"
#include "roadbed/map/occupancy/outputs/cell_centres.h"
#include "roadbed/map/occupancy/outputs/occupancy_grid.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/tools/commands/commands.h"

namespace roadbed::tools::inline commands {
namespace {

class OccupancyExportCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description(
        "Write occupied cells as points, or an octree seen from above as a 2D map");
    arguments.add("F", input_, "Octree (.bt .ot), or folder of tiles")
        .required()
        .reads()
        .ending(kOctreeEndings);
    arguments
        .add("-o,--output", output_,
             "Points in the middle of occupied cells (.pcd .ply), or a map as nav2 reads it "
             "(.pgm, with the .yaml of the same name)")
        .required()
        .writes(".pgm");
    arguments
        .add("--heights", heights_m_,
             "FROM,TO: which heights count in a 2D map [m], as the octree's coordinates have them "
             "(default: all)")
        .within(-1e5, 1e5)
        .values(2)
        .separated_by(',');
    arguments.require([this]() -> std::string {
      if (suffix() != ".pgm" && suffix() != ".pcd" && suffix() != ".ply") {
        return "--output: " + output_.string() + " ends in none of .pgm, .pcd and .ply";
      }
      if (!heights_m_.empty() && suffix() != ".pgm") return "--heights are those of a .pgm";
      if (!heights_m_.empty() && !(heights_m_[0] < heights_m_[1])) {
        return "--heights: the first has to be below the second";
      }
      return {};
    });
    arguments.flag("-f,--force", force_, "Replace outputs that exist");
    arguments.example(
        "  roadbed occupancy export street.bt -o street.pcd\n"
        "  roadbed occupancy export street.bt --heights=0.3,2 -o street.pgm");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    const std::unique_ptr<map::OccupancySource> occupancy = load();
    const std::string said = suffix() == ".pgm" ? write_grid(*occupancy) : write_points(*occupancy);
    if (!common.quiet) fmt::print(streams.err, "{}: {}\n", output_.string(), said);
    return Exit::ok;
  }

 private:
  std::string suffix() const { return output_.extension().string(); }

  std::unique_ptr<map::OccupancySource> load() const {
    if (map::is_tiled_occupancy(input_)) return std::make_unique<map::TiledOccupancy>(input_);
    return std::make_unique<map::OccupancyMap>(map::OccupancyMap::load(input_));
  }

  std::string write_points(const map::OccupancySource& occupancy) const {
    map::OutputFile file(output_, force_);
    const std::vector<Eigen::Vector3d> points =
        map::occupied_centres(occupancy, map::input_name(input_));
    file.write(0, suffix() == ".pcd" ? map::points_as_pcd(points) : map::points_as_ply(points));
    file.commit();
    return fmt::format("{} points, as {}", points.size(),
                       map::fit_in_floats(points)
                           ? "floats"
                           : "doubles, since they are far from 0; PCL's own reader takes no such");
  }

  std::string write_grid(const map::OccupancySource& occupancy) const {
    std::filesystem::path yaml = output_;
    yaml.replace_extension(".yaml");
    map::OutputFile image_file(output_, force_), yaml_file(yaml, force_);
    map::GridHeights heights;
    if (!heights_m_.empty()) heights = {heights_m_[0], heights_m_[1]};
    const map::OccupancyGrid grid =
        map::grid_from_above(occupancy, heights, map::input_name(input_));
    image_file.write(0, map::grid_as_pgm(grid));
    yaml_file.write(0, map::grid_yaml(grid, output_.filename().string()));
    image_file.commit();
    yaml_file.commit();
    return fmt::format("{} by {} squares of {} m; and {}", grid.columns, grid.rows,
                       grid.resolution_m, yaml.filename().string());
  }

  std::filesystem::path input_, output_;
  std::vector<double> heights_m_;
  bool force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_occupancy_export_command() {
  return std::make_unique<OccupancyExportCommand>();
}

}  // namespace roadbed::tools::commands
