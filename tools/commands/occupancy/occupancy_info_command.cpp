#include <fmt/format.h>
#include <fmt/ostream.h>

#include <filesystem>
#include <iostream>
#include <string>

#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/logs/log.h"
#include "roadbed/map/occupancy/clouds/log_clouds.h"
#include "roadbed/map/occupancy/clouds/read_point_cloud.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/map/occupancy/octree/tiled_occupancy.h"
#include "roadbed/tools/commands/occupancy/cloud_inputs.h"
#include "roadbed/tools/commands/occupancy/commands.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline commands::inline occupancy {
namespace {

Json bounds_json(const map::Box3& box) {
  return {{"min_x_m", box.min_in_source.x()}, {"min_y_m", box.min_in_source.y()},
          {"min_z_m", box.min_in_source.z()}, {"max_x_m", box.max_in_source.x()},
          {"max_y_m", box.max_in_source.y()}, {"max_z_m", box.max_in_source.z()}};
}

Json crs_json(const std::string& crs) { return crs.empty() ? Json() : Json(crs); }

/// Leaves of one state: how many, their volume and the box around them.
struct Space {
  std::size_t leaves = 0;
  double volume_m3 = 0.0;
  map::Box3 box;

  void add(const map::OccupancyCell& cell) {
    const Eigen::Vector3d least = cell.centre_in_source.array() - 0.5 * cell.size_m;
    const Eigen::Vector3d most = cell.centre_in_source.array() + 0.5 * cell.size_m;
    box = leaves == 0
              ? map::Box3{least, most}
              : map::Box3{box.min_in_source.cwiseMin(least), box.max_in_source.cwiseMax(most)};
    ++leaves;
    volume_m3 += cell.size_m * cell.size_m * cell.size_m;
  }

  Json json() const {
    return {{"leaves", leaves},
            {"volume_m3", volume_m3},
            {"bounds", leaves == 0 ? Json() : bounds_json(box)}};
  }
};

Json seen_through_json(const std::optional<map::SeeThroughRemoval>& removed) {
  if (!removed) return {};
  return {{"clouds", removed->clouds}, {"removed_cells", removed->cells}};
}

Json octree_info(const map::OccupancyMap& occupancy) {
  Space occupied, free, known;
  occupancy.for_each_cell([&](const map::OccupancyCell& cell) {
    known.add(cell);
    (cell.state == map::CellState::occupied ? occupied : free).add(cell);
  });
  Json info;
  info["kind"] = "octree";
  info["crs"] = crs_json(occupancy.crs());
  info["origin"] = {{"x_m", occupancy.origin_in_source().x()},
                    {"y_m", occupancy.origin_in_source().y()},
                    {"z_m", occupancy.origin_in_source().z()}};
  info["resolution_m"] = occupancy.resolution_m();
  info["seen_through"] = seen_through_json(occupancy.seen_through());
  info["nodes"] = occupancy.node_count();
  info["leaves"] = known.leaves;
  info["bounds"] = known.json().at("bounds");
  info["occupied"] = occupied.json();
  info["free"] = free.json();
  return info;
}

Json tiles_info(const map::TiledOccupancy& tiles) {
  const map::TilesIndex& index = tiles.index();
  std::size_t nodes = 0;
  for (const map::OccupancyTile& tile : index.tiles) nodes += tile.nodes;
  const std::optional<map::Box3> box = tiles.bounds();
  Json info;
  info["kind"] = "tiles";
  info["crs"] = crs_json(index.crs);
  info["origin"] = {{"x_m", index.origin_in_source.x()},
                    {"y_m", index.origin_in_source.y()},
                    {"z_m", index.origin_in_source.z()}};
  info["resolution_m"] = index.resolution_m;
  info["seen_through"] = seen_through_json(index.seen_through);
  info["side_m"] = index.side_m();
  info["overlap_m"] = 0.0;
  info["tiles"] = index.tiles.size();
  info["nodes"] = nodes;
  info["bounds"] = box ? bounds_json(*box) : Json();
  return info;
}

Json log_info(const map::LogClouds& log, const map::CloudFilter& filter) {
  std::size_t points = 0, filtered_out = 0;
  std::optional<map::Box3> box;
  const map::LogCloudCounts counts = log.for_each(
      [&](map::PointCloud cloud) {
        cloud.filtered_out = 0;
        cloud = map::within_reach(std::move(cloud), filter);
        filtered_out += cloud.filtered_out;
        points += cloud.points.size();
        if (cloud.points.empty()) return;
        const map::Box3 around = bounds(cloud);
        if (!box) box = around;
        box->extend(around);
      },
      filter);
  return {{"kind", "clouds"},
          {"format", "PointCloud2"},
          {"topic", log.topic()},
          {"crs", Json()},
          {"unit", std::string(to_string(map::LengthUnit::metre))},
          {"clouds", counts.clouds},
          {"points", points},
          {"not_finite", counts.not_finite},
          {"filtered_out", counts.filtered_out + filtered_out},
          {"bounds", box ? bounds_json(*box) : Json()},
          {"notes", log.notes(counts)}};
}

Json cloud_info(const map::PointCloud& cloud) {
  Json info;
  info["kind"] = "cloud";
  info["format"] = cloud.format;
  info["crs"] = crs_json(cloud.crs);
  info["unit"] = std::string(to_string(cloud.unit));
  info["points"] = cloud.points.size();
  info["not_finite"] = cloud.dropped_not_finite;
  info["filtered_out"] = cloud.filtered_out;
  info["bounds"] = cloud.points.empty() ? Json() : bounds_json(bounds(cloud));
  info["sensor"] = Json();
  if (cloud.sensor_in_source) {
    const Eigen::Vector3d& at = *cloud.sensor_in_source;
    info["sensor"] = {{"x_m", at.x()}, {"y_m", at.y()}, {"z_m", at.z()}};
  }
  info["scans"] = cloud.scans.size();
  info["notes"] = cloud.notes;
  return info;
}

// "x 0 to 10, y -5 to 5, z 0 to 3"
std::string bounds_text(const Json& bounds) {
  if (bounds.is_null()) return "none";
  std::string text;
  for (const char* axis : {"x", "y", "z"}) {
    text += fmt::format("{}{} {:.3f} to {:.3f}", text.empty() ? "" : ", ", axis,
                        bounds.at(fmt::format("min_{}_m", axis)).get<double>(),
                        bounds.at(fmt::format("max_{}_m", axis)).get<double>());
  }
  return text;
}

std::string report_text(const std::string& key, const Json& value) {
  if (value.is_null()) return key == "seen_through" ? "every hit was kept" : "unknown";
  if (value.is_string()) return value.get<std::string>();
  if (value.contains("min_x_m")) return bounds_text(value);
  if (value.contains("leaves")) {
    return fmt::format("{} leaves, {:.3f} m3, {}", value.at("leaves").get<std::size_t>(),
                       value.at("volume_m3").get<double>(), bounds_text(value.at("bounds")));
  }
  if (key == "seen_through") {
    return fmt::format("{} clouds or more, {} cells with points count as free",
                       value.at("clouds").get<int>(), value.at("removed_cells").get<std::size_t>());
  }
  if (value.contains("x_m")) {
    return fmt::format("{}, {}, {}", value.at("x_m").get<double>(), value.at("y_m").get<double>(),
                       value.at("z_m").get<double>());
  }
  return map::json_text(value);
}

class OccupancyInfoCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Say what an octree or a point cloud holds: counts, bounds, frame");
    arguments
        .add("F", input_,
             "Octree (.bt .ot), folder of tiles, point cloud (.pcd .ply .las .laz .xyz .csv .bin "
             ".feather), or "
             "log with clouds (a bag's folder, .db3 .mcap)")
        .required()
        .ending(kCloudInputEndings);
    declare_cloud_topics(arguments, topics_);
    filter_.declare(arguments);
    arguments.flag("-j,--json", json_, "Print one JSON document");
    arguments.example(
        "  roadbed occupancy info street.bt --json\n"
        "  roadbed occupancy info drive.mcap --topic /points --json");
  }

  Exit run(const Streams& streams, const CommonOptions&) override {
    const Json info = info_of_input();
    if (json_) {
      streams.out << map::json_text(versioned("occupancy_info", info), 2) << '\n';
    } else {
      for (const auto& [key, value] : info.items()) {
        fmt::print(streams.out, "{:<14}{}\n", key, report_text(key, value));
      }
    }
    return Exit::ok;
  }

 private:
  Json info_of_input() const {
    if (map::is_tiled_occupancy(input_)) return tiles_info(map::TiledOccupancy(input_));
    if (map::is_log(input_)) return log_info(map::LogClouds(input_, topics_), filter_.filter());
    const std::string bytes = map::read_file(input_, map::most_unpacked_of_rows);
    return map::is_occupancy_file(bytes)
               ? octree_info(map::OccupancyMap::parse(bytes, map::input_name(input_)))
               : cloud_info(map::within_reach(map::point_cloud_of(input_, bytes, filter_.filter()),
                                              filter_.filter()));
  }

  std::filesystem::path input_;
  map::LogCloudTopics topics_;
  FilterArguments filter_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> make_occupancy_info_command() {
  return std::make_unique<OccupancyInfoCommand>();
}

}  // namespace roadbed::tools::commands::occupancy
