#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/map/occupancy/octree/tile_builder.h"
#include "roadbed/map/occupancy/octree/tiles_index.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/map/storage/output_folder.h"
#include "roadbed/tools/cli/output_format.h"
#include "roadbed/tools/commands/occupancy/cloud_inputs.h"
#include "roadbed/tools/commands/occupancy/commands.h"

namespace roadbed::tools::inline commands::inline occupancy {
namespace {

class OccupancyBuildCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description(
        "Make an OctoMap file from point clouds. A measured hit stays occupied whatever rays pass "
        "through its cell; space that no ray crossed stays unknown");
    clouds_.declare(arguments);
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
    clouds_.declare_sensor(arguments);
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
    clouds_.declare_changes(arguments);
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
        "  roadbed occupancy build scans/*.pcd --tiles 100 -o city.tiles\n"
        "  roadbed occupancy build drive.mcap --topic /points -o driven.bt\n"
        "  roadbed occupancy build drive.mcap --range 1,60 --vehicle-box=-1,-1,0,4,1,2 -o near.bt");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    if (tiles_m_) return build_tiles(streams, common);
    map::check_writable(output_, force_);
    const Made made = make(note_to(streams.err, common.quiet));
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

  map::OccupancyOptions options() const {
    map::OccupancyOptions options{.resolution_m = resolution_m_,
                                  .sticky_hits = !no_sticky_,
                                  .remove_seen_through = remove_seen_through_};
    if (carve_range_m_) options.carve_range_m = *carve_range_m_;
    return options;
  }

  Made make(const CloudInputs::Note& note) const {
    if (const auto octree = clouds_.only_octree()) return written(convert(*octree));
    if (!clouds_.hold_logs()) {
      std::vector<map::PointCloud> clouds;
      clouds_.for_each([&](map::PointCloud cloud) { clouds.push_back(std::move(cloud)); }, note);
      return made_of(std::span<const map::PointCloud>(clouds));
    }
    bool is_first = true;  // of the times that they are gone through
    return made_of(map::CloudsInTurn([&](const std::function<void(const map::PointCloud&)>& use) {
      clouds_.for_each(use, std::exchange(is_first, false) ? note : CloudInputs::Note());
    }));
  }

  template <class Clouds>
  Made made_of(const Clouds& clouds) const {
    if (wants_log_odds()) return written(map::OccupancyMap::build(clouds, options()));
    return {map::OccupancyMap::build_bt(clouds, options()), resolution_m_};
  }

  void for_each_to_tile(const std::function<void(const map::PointCloud&)>& use,
                        const CloudInputs::Note& note) const {
    clouds_.for_each(
        [&](const map::PointCloud& cloud) {
          if (no_sticky_ && !cloud.scans.empty()) refuse_log_odds(cloud);
          use(cloud);
        },
        note);
  }

  // What there is to know before the first cell: where all clouds lie, and in which frame.
  map::TileBuilder::Plan plan_of_tiles(const CloudInputs::Note& note) const {
    map::TileBuilder::Plan plan{.name = output_.string(), .resolution_m = resolution_m_, .crs = {}};
    if (carve_range_m_) plan.carve_range_m = *carve_range_m_;
    plan.sticky_hits = !no_sticky_;
    plan.remove_seen_through = remove_seen_through_;
    plan.side_cells = map::tile_side_cells(*tiles_m_, resolution_m_);
    std::optional<map::Box3> all;
    for_each_to_tile(
        [&](const map::PointCloud& cloud) {
          if (!all) plan.crs = cloud.crs;
          if (cloud.crs != plan.crs) refuse_crs(cloud, plan.crs);
          const map::Box3 box = bounds(cloud);
          if (!all) all = box;
          all->extend(box);
          plan.most_points = std::max(plan.most_points, cloud.points.size());
        },
        note);
    plan.origin_in_source = map::tree_origin(*all, resolution_m_);
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
                           .needed = fmt::format("\"{}\" as {} has", crs, clouds_.first_name()),
                           .remedy = "bring the clouds into one frame first"});
  }

  Exit build_tiles(const Streams& streams, const CommonOptions& common) const {
    map::OutputFolder folder(output_, {.force = force_, .is_dropped = map::is_tile_file_name});
    map::TileBuilder::Plan plan = plan_of_tiles(note_to(streams.err, common.quiet));
    plan.folder = folder.in_the_making();
    const map::TilesIndex index = write_tiles(plan, folder);
    folder.commit();
    if (!common.quiet) {
      fmt::print(streams.err, "{}: {} tiles of {} m\n", output_.string(), index.tiles.size(),
                 index.side_m());
      print_removed(streams.err, index.seen_through);
    }
    return Exit::ok;
  }

  map::TilesIndex write_tiles(const map::TileBuilder::Plan& plan, map::OutputFolder& folder) const {
    map::TileBuilder builder(plan);
    for_each_to_tile([&](const map::PointCloud& cloud) { builder.add(cloud); }, {});
    map::TilesIndex index = builder.finish(
        [&](const std::string& file, std::string_view bytes) { folder.write(file, bytes); });
    folder.write(map::tiles_index_file("").string(), map::write_tiles_index(index));
    return index;
  }

  map::OccupancyMap convert(const std::string& bytes) const {
    if (remove_seen_through_ == 0) return map::OccupancyMap::parse(bytes, clouds_.first_name());
    throw map::InputError({.file = clouds_.first_name(),
                           .element = "--remove-seen-through",
                           .found = "is an octree, which does not say how often a cell was hit",
                           .needed = "point clouds",
                           .remedy = "give the clouds that the octree was built from"});
  }

  static CloudInputs::Note note_to(std::ostream& err, bool quiet) {
    if (quiet) return {};
    return [&err](const std::string& name, const std::string& text) {
      fmt::print(err, "note: {}: {}\n", name, text);
    };
  }

  CloudInputs clouds_;
  std::filesystem::path output_;
  double resolution_m_ = 0.1;
  std::optional<double> carve_range_m_, tiles_m_;
  std::string format_;
  int remove_seen_through_ = 0;
  bool no_sticky_ = false, force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_occupancy_build_command() {
  return std::make_unique<OccupancyBuildCommand>();
}

}  // namespace roadbed::tools::commands::occupancy
