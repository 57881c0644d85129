#include "roadbed/map/opendrive/write/write.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <stdexcept>
#include <string_view>

#include "roadbed/map/files/projection.h"
#include "roadbed/map/files/xml.h"
#include "roadbed/map/files/xml_characters.h"
#include "roadbed/map/opendrive/write/border_errors.h"
#include "roadbed/map/opendrive/write/furniture_text.h"
#include "roadbed/map/opendrive/write/lane_text.h"
#include "roadbed/map/opendrive/write/number_text.h"
#include "roadbed/map/opendrive/write/road_network.h"
#include "roadbed/map/opendrive/write/shape_roads.h"

namespace roadbed::map::opendrive {
namespace {

constexpr double kHeading_rad = 5e-10, kLength_m = 5e-7;  // written within
constexpr double kAim_m = 0.01;                           // borders that are farther off are named

struct Bounds {
  Eigen::Vector2d low{1e300, 1e300}, high{-1e300, -1e300};
};

class FileWriter {
 public:
  FileWriter(const RoadMap& road_map, const OpenDriveOptions& options)
      : road_map_(road_map), options_(options) {
    ShapedRoads roads = shape_roads(road_map, options.minor, options.threads);
    plan_ = std::move(roads.plan);
    shapes_ = std::move(roads.shapes);
    measure(border_errors(road_map, plan_, shapes_, options.threads));
    network_ = join_roads(road_map, plan_, shapes_);
    furniture_ = furniture_text(road_map, plan_, shapes_, network_, options.minor);
  }

  OpenDriveFile write() {
    text_ = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<OpenDRIVE>\n";
    add_header();
    for (std::uint32_t part = 0; part < network_.parts.size(); ++part) add_road(part);
    text_ += furniture_.controllers;
    for (const WrittenJunction& junction : network_.junctions) add_junction(junction);
    text_ += "</OpenDRIVE>\n";
    file_.bytes = std::move(text_);
    count_losses();
    return std::move(file_);
  }

 private:
  template <typename... Values>
  void add(fmt::format_string<Values...> words, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), words, std::forward<Values>(values)...);
  }

  // Names the roads that are too far off, the worst first.
  void measure(const std::vector<BorderError>& errors) {
    std::vector<std::size_t> roads;
    for (std::size_t road = 0; road < errors.size(); ++road) {
      file_.largest_error_m = std::max(file_.largest_error_m, errors[road].largest_m);
      file_.largest_height_error_m =
          std::max(file_.largest_height_error_m, shapes_[road].height_error_m);
      if (errors[road].largest_m > kAim_m) roads.push_back(road);
    }
    std::ranges::stable_sort(roads, std::ranges::greater{},
                             [&](std::size_t road) { return errors[road].largest_m; });
    for (const std::size_t road : roads) {
      const PlannedLane& first = plan_.roads[road].sections.front().lanes.front();
      const Eigen::Vector2d at = road_map_.to_source(errors[road].at);
      file_.notes.push_back(
          fmt::format("the road of lane {} has borders up to {:.3f} m off, at {:.2f},{:.2f}: they "
                      "end askew, turn too sharply, or are another's for the lane beside it",
                      road_map_.lane(first.lane).name, errors[road].largest_m, at.x(), at.y()));
    }
  }

  void add_header() {
    Bounds bounds;
    for (const Lane& lane : road_map_.lanes()) {
      for (const LaneLine* line : {&lane.left, &lane.right}) {
        for (const Eigen::Vector2d& point : line->in_map.points()) {
          bounds.low = bounds.low.cwiseMin(road_map_.to_source(point));
          bounds.high = bounds.high.cwiseMax(road_map_.to_source(point));
        }
      }
    }
    add("<header revMajor=\"1\" revMinor=\"{}\" name=\"\" version=\"1\" north=\"{}\" "
        "south=\"{}\" east=\"{}\" west=\"{}\" vendor=\"roadbed\"",
        options_.minor, short_number(bounds.high.y()), short_number(bounds.low.y()),
        short_number(bounds.high.x()), short_number(bounds.low.x()));
    const CrsOffset& offset = options_.offset_in_crs;
    const bool has_offset = options_.minor >= 5 && !(offset == CrsOffset{});
    if (options_.crs.empty() && !has_offset) {
      text_ += "/>\n";
      return;
    }
    text_ += ">\n";
    if (!options_.crs.empty())
      add("<geoReference>{}</geoReference>\n", xml_text(proj_string(options_.crs)));
    if (has_offset) {
      add("<offset x=\"{}\" y=\"{}\" z=\"{}\" hdg=\"{}\"/>\n", short_number(offset.x_m),
          short_number(offset.y_m), short_number(offset.z_m), offset.heading_rad);
    }
    text_ += "</header>\n";
  }

  void add_road(std::uint32_t index) {
    const RoadPart& part = network_.parts[index];
    const PlannedRoad& planned = plan_.roads[part.road];
    const RoadShape& shape = shapes_[part.road];
    const std::string name = planned.source ? road_map_.road(*planned.source).name : "";
    const double length_m = part.to_m - part.from_m;
    text_ += "<road";
    if (!name.empty()) add(" name=\"{}\"", xml_text(name));
    add(" length=\"{}\" id=\"{}\" junction=\"{}\"", short_number(length_m), part.id,
        part.junction ? network_.junctions[*part.junction].id : "-1");
    if (plan_.left_hand_traffic) text_ += " rule=\"LHT\"";
    text_ += ">\n";
    add_links(part);
    add_plan_view(shape, part);
    add_profile("elevationProfile", "elevation", shape.elevation, part);
    add_profile("lateralProfile", "superelevation", shape.superelevation, part);
    text_ += lanes_text(road_map_, planned, shape, part, plan_.left_hand_traffic, options_.minor,
                        losses_);
    if (!furniture_.objects[index].empty()) {
      add("<objects>\n{}</objects>\n", furniture_.objects[index]);
    }
    if (!furniture_.signals[index].empty()) {
      add("<signals>\n{}</signals>\n", furniture_.signals[index]);
    }
    text_ += "</road>\n";
  }

  void add_links(const RoadPart& part) {
    if (!part.links[0] && !part.links[1]) return;
    text_ += "<link>";
    for (const std::size_t end : {0U, 1U}) {
      if (!part.links[end]) continue;
      const PartLink& link = *part.links[end];
      const char* name = end == 0 ? "predecessor" : "successor";
      if (link.to_junction) {
        add("<{} elementType=\"junction\" elementId=\"{}\"/>", name,
            network_.junctions[link.target].id);
      } else {
        add("<{} elementType=\"road\" elementId=\"{}\" contactPoint=\"{}\"/>", name,
            network_.parts[link.target].id, link.at_end ? "end" : "start");
      }
    }
    text_ += "</link>\n";
  }

  void add_plan_view(const RoadShape& shape, const RoadPart& part) {
    text_ += "<planView>\n";
    for (const geometry::PlanPiece& piece : shape.plan_view) {
      const double from_m = std::max(part.from_m, piece.s_m);
      const double to_m = std::min(part.to_m, piece.s_m + piece.length_m);
      if (to_m - from_m < 1e-6) continue;
      const geometry::PlanPoint start = geometry::plan_point(piece, from_m);
      const geometry::PlanPoint end = geometry::plan_point(piece, to_m);
      const double bend_per_m =
          std::max(std::abs(start.curvature_per_m), std::abs(end.curvature_per_m));
      const Eigen::Vector2d at = road_map_.to_source(start.pose.position());
      add("<geometry s=\"{}\" x=\"{}\" y=\"{}\" hdg=\"{}\" length=\"{}\">",
          short_number(from_m - part.from_m), short_number(at.x()), short_number(at.y()),
          number_within(start.pose.heading_rad, kHeading_rad),
          number_within(to_m - from_m, kLength_m / std::max(1.0, bend_per_m)));
      const auto curvature = [&](double value_per_m) {
        return number_within(value_per_m, kHeading_rad / std::max(1.0, to_m - from_m));
      };
      if (std::holds_alternative<geometry::LineCurve>(piece.curve)) {
        text_ += "<line/>";
      } else if (const auto* arc = std::get_if<geometry::ArcCurve>(&piece.curve)) {
        add("<arc curvature=\"{}\"/>", curvature(arc->curvature_per_m));
      } else {
        add("<spiral curvStart=\"{}\" curvEnd=\"{}\"/>", curvature(start.curvature_per_m),
            curvature(end.curvature_per_m));
      }
      text_ += "</geometry>\n";
    }
    text_ += "</planView>\n";
  }

  void add_profile(const char* name, const char* element, const geometry::PiecewiseCubic& cubic,
                   const RoadPart& part) {
    if (cubic.empty()) return;
    add("<{}>\n", name);
    add_records(cubic, part.from_m, part.to_m, part.from_m, element, "s", text_);
    add("</{}>\n", name);
  }

  void add_junction(const WrittenJunction& junction) {
    add("<junction id=\"{}\" name=\"{}\"{}>\n", junction.id, xml_text(junction.name),
        options_.minor >= 5 ? " type=\"default\"" : "");
    int id = 0;
    for (const WrittenConnection& connection : junction.connections) {
      add("<connection id=\"{}\" incomingRoad=\"{}\" connectingRoad=\"{}\" contactPoint=\"{}\">",
          id++, network_.parts[connection.incoming].id, network_.parts[connection.connecting].id,
          connection.at_end ? "end" : "start");
      for (const auto& [from, to] : connection.lanes) {
        add("<laneLink from=\"{}\" to=\"{}\"/>", from, to);
      }
      text_ += "</connection>\n";
    }
    text_ += "</junction>\n";
  }

  void lose(const char* what, std::size_t count) {
    if (count > 0) file_.lost.emplace_back(what, count);
  }

  void count_losses() {
    lose("lanes that no road can hold", plan_.left_out.size());
    lose("links of lanes that turn back at once, or have no width there", network_.lost_links);
    lose("areas", road_map_.areas().size());
    lose("regulations", road_map_.regulations().size());
    lose("signals near no road", furniture_.lost_signals);
    lose("stop lines near no road", furniture_.lost_stop_lines);
    lose("objects near no road", furniture_.lost_objects);
    lose("ids of roads, which are no whole numbers", lost_ids());
    const bool has_place = options_.minor >= 5 || options_.offset_in_crs == CrsOffset{};
    lose("place of the coordinates in their system, which a header has from 1.5 on",
         has_place ? 0 : 1);
    lose("users of lanes", losses_.access);
    lose("directions of lanes", losses_.direction);
    for (const std::string& lane : plan_.left_out) {
      file_.notes.push_back(fmt::format("left out is lane {}", lane));
    }
  }

  std::size_t lost_ids() const {
    std::set<std::string_view> ids;
    for (const RoadPart& part : network_.parts) ids.insert(part.id);
    std::set<RoadId> lost;
    for (const PlannedRoad& road : plan_.roads) {
      if (road.source && !ids.contains(road_map_.road(*road.source).source_id)) {
        lost.insert(*road.source);
      }
    }
    return lost.size();
  }

  const RoadMap& road_map_;
  const OpenDriveOptions& options_;
  RoadPlan plan_;
  std::vector<RoadShape> shapes_;
  RoadNetwork network_;
  FurnitureText furniture_;
  LaneLosses losses_;
  OpenDriveFile file_;
  std::string text_;
};

struct UnwrittenCounter : pugi::xml_tree_walker {
  bool for_each(pugi::xml_node& node) override {
    static const std::set<std::string, std::less<>> unwritten{
        "road/type",         "lane/material",    "lane/rule",           "objects/bridge",
        "objects/tunnel",    "object/material",  "object/parkingSpace", "objects/objectReference",
        "signal/dependency", "signal/reference", "junction/priority",   "junction/controller"};
    const std::string name = fmt::format("{}/{}", node.parent().name(), node.name());
    if (unwritten.contains(name)) ++counts[name];
    if (name == "controller/control" && *node.attribute("type").value() != 0) {
      ++counts["types of controls"];
    }
    return true;
  }

  std::map<std::string, std::size_t> counts;
};

}  // namespace

OpenDriveFile write_open_drive(const RoadMap& road_map, const OpenDriveOptions& options) {
  if (options.minor < 4 || options.minor > 8) {
    throw std::invalid_argument(
        fmt::format("write_open_drive: the revision is 1.4 to 1.8, got 1.{}", options.minor));
  }
  return FileWriter(road_map, options).write();
}

std::vector<std::pair<std::string, std::size_t>> unwritten_elements(const std::string& source) {
  const XmlDocument xml(source, "source");
  UnwrittenCounter counter;
  xml.root().traverse(counter);
  return {counter.counts.begin(), counter.counts.end()};
}

}  // namespace roadbed::map::opendrive
