#include "roadbed/map/occupancy/octree/tiles_index.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/parse_json.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/files/visible_text.h"

namespace roadbed::map::inline occupancy::inline octree {
namespace {

using Json = nlohmann::json;
using Ordered = nlohmann::ordered_json;

constexpr const char* kTilesFormat = "roadbed occupancy tiles 2";
constexpr std::int64_t kSmallestSide = 64, kLargestSide = 32768;

[[noreturn]] void refuse_index(const std::string& name, const std::string& element,
                               const std::string& found, const std::string& needed) {
  throw InputError({.file = name,
                    .element = element,
                    .found = found,
                    .needed = needed,
                    .remedy = "build the tiles again"});
}

Ordered json_of(const Eigen::Vector3d& point) { return {point.x(), point.y(), point.z()}; }

/// Takes values out of a document, and says where one is not what it should be.
class IndexReader {
 public:
  IndexReader(Json json, const std::string& name) : json_(std::move(json)), name_(name) {}

  TilesIndex read() const {
    if (text(json_, "format") != kTilesFormat) {
      refuse_index(name_, "format", "\"" + text(json_, "format") + "\"", kTilesFormat);
    }
    TilesIndex index{.resolution_m = number(json_, "resolution_m"),
                     .origin_in_source = point(json_, "origin_m"),
                     .crs = text(json_, "crs"),
                     .side_cells = whole(json_, "side_cells"),
                     .tiles = {}};
    check(index);
    if (json_.contains("seen_through"))
      index.seen_through = seen_through_of(at(json_, "seen_through"));
    std::set<std::pair<std::int64_t, std::int64_t>> places;
    for (const Json& tile : list(json_, "tiles")) {
      index.tiles.push_back(tile_of(tile));
      if (places.emplace(index.tiles.back().x, index.tiles.back().y).second) continue;
      refuse_index(name_, "tiles", index.tiles.back().file + " is there twice", "each once");
    }
    return index;
  }

 private:
  void check(const TilesIndex& index) const {
    constexpr double finest_m = 1e-4, coarsest_m = 1e4;
    if (!(index.resolution_m >= finest_m && index.resolution_m <= coarsest_m)) {
      refuse_index(name_, "resolution_m", fmt::format("{}", index.resolution_m),
                   fmt::format("{} to {}", finest_m, coarsest_m));
    }
    const std::int64_t side = index.side_cells;
    if (side < kSmallestSide || side > kLargestSide ||
        !std::has_single_bit(static_cast<std::uint64_t>(side))) {
      refuse_index(name_, "side_cells", fmt::format("{}", side),
                   fmt::format("a power of two from {} to {}", kSmallestSide, kLargestSide));
    }
  }

  // The name follows from the place, so that no index leads out of its folder.
  OccupancyTile tile_of(const Json& json) const {
    OccupancyTile tile{.x = whole(json, "x"),
                       .y = whole(json, "y"),
                       .file = text(json, "file"),
                       .nodes = static_cast<std::size_t>(whole(json, "nodes")),
                       .sha256 = text(json, "sha256"),
                       .bounds = {point(json, "min_m"), point(json, "max_m")}};
    if (whole(json, "nodes") < 0) refuse_index(name_, "nodes", "is below 0", "0 or more");
    if (tile.file != tile_file_name(tile.x, tile.y)) {
      refuse_index(name_, "file", "\"" + tile.file + "\"", tile_file_name(tile.x, tile.y));
    }
    return tile;
  }

  SeeThroughRemoval seen_through_of(const Json& json) const {
    const std::int64_t clouds = whole(json, "clouds"), cells = whole(json, "removed_cells");
    if (clouds < 1 || clouds > 255 || cells < 0) {
      refuse_index(name_, "seen_through", fmt::format("{} clouds, {} cells", clouds, cells),
                   "1 to 255 clouds, 0 cells or more");
    }
    return {static_cast<int>(clouds), static_cast<std::size_t>(cells)};
  }

  const Json& at(const Json& json, const char* key) const {
    if (!json.is_object() || !json.contains(key)) refuse_index(name_, key, "is missing", "");
    return json.at(key);
  }

  double number(const Json& json, const char* key) const {
    const Json& value = at(json, key);
    if (!value.is_number()) refuse_index(name_, key, "is no number", "a number");
    return value.get<double>();
  }

  std::int64_t whole(const Json& json, const char* key) const {
    constexpr double most = 1e12;
    const double value = number(json, key);
    if (!(std::abs(value) <= most) || value != std::floor(value)) {
      refuse_index(name_, key, fmt::format("is {}", value), "a whole number");
    }
    return static_cast<std::int64_t>(value);
  }

  std::string text(const Json& json, const char* key) const {
    const Json& value = at(json, key);
    if (!value.is_string()) refuse_index(name_, key, "is no text", "text");
    return one_line(value.get<std::string>());
  }

  const Json& list(const Json& json, const char* key) const {
    const Json& value = at(json, key);
    if (!value.is_array()) refuse_index(name_, key, "is no list", "a list");
    return value;
  }

  Eigen::Vector3d point(const Json& json, const char* key) const {
    const Json& value = list(json, key);
    Eigen::Vector3d point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      constexpr double farthest_m = 1e9;
      if (value.size() != 3 || !value[axis].is_number() ||
          !(std::abs(value[axis].get<double>()) <= farthest_m)) {
        refuse_index(name_, key, "is no point", "three numbers up to 10⁹");
      }
      point[static_cast<Eigen::Index>(axis)] = value[axis].get<double>();
    }
    return point;
  }

  const Json json_;
  const std::string& name_;
};

}  // namespace

std::string tile_file_name(std::int64_t x, std::int64_t y) {
  return fmt::format("tile_{}_{}.bt", x, y);
}

bool is_tile_file_name(const std::string& name) {
  return name.starts_with("tile_") && name.ends_with(".bt");
}

std::string write_tiles_index(const TilesIndex& index) {
  Ordered json;
  json["format"] = kTilesFormat;
  json["resolution_m"] = index.resolution_m;
  json["origin_m"] = json_of(index.origin_in_source);
  json["crs"] = index.crs;
  json["side_cells"] = index.side_cells;
  json["overlap_cells"] = 0;
  if (index.seen_through) {
    json["seen_through"] = {{"clouds", index.seen_through->clouds},
                            {"removed_cells", index.seen_through->cells}};
  }
  json["tiles"] = Ordered::array();
  for (const OccupancyTile& tile : index.tiles) {
    json["tiles"].push_back(Ordered{{"file", tile.file},
                                    {"x", tile.x},
                                    {"y", tile.y},
                                    {"nodes", tile.nodes},
                                    {"sha256", tile.sha256},
                                    {"min_m", json_of(tile.bounds.min_in_source)},
                                    {"max_m", json_of(tile.bounds.max_in_source)}});
  }
  return json_text(json, 1) + "\n";
}

TilesIndex parse_tiles_index(std::string_view bytes, const std::string& name) {
  constexpr std::size_t most_bytes = 64'000'000;
  if (bytes.size() > most_bytes) {
    refuse_index(name, "size", fmt::format("{} bytes", bytes.size()),
                 fmt::format("at most {}", most_bytes));
  }
  try {
    return IndexReader(parse_json(bytes, name), name).read();
  } catch (const Json::parse_error& error) {
    refuse_json(error, name);
  } catch (const Json::out_of_range& error) {
    refuse_json(error, name);
  }
}

std::filesystem::path tiles_index_file(const std::filesystem::path& folder) {
  return folder / "index.json";
}

bool is_tiled_occupancy(const std::filesystem::path& path) {
  return is_folder(path) && is_there(tiles_index_file(path));
}

}  // namespace roadbed::map::occupancy::octree
