#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/occupancy/clouds/cloud_transforms.h"
#include "roadbed/map/occupancy/clouds/read_point_cloud.h"
#include "roadbed/map/occupancy/clouds/sensor_poses.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/map/occupancy/octree/tile_builder.h"
#include "roadbed/map/occupancy/octree/tiles_index.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/map/storage/output_folder.h"
#include "roadbed/tools/cli/output_format.h"
#include "roadbed/tools/commands/commands.h"

namespace roadbed::tools::inline commands {
namespace {

class OccupancyBuildCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description(
        "Make an OctoMap file from point clouds. A measured hit stays occupied whatever rays pass "
        "through its cell; space that no ray crossed stays unknown");
    arguments
        .add("CLOUD", clouds_,
             "Point clouds (.pcd .ply .las .laz .xyz .csv) in one frame, in metres; or one octree "
             "(.bt .ot) to convert")
        .required()
        .reads()
        .ending(kCloudEndings);
    arguments
        .add("-o,--output", output_,
             "OctoMap file to write (.bt, or .ot with log-odds), or a folder (.tiles); - for "
             "standard output")
        .required()
        .writes(".bt");
    declare_format(arguments, format_, {".bt", ".ot"});
    arguments.add("--resolution", resolution_m_, "Side of a cell [m]")
        .within(1e-3, 1e3)
        .with_default();
    arguments
        .add("--sensor", sensor_,
             "X,Y,Z of the sensor for all clouds: rays from it carve free space. Without it "
             "the position that a cloud has for each point counts (fields or columns sensor_x "
             "sensor_y sensor_z, vp_x…, x_origin… or BeamOriginX…), else the viewpoint of a .pcd")
        .separated_by(',')
        .values(3)
        .excludes(arguments
                      .add("--poses", poses_file_,
                           "Where the sensor was, a line for each cloud in their order (TUM: "
                           "timestamp tx ty tz qx "
                           "qy qz qw; KITTI: 3 by 4 matrix): the clouds are in the sensor's frame, "
                           "and so are positions that they have for each point")
                      .reads());
    arguments.flag("--no-carving", no_carving_,
                   "Only mark hits, whatever viewpoints the files name");
    arguments.add("--carve-range", carve_range_m_, "Rays carve this far from the sensor [m]")
        .positive();
    arguments
        .add("--remove-seen-through", remove_seen_through_,
             "Remove dynamic objects by ray tracing: a cell with points counts as free if at "
             "least this many clouds, and more clouds than have a point in it, have a ray across "
             "it and no point in it. The order of the clouds does not matter, so that what was "
             "there only at first or last goes as well. Thin objects, edges, and surfaces that "
             "rays graze go too, the sooner the smaller the number: audits over such a file "
             "say so")
        .within(1, 255)
        .excludes(
            arguments.flag("--no-sticky", no_sticky_,
                           "Let rays carve hits away again, as OctoMap's insertPointCloud does"));
    arguments.add("--voxel", filter_.voxel_m, "Thin each cloud to a point per cube [m] (PCL)")
        .within(1e-3, 1e3);
    arguments
        .add("--outlier-neighbours", filter_.outlier_neighbours,
             "Leave out points far from this many neighbours, as compared to the rest (PCL)")
        .within(1, 1000);
    arguments
        .add("--outlier-deviations", filter_.outlier_deviations,
             "Far is this many standard deviations over the mean distance")
        .positive()
        .with_default();
    arguments
        .add("--scale", scale_,
             "Multiplies the clouds' coordinates, where they are not metres (feet: 0.3048); "
             "--sensor "
             "and --poses are in metres")
        .within(1e-6, 1e6);
    arguments.add("--crs", crs_, "CRS of the clouds, where the files give none or a wrong one");
    arguments
        .add("--tiles", tiles_m_,
             "Write a folder of .bt tiles with sides so long [m] or little longer, and an index: "
             "for "
             "more than memory holds. Clouds are read one after the other, twice")
        .within(1.0, 1e5);
    arguments.require([this]() -> std::string {
      const std::string fault = standard_output_fault(output_, true, format_, "");
      if (!fault.empty()) return fault;
      if (suffix() != ".bt" && suffix() != ".ot" && suffix() != ".tiles") {
        return "--output: " + output_.string() + " ends in none of .bt, .ot and .tiles";
      }
      if ((output_.extension() == ".tiles") == tiles_m_.has_value()) return {};
      return tiles_m_ ? "--tiles needs an output that ends in .tiles"
                      : "an output .tiles needs --tiles";
    });
    arguments.flag("-f,--force", force_, "Replace the output if it exists");
    arguments.example(
        "  roadbed occupancy build scan_1.pcd scan_2.pcd -o street.bt\n"
        "  roadbed occupancy build scans/*.pcd --poses poses.txt -o mapped.bt\n"
        "  roadbed occupancy build scans/*.pcd --tiles 100 -o city.tiles");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    if (tiles_m_) return build_tiles(streams, common);
    map::check_writable(output_, force_);
    const Made made = make(streams.err, common.quiet);
    map::write_output(output_, made.file.bytes, force_);
    if (!common.quiet) {
      fmt::print(streams.err, "{}: {} nodes of {} m, {} bytes\n", output_name(output_),
                 made.file.nodes, made.resolution_m, made.file.bytes.size());
      print_removed(streams.err, made.file.seen_through);
    }
    return Exit::ok;
  }

 private:
  struct Made {
    map::OccupancyMap::File file;
    double resolution_m;
  };

  static void print_removed(std::ostream& err,
                            const std::optional<map::SeeThroughRemoval>& removed) {
    if (!removed) return;
    fmt::print(err, "{} cells with points count as free: {} clouds or more saw through them\n",
               removed->cells, removed->clouds);
  }

  std::string suffix() const { return suffix_of_output(output_, format_); }
  bool wants_log_odds() const { return suffix() == ".ot"; }

  Made written(const map::OccupancyMap& occupancy) const {
    return {{wants_log_odds() ? occupancy.to_ot() : occupancy.to_bt(), occupancy.node_count(),
             occupancy.seen_through()},
            occupancy.resolution_m()};
  }

  Made make(std::ostream& err, bool quiet) const {
    const std::vector<Eigen::Isometry3d> poses = poses_of_clouds();
    std::vector<map::PointCloud> clouds;
    for (std::size_t i = 0; i < clouds_.size(); ++i) {
      const std::string bytes = map::read_file(clouds_[i]);
      if (map::is_occupancy_file(bytes)) return written(convert(bytes, clouds_[i]));
      clouds.push_back(cloud_of(i, bytes, poses));
      if (!quiet) print_notes(err, clouds.back());
    }
    map::OccupancyOptions options{.resolution_m = resolution_m_,
                                  .sticky_hits = !no_sticky_,
                                  .remove_seen_through = remove_seen_through_};
    if (carve_range_m_) options.carve_range_m = *carve_range_m_;
    if (wants_log_odds()) return written(map::OccupancyMap::build(clouds, options));
    return {map::OccupancyMap::build_bt(clouds, options), resolution_m_};
  }

  // The cloud of a file, ready to be measured.
  map::PointCloud cloud_of(std::size_t i, std::string_view bytes,
                           const std::vector<Eigen::Isometry3d>& poses) const {
    map::PointCloud cloud = map::parse_point_cloud(bytes, map::input_name(clouds_[i]));
    if (scale_) cloud = map::scaled_to_metres(cloud, *scale_);
    if (!poses.empty()) cloud = map::placed(cloud, poses[i]);
    return prepared(std::move(cloud));
  }

  map::PointCloud cloud_to_tile(std::size_t i, const std::vector<Eigen::Isometry3d>& poses) const {
    const std::string bytes = map::read_file(clouds_[i]);
    if (!map::is_occupancy_file(bytes)) {
      map::PointCloud cloud = cloud_of(i, bytes, poses);
      if (no_sticky_ && !cloud.scans.empty()) refuse_log_odds(cloud);
      return cloud;
    }
    throw map::InputError({.file = map::input_name(clouds_[i]),
                           .element = "--tiles",
                           .found = "is an octree",
                           .needed = "point clouds",
                           .remedy = "give the clouds that the octree was built from"});
  }

  // What there is to know before the first cell: where all clouds lie, and in which frame.
  map::TileBuilder::Plan plan_of_tiles(const std::vector<Eigen::Isometry3d>& poses,
                                       std::ostream& err, bool quiet) const {
    map::TileBuilder::Plan plan{.name = output_.string(), .resolution_m = resolution_m_, .crs = {}};
    if (carve_range_m_) plan.carve_range_m = *carve_range_m_;
    plan.sticky_hits = !no_sticky_;
    plan.remove_seen_through = remove_seen_through_;
    plan.side_cells = map::tile_side_cells(*tiles_m_, resolution_m_);
    map::Box3 all;
    for (std::size_t i = 0; i < clouds_.size(); ++i) {
      const map::PointCloud cloud = cloud_to_tile(i, poses);
      if (!quiet) print_notes(err, cloud);
      const map::Box3 box = bounds(cloud);
      if (i == 0) all = box;
      if (i == 0) plan.crs = cloud.crs;
      if (cloud.crs != plan.crs) refuse_crs(cloud, plan.crs);
      all = {all.min_in_source.cwiseMin(box.min_in_source),
             all.max_in_source.cwiseMax(box.max_in_source)};
      plan.most_points = std::max(plan.most_points, cloud.points.size());
    }
    plan.origin_in_source = map::tree_origin(all, resolution_m_);
    return plan;
  }

  // Each point would have to be put aside by itself.
  [[noreturn]] static void refuse_log_odds(const map::PointCloud& cloud) {
    throw map::InputError({.file = cloud.name,
                           .element = "--no-sticky with --tiles",
                           .found = "each point is a scan with a sensor position of its own",
                           .needed = "one position for the cloud",
                           .remedy = "leave one of the two out, or give --sensor"});
  }

  [[noreturn]] void refuse_crs(const map::PointCloud& cloud, const std::string& crs) const {
    throw map::InputError({.file = cloud.name,
                           .element = "CRS",
                           .found = fmt::format("\"{}\"", cloud.crs),
                           .needed = fmt::format("\"{}\" as {} has", crs, clouds_[0].string()),
                           .remedy = "bring the clouds into one frame first"});
  }

  Exit build_tiles(const Streams& streams, const CommonOptions& common) const {
    map::OutputFolder folder(output_, {.force = force_, .is_dropped = map::is_tile_file_name});
    const std::vector<Eigen::Isometry3d> poses = poses_of_clouds();
    map::TileBuilder::Plan plan = plan_of_tiles(poses, streams.err, common.quiet);
    plan.folder = folder.in_the_making();
    const map::TilesIndex index = write_tiles(plan, poses, folder);
    folder.commit();
    if (!common.quiet) {
      fmt::print(streams.err, "{}: {} tiles of {} m\n", output_.string(), index.tiles.size(),
                 index.side_m());
      print_removed(streams.err, index.seen_through);
    }
    return Exit::ok;
  }

  map::TilesIndex write_tiles(const map::TileBuilder::Plan& plan,
                              const std::vector<Eigen::Isometry3d>& poses,
                              map::OutputFolder& folder) const {
    map::TileBuilder builder(plan);
    for (std::size_t i = 0; i < clouds_.size(); ++i) builder.add(cloud_to_tile(i, poses));
    map::TilesIndex index = builder.finish(
        [&](const std::string& file, std::string_view bytes) { folder.write(file, bytes); });
    folder.write(map::tiles_index_file("").string(), map::write_tiles_index(index));
    return index;
  }

  std::vector<Eigen::Isometry3d> poses_of_clouds() const {
    if (poses_file_.empty()) return {};
    std::vector<Eigen::Isometry3d> poses = map::read_sensor_poses(poses_file_);
    if (poses.size() == clouds_.size()) return poses;
    throw map::InputError({.file = poses_file_.string(),
                           .found = fmt::format("holds {} poses", poses.size()),
                           .needed = fmt::format("one for each of {} clouds", clouds_.size()),
                           .remedy = "give as many clouds as poses, in the same order"});
  }

  map::OccupancyMap convert(const std::string& bytes, const std::filesystem::path& file) const {
    if (clouds_.size() > 1) {
      throw map::InputError({.file = map::input_name(file),
                             .found = "is an octree beside other files",
                             .needed = "one octree alone, or point clouds",
                             .remedy = "give the clouds that the octree was built from"});
    }
    if (remove_seen_through_ > 0) {
      throw map::InputError({.file = map::input_name(file),
                             .element = "--remove-seen-through",
                             .found = "is an octree, which does not say how often a cell was hit",
                             .needed = "point clouds",
                             .remedy = "give the clouds that the octree was built from"});
    }
    return map::OccupancyMap::parse(bytes, map::input_name(file));
  }

  map::PointCloud prepared(map::PointCloud cloud) const {
    map::check_is_in_metres(cloud);
    if (no_carving_ || !sensor_.empty()) cloud.scans.clear();
    if (filter_.does_something()) {
      check_is_one_scan(cloud);
      cloud = map::filtered(cloud, filter_);
    }
    if (!crs_.empty()) cloud.crs = crs_;
    if (!sensor_.empty()) cloud.sensor_in_source = {sensor_[0], sensor_[1], sensor_[2]};
    if (no_carving_) cloud.sensor_in_source.reset();
    return cloud;
  }

  // Filters do not say which point is which.
  static void check_is_one_scan(const map::PointCloud& cloud) {
    if (cloud.scans.empty()) return;
    throw map::InputError({.file = cloud.name,
                           .element = "sensor",
                           .found = "has a position for each point",
                           .needed = "one for the whole cloud, to filter it",
                           .remedy = "leave the filter out, or give --sensor or --no-carving"});
  }

  static void print_notes(std::ostream& err, const map::PointCloud& cloud) {
    const auto note = [&](const std::string& text) {
      fmt::print(err, "note: {}: {}\n", cloud.name, text);
    };
    for (const std::string& text : cloud.notes) note(text);
    if (cloud.dropped_not_finite > 0) {
      note(fmt::format("{} of {} points are not finite and were left out", cloud.dropped_not_finite,
                       cloud.dropped_not_finite + cloud.points.size()));
    }
    if (!cloud.has_sensor()) {
      note("no sensor position, so all but its hits stays unknown; give --sensor X,Y,Z");
    }
  }

  std::vector<std::filesystem::path> clouds_;
  std::filesystem::path output_, poses_file_;
  double resolution_m_ = 0.1;
  std::vector<double> sensor_;
  std::optional<double> carve_range_m_, scale_, tiles_m_;
  map::CloudFilter filter_;
  std::string crs_, format_;
  int remove_seen_through_ = 0;
  bool no_carving_ = false, no_sticky_ = false, force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_occupancy_build_command() {
  return std::make_unique<OccupancyBuildCommand>();
}

}  // namespace roadbed::tools::commands
