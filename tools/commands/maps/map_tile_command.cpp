#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/edit/clipping/clip.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/storage/output_folder.h"
#include "roadbed/tools/commands/maps/commands.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline commands::inline maps {
namespace {

constexpr double kMostTiles = 10'000;

/// Of a tile of any tiling: X_Y and a suffix.
bool is_tile_name(const std::string& name) {
  const std::size_t dot = name.find('.'), bar = name.find('_');
  if (dot == name.npos || bar > dot) return false;
  const auto is_number = [](std::string_view text) {
    if (text.starts_with('-')) text.remove_prefix(1);
    return !text.empty() && text.find_first_not_of("0123456789") == text.npos;
  };
  const std::string_view stem = std::string_view(name).substr(0, dot);
  return is_number(stem.substr(0, bar)) && is_number(stem.substr(bar + 1));
}

/// Which squares of the grid a map lies in.
struct TileRange {
  long from_x = 0, to_x = 0, from_y = 0, to_y = 0;
};

geometry::Box box_of(const map::RoadMap& road_map) {
  geometry::Box box;
  for (const map::Lane& lane : road_map.lanes()) {
    for (const map::LaneLine* line : {&lane.left, &lane.right}) {
      for (const Eigen::Vector2d& point : line->in_map.points()) {
        box.extend(road_map.to_source(point));
      }
    }
  }
  return box;
}

class TileCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Cut a map into square tiles, in its own format");
    arguments.add("MAP", input_, "An OpenDRIVE, Lanelet2 or CommonRoad file")
        .required()
        .reads()
        .ending(kMapEndings);
    arguments.add("SIDE", side_m_, "Side of a tile; corners are multiples of it [m]")
        .required()
        .within(1e-3, 1e5);
    arguments.add("-o,--output", output_, "Folder for X_Y.suffix of each tile, and tiles.json")
        .required()
        .writes("/");
    arguments.flag("--whole", options_.whole,
                   "Keep roads and lanelets that a tile touches whole, in place of cutting them");
    arguments.flag("-f,--force", force_, "Replace files that exist in the folder");
    arguments.says_no_if("no tile has anything in it");
    arguments.example("  roadbed map tile town.xodr 250 -o tiles");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    map::OutputFolder folder(
        output_, {.force = force_, .is_dropped = is_tile_name, .inputs = common.input_files});
    const std::string name = map::input_name(input_);
    std::string bytes = map::read_file(input_);
    const TileRange range = tiles_of(map::parse_map(bytes, name), name);
    const map::Clipper clip = map::make_clipper(std::move(bytes), name, options_);
    Json tiles = Json::array();
    std::vector<std::string> notes, left_out;
    for (long y = range.from_y; y <= range.to_y; ++y) {
      for (long x = range.from_x; x <= range.to_x; ++x) {
        const Eigen::Vector2d corner(static_cast<double>(x) * side_m_,
                                     static_cast<double>(y) * side_m_);
        const Eigen::Vector2d far = corner + Eigen::Vector2d::Constant(side_m_);
        const map::Edited tile = clip(map::Region({geometry::box_ring(corner, far)}));
        const std::string file = fmt::format("{}_{}{}", x, y, suffix());
        if (tile.bytes.empty()) {
          if (!tile.counts.empty()) left_out.push_back(file);
          continue;
        }
        folder.write(file, tile.bytes);
        for (const std::string& note : tile.notes) notes.push_back(file + ": " + note);
        tiles.push_back({{"file", file},
                         {"min_x_m", corner.x()},
                         {"min_y_m", corner.y()},
                         {"max_x_m", far.x()},
                         {"max_y_m", far.y()}});
      }
    }
    if (tiles.empty()) {
      fmt::print(streams.err, "roadbed: nothing is left: no tile has anything in it\n");
      return Exit::no;
    }
    const std::size_t count = tiles.size();
    const Json index = {{"roadbed_map_tiles", 1}, {"side_m", side_m_}, {"tiles", std::move(tiles)}};
    folder.write("tiles.json", map::json_text(index, 2) + "\n");
    folder.commit();
    if (common.quiet) return Exit::ok;
    fmt::print(streams.err, "{}: {} tiles\n", output_.string(), count);
    for (const std::string& note : notes) fmt::print(streams.err, "note: {}\n", note);
    if (!left_out.empty()) fmt::print(streams.err, "note: {}\n", note_of(left_out));
    return Exit::ok;
  }

 private:
  static std::string note_of(const std::vector<std::string>& left_out) {
    constexpr std::size_t most = 5;
    const std::size_t named = std::min(most, left_out.size()), more = left_out.size() - named;
    return fmt::format(
        "left out, as lines are there but no lanelet: {}{}",
        fmt::join(left_out.begin(), left_out.begin() + static_cast<long>(named), ", "),
        more > 0 ? fmt::format(" and {} more", more) : "");
  }

  std::string suffix() const {
    const std::string own = input_.extension().string();
    return own.empty() || own == ".gz" || own == ".zst" ? input_.stem().extension().string() : own;
  }

  TileRange tiles_of(const map::RoadMap& road_map, const std::string& name) const {
    const geometry::Box box = box_of(road_map);
    const Eigen::Vector2d from = (box.min() / side_m_).array().floor();
    const Eigen::Vector2d to = (box.max() / side_m_).array().floor();
    const Eigen::Vector2d count = to - from + Eigen::Vector2d::Ones();
    if (!(count.x() * count.y() <= kMostTiles)) {
      throw map::InputError({.file = name,
                             .found = fmt::format("a map of {:.0f} by {:.0f} tiles of {} m",
                                                  count.x(), count.y(), side_m_),
                             .needed = fmt::format("at most {:.0f} tiles", kMostTiles),
                             .remedy = "give a longer side"});
    }
    return {std::lround(from.x()), std::lround(to.x()), std::lround(from.y()), std::lround(to.y())};
  }

  std::filesystem::path input_, output_;
  double side_m_ = 0.0;
  map::ClipOptions options_;
  bool force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_map_tile_command() { return std::make_unique<TileCommand>(); }

}  // namespace roadbed::tools::commands::maps
