#include "roadbed/tools/commands/maps/page_overlays.h"

#include <fmt/format.h>

#include <utility>

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/occupancy/octree/tiled_occupancy.h"
#include "roadbed/tools/files/drive_file.h"
#include "roadbed/tools/files/json.h"
#include "roadbed/tools/report/surroundings.h"

namespace roadbed::tools::inline commands::inline maps {
namespace {

using Eigen::Vector2d;

constexpr Range kAnyLength{0.0, 1e9};

map::PageOverlay overlay_of(std::string kind, std::string name) {
  map::PageOverlay overlay;
  overlay.kind = std::move(kind);
  overlay.name = std::move(name);
  return overlay;
}

map::PagePiece piece_of(const map::RoadMap& road_map, const JsonNode& json) {
  const JsonNode name = json.at("lane");
  const auto lane = road_map.find_lane(name.one_line());
  if (!lane) {
    name.refuse(fmt::format("the map has no lane \"{}\"", name.name()), "a lane of the map",
                "make the file with the same map");
  }
  return {*lane, json.at("from_s_m").number(kAnyLength), json.at("to_s_m").number(kAnyLength)};
}

std::vector<map::PagePiece> pieces_of(const map::RoadMap& road_map, const JsonNode& json) {
  std::vector<map::PagePiece> pieces;
  for (const JsonNode& lane : json.at("lanes").elements()) {
    pieces.push_back(piece_of(road_map, lane));
  }
  return pieces;
}

map::PageOverlay route_of(const map::RoadMap& road_map, const JsonNode& json, std::string name) {
  map::PageOverlay overlay = overlay_of("route", std::move(name));
  overlay.pieces = pieces_of(road_map, json);
  overlay.text = fmt::format("{:.0f} m, {:.0f} s", json.at("length_m").number(kAnyLength),
                             json.at("cost_s").number(kAnyLength));
  return overlay;
}

/// A route as `route --json` prints it, with its alternatives.
void add_routes(const map::RoadMap& road_map, const std::filesystem::path& file,
                std::vector<map::PageOverlay>& overlays) {
  const nlohmann::json document = parse_json_strictly(map::read_file(file), file.string());
  const JsonNode route(document, file.string());
  if (!route.at("found").boolean()) {
    route.at("found").refuse("no route was found", "a route", "leave the file out");
  }
  const std::string name = "Route " + file.stem().string();
  overlays.push_back(route_of(road_map, route, name));
  const auto others = route.find("alternatives");
  if (!others) return;
  std::size_t number = 0;
  for (const JsonNode& other : others->elements()) {
    overlays.push_back(
        route_of(road_map, other, fmt::format("{}, alternative {}", name, ++number)));
    overlays.back().is_alternative = true;
  }
}

map::PageOverlay reach_of(const map::RoadMap& road_map, const std::filesystem::path& file) {
  const nlohmann::json document = parse_json_strictly(map::read_file(file), file.string());
  const JsonNode reach(document, file.string());
  map::PageOverlay overlay = overlay_of("reach", "Reach " + file.stem().string());
  overlay.pieces = pieces_of(road_map, reach);
  overlay.text = "within " + reach.at("within").name();
  return overlay;
}

map::PageOverlay drive_of(const map::RoadMap& road_map, const std::filesystem::path& file,
                          const DriveOptions& options) {
  const geometry::Trajectory drive = read_drive(file, options).drive;
  map::PageOverlay overlay = overlay_of("drive", "Drive " + file.stem().string());
  overlay.lines_in_map.emplace_back();
  for (const geometry::TrajectoryPoint& point : drive.points()) {
    overlay.lines_in_map.back().push_back(road_map.to_map(point.pose().position()));
  }
  if (!drive.empty()) overlay.text = fmt::format("{:.1f} s", drive.end_s() - drive.start_s());
  return overlay;
}

map::PageOverlay slice_of(const map::RoadMap& road_map, const std::filesystem::path& file,
                          const map::HeightBand& band) {
  const auto occupancy = map::open_occupancy(file);
  map::PageOverlay overlay = overlay_of("occupied", "Occupied " + file.filename().string());
  overlay.text = fmt::format("{} to {} m", band.from_m, band.to_m);
  const auto bounds = occupancy->bounds();
  if (!bounds) return overlay;
  const Eigen::AlignedBox2d all(bounds->min_in_source.head<2>(), bounds->max_in_source.head<2>());
  for (const map::Box2& box : occupied_in(*occupancy, band, all)) {
    overlay.boxes_in_map.emplace_back(road_map.to_map(box.min_in_source),
                                      road_map.to_map(box.max_in_source));
  }
  return overlay;
}

/// Findings as `validate --json` prints them.
std::vector<map::PageRemark> findings_in(const map::RoadMap& road_map,
                                         const std::filesystem::path& file) {
  const nlohmann::json document = parse_json_strictly(map::read_file(file), file.string());
  std::vector<map::PageRemark> remarks;
  for (const JsonNode& finding : JsonNode(document, file.string()).at("findings").elements()) {
    map::PageRemark remark;
    remark.rule = finding.at("rule").name();
    remark.severity = finding.at("severity").name();
    remark.element = finding.at("element").name();
    remark.message = finding.at("message").name();
    const auto number = [&](std::string_view key) -> std::optional<double> {
      const auto found = finding.find(key);
      if (!found || found->value().is_null()) return std::nullopt;
      return found->number({-1e9, 1e9});
    };
    remark.line = static_cast<long>(number("line").value_or(0.0));
    const auto x = number("x_m"), y = number("y_m");
    if (x && y) remark.in_map = road_map.to_map(Vector2d(*x, *y));
    remarks.push_back(std::move(remark));
  }
  return remarks;
}

}  // namespace

void PageOverlays::declare(Arguments& arguments) {
  const std::string heading = arguments.heading("Shown on a page (.html)");
  arguments.add("--route", routes_, "What `route --json` printed, with its alternatives").reads();
  arguments.add("--reach", reached_, "What `reach --json` printed").reads();
  arguments.add("--trajectory", trajectories_, "A drive: .csv, or what audit reads").reads();
  of_drive_.declare(arguments);
  arguments.add("--occupancy", occupancy_, "An octree, or a folder of tiles: what is occupied")
      .reads();
  arguments.add("--slice", slice_m_, "Heights between which occupied space is shown [m]")
      .values(2)
      .separated_by(',')
      .with_default();
  arguments
      .add("--findings", findings_,
           "What `validate --json` printed; else what the rules about maps find")
      .reads();
  arguments.heading(heading);
}

bool PageOverlays::empty() const {
  return routes_.empty() && reached_.empty() && trajectories_.empty() && occupancy_.empty() &&
         findings_.empty();
}

void PageOverlays::add_to(map::MapPageOptions& page, const map::RoadMap& road_map) const {
  if (!occupancy_.empty()) {
    const map::HeightBand band{.from_m = slice_m_[0], .to_m = slice_m_[1]};
    page.overlays.push_back(slice_of(road_map, occupancy_, band));
  }
  for (const auto& file : reached_) page.overlays.push_back(reach_of(road_map, file));
  for (const auto& file : routes_) add_routes(road_map, file, page.overlays);
  for (const auto& file : trajectories_)
    page.overlays.push_back(drive_of(road_map, file, of_drive_.options({})));
  if (!findings_.empty()) page.remarks = findings_in(road_map, findings_);
}

}  // namespace roadbed::tools::commands::maps
