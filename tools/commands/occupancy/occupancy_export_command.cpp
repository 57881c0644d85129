#include <fmt/format.h>
#include <fmt/ostream.h>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roadbed/map/files/projection.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/gis/geo_tiff.h"
#include "roadbed/map/gis/layers.h"
#include "roadbed/map/gis/write.h"
#include "roadbed/map/occupancy/clouds/read_point_cloud.h"
#include "roadbed/map/occupancy/objects/normals.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/map/occupancy/octree/tiled_occupancy.h"
#include "roadbed/map/occupancy/outputs/cell_boxes.h"
#include "roadbed/map/occupancy/outputs/cell_centres.h"
#include "roadbed/map/occupancy/outputs/grid_raster.h"
#include "roadbed/map/occupancy/outputs/occupancy_grid.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/tools/commands/occupancy/cloud_inputs.h"
#include "roadbed/tools/commands/occupancy/commands.h"

namespace roadbed::tools::inline commands::inline occupancy {
namespace {

class OccupancyExportCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description(
        "Write occupied cells as points or rectangles, or an octree seen from above as a 2D map");
    arguments
        .add("F", input_,
             "Octree (.bt .ot), or folder of tiles; for points a cloud, too (.pcd .ply .las .laz "
             ".xyz .bin .feather)")
        .required()
        .reads()
        .ending(kCloudInputEndings);
    arguments
        .add(
            "-o,--output", output_,
            "Points of a cloud, or in the middle of occupied cells (.pcd .ply), a map as nav2 "
            "reads it (.pgm, "
            "with the .yaml of the same name), bands of floats (.tif, GeoTIFF: occupied, "
            "lowest_m, highest_m, clearance_m), or rectangles of occupied cells with their heights "
            "(.geojson .gpkg .fgb; GeoJSON in longitude and latitude where the CRS is known)")
        .required()
        .writes(".pgm");
    arguments
        .add("--heights", heights_m_,
             "FROM,TO: which heights count [m], but for points, as the octree's coordinates have "
             "them (default: all)")
        .within(-1e5, 1e5)
        .values(2)
        .separated_by(',');
    arguments
        .add("--normals", neighbours_,
             "Write the normal of the surface at each point too, of the plane through so many "
             "points nearest to it (PCL), turned to the sensor of a cloud, else upwards")
        .within(3, 1000);
    arguments.require([this]() -> std::string {
      if (writer() == nullptr) {
        return "--output: " + output_.string() + " ends in none of " + suffixes();
      }
      if (!heights_m_.empty() && has_points()) return "--heights are not for points";
      if (neighbours_ > 0 && !has_points()) return "--normals are for points: .pcd .ply";
      if (!heights_m_.empty() && !(heights_m_[0] < heights_m_[1])) {
        return "--heights: the first has to be below the second";
      }
      return {};
    });
    arguments.flag("-f,--force", force_, "Replace outputs that exist");
    arguments.example(
        "  roadbed occupancy export street.bt -o street.pcd\n"
        "  roadbed occupancy export scan_1.pcd --normals 20 -o normals.ply\n"
        "  roadbed occupancy export street.bt --heights=0.3,2 -o street.pgm\n"
        "  roadbed occupancy export street.bt --heights=0.3,2 -o street.tif\n"
        "  roadbed occupancy export street.bt -o cells.geojson");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    const std::string said =
        has_points() ? write_points() : (this->*writer()->write)(*map::open_occupancy(input_));
    if (!common.quiet) fmt::print(streams.err, "{}: {}\n", output_.string(), said);
    return Exit::ok;
  }

 private:
  /// Writes the output, and says what it holds.
  using Write = std::string (OccupancyExportCommand::*)(const map::OccupancySource&) const;
  struct Writer {
    const char* suffix;
    Write write;  ///< none: points, which need not be of an octree
  };

  static std::span<const Writer> writers() {
    static constexpr std::array<Writer, 7> all{{
        {".pcd", nullptr},
        {".ply", nullptr},
        {".pgm", &OccupancyExportCommand::write_grid},
        {".tif", &OccupancyExportCommand::write_raster},
        {".geojson", &OccupancyExportCommand::write_boxes},
        {".gpkg", &OccupancyExportCommand::write_boxes},
        {".fgb", &OccupancyExportCommand::write_boxes},
    }};
    return all;
  }

  std::string suffix() const { return output_.extension().string(); }
  bool has_points() const { return suffix() == ".pcd" || suffix() == ".ply"; }

  const Writer* writer() const {
    for (const Writer& writer : writers()) {
      if (suffix() == writer.suffix) return &writer;
    }
    return nullptr;
  }

  static std::string suffixes() {
    std::string all;
    for (const Writer& writer : writers())
      all += (all.empty() ? "" : " ") + std::string(writer.suffix);
    return all;
  }

  map::GridHeights heights() const {
    if (heights_m_.empty()) return {};
    return {heights_m_[0], heights_m_[1]};
  }

  /// The points of a cloud, or the middles of occupied cells; as a cloud, too.
  struct Points {
    std::vector<Eigen::Vector3d> in_source;
    map::PointCloud cloud;
  };

  Points points_of_input() const {
    Points points;
    if (!map::is_folder(input_)) {
      const std::string bytes = map::read_file(input_, map::most_unpacked_of_rows);
      if (!map::is_occupancy_file(bytes)) {
        points.cloud = map::point_cloud_of(input_, bytes);
        for (std::size_t i = 0; i < points.cloud.points.size(); ++i) {
          points.in_source.push_back(points.cloud.in_source(i));
        }
        return points;
      }
    }
    const std::unique_ptr<map::OccupancySource> occupancy = map::open_occupancy(input_);
    points.cloud.name = map::input_name(input_);
    points.cloud.origin_in_source = occupancy->origin_in_source();
    points.in_source = map::occupied_centres(*occupancy, points.cloud.name);
    for (const Eigen::Vector3d& centre : points.in_source) {
      points.cloud.points.push_back((centre - points.cloud.origin_in_source).cast<float>());
    }
    return points;
  }

  std::string write_points() const {
    map::OutputFile file(output_, force_);
    const Points read = points_of_input();
    const std::vector<Eigen::Vector3d>& points = read.in_source;
    std::vector<Eigen::Vector3f> normals;
    if (neighbours_ > 0 && !points.empty()) normals = map::normals(read.cloud, neighbours_);
    file.write(0, suffix() == ".pcd" ? map::points_as_pcd(points, normals)
                                     : map::points_as_ply(points, normals));
    file.commit();
    return fmt::format("{} points{}, as {}", points.size(), normals.empty() ? "" : " with normals",
                       map::fit_in_floats(points)
                           ? "floats"
                           : "doubles, since they are far from 0; PCL's own reader takes no such");
  }

  std::string write_grid(const map::OccupancySource& occupancy) const {
    std::filesystem::path yaml = output_;
    yaml.replace_extension(".yaml");
    for (const auto& file : {output_, yaml}) map::check_writable(file, force_);
    const map::OccupancyGrid grid =
        map::grid_from_above(occupancy, heights(), map::input_name(input_));
    map::OutputFiles files(force_);
    files.add(output_, map::grid_as_pgm(grid));
    files.add(yaml, map::grid_yaml(grid, output_.filename().string()));
    files.commit();
    return fmt::format("{} by {} squares of {} m; and {}", grid.columns, grid.rows,
                       grid.resolution_m, yaml.filename().string());
  }

  std::string write_raster(const map::OccupancySource& occupancy) const {
    map::check_writable(output_, force_);
    const map::Raster raster =
        map::raster_from_above(occupancy, heights(), map::input_name(input_));
    const std::string& crs = occupancy.crs();
    const std::optional<int> epsg = crs.empty() ? std::nullopt : map::epsg_code(crs);
    map::write_output(output_, map::write_geotiff(raster, epsg), force_);
    return fmt::format("{} by {} squares of {} m, {} bands{}", raster.columns, raster.rows,
                       raster.cell_m, raster.bands.size(),
                       crs.empty() || epsg ? "" : "; no system, as it has no EPSG code: " + crs);
  }

  std::string write_boxes(const map::OccupancySource& occupancy) const {
    map::check_writable(output_, force_);
    const std::vector<map::CellBox> boxes =
        map::occupied_boxes(occupancy, heights(), map::input_name(input_));
    std::vector<map::Layer> layers{map::layer_of_boxes(occupancy, boxes)};
    map::write_output(output_, layer_file(layers, occupancy.crs()), force_);
    return fmt::format("{} rectangles", boxes.size());
  }

  std::string layer_file(std::vector<map::Layer>& layers, const std::string& crs) const {
    if (suffix() == ".gpkg") return map::write_geopackage(layers, crs);
    if (suffix() == ".fgb") return map::write_flatgeobuf(layers.front(), crs);
    if (!crs.empty()) map::to_lon_lat(crs, layers);
    return map::write_geojson(
        layers, {.lon_lat = !crs.empty(), .source_format = "OctoMap", .source_crs = crs});
  }

  std::filesystem::path input_, output_;
  std::vector<double> heights_m_;
  int neighbours_ = 0;  // of each normal; 0: none are asked for
  bool force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_occupancy_export_command() {
  return std::make_unique<OccupancyExportCommand>();
}

}  // namespace roadbed::tools::commands::occupancy
