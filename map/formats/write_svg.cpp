#include "roadbed/map/formats/write_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "roadbed/map/formats/svg_canvas.h"
#include "roadbed/map/surface.h"

namespace roadbed::map {
namespace {

using Eigen::Vector2d;

constexpr const char* kPaper = "#f4f2ec";
constexpr const char* kAsphalt = "#4d535c";
constexpr const char* kJunction = "#77695c";
constexpr const char* kMarking = "#ffffff";
constexpr const char* kOpposite = "#f3c14b";
constexpr const char* kDirection = "#8fd3f4";
constexpr const char* kInk = "#2b2f36";

/// What surrounds the carriageway, by lane type; empty: not drawn, or drawn as carriageway.
std::string_view ground_colour(LaneType type) {
  switch (type) {
    case LaneType::sidewalk:
      return "#dcd6ca";
    case LaneType::shoulder:
    case LaneType::border:
    case LaneType::curb:
      return "#bfbab0";
    case LaneType::parking:
    case LaneType::stop:
      return "#8f98a6";
    case LaneType::biking:
      return "#c98b7d";
    case LaneType::median:
      return "#c5d3ae";
    case LaneType::bus:
    case LaneType::taxi:
      return "#6d5560";
    case LaneType::tram:
    case LaneType::rail:
      return "#a39a8c";
    case LaneType::restricted:
    case LaneType::roadworks:
    case LaneType::other:
      return "#cbb9a8";
    default:
      return {};
  }
}

struct Extent {
  Vector2d low{0, 0}, high{0, 0};
  Vector2d size() const { return high - low; }
};

Extent extent_of(const RoadMap& road_map) {
  Extent extent;
  bool is_first = true;
  for (const Lane& lane : road_map.lanes()) {
    for (const LaneLine* line : {&lane.left, &lane.right}) {
      for (const Vector2d& point : line->in_map.points()) {
        extent.low = is_first ? point : extent.low.cwiseMin(point).eval();
        extent.high = is_first ? point : extent.high.cwiseMax(point).eval();
        is_first = false;
      }
    }
  }
  return extent;
}

/// Sizes of a picture [m], all from the width of a pixel.
struct Sheet {
  explicit Sheet(const Extent& extent, double longer_side_px)
      : longer_m(std::max(extent.size().maxCoeff(), 1.0) * 1.06), px_m(longer_m / longer_side_px) {
    const double margin_m = 0.03 * longer_m;
    const double least_m = 0.45 * longer_m;  // room for the caption below narrow maps
    const double width_m = std::max(extent.size().x() + 2.0 * margin_m, least_m);
    const Vector2d middle = 0.5 * (extent.low + extent.high);
    upper_left_in_map = {middle.x() - 0.5 * width_m, extent.high.y() + margin_m};
    size_m = {width_m, extent.size().y() + 2.0 * margin_m};
    caption_m = 70.0 * px_m;
  }

  /// At least so many metres, and at least so many pixels.
  double stroke_m(double least_m, double least_px) const {
    return std::max(least_m, least_px * px_m);
  }

  double longer_m;
  double px_m;
  Vector2d upper_left_in_map, size_m;
  double caption_m;
};

/// The picture while it is drawn.
struct Drawing {
  const RoadMap& road_map;
  const Sheet sheet;
  SvgCanvas canvas;
};

void draw_ground(Drawing& drawing) {
  std::map<LaneType, std::string> data;
  for (const Lane& lane : drawing.road_map.lanes()) {
    if (!ground_colour(lane.type).empty()) data[lane.type] += drawing.canvas.ring(lane.polygon);
  }
  for (const auto& [type, path] : data) {
    const auto colour = ground_colour(type);
    drawing.canvas.add_path(path, fmt::format(R"(fill="{}" stroke="{}" stroke-width="{:.3f}")",
                                              colour, colour, drawing.sheet.stroke_m(0.05, 0.3)));
  }
}

void draw_carriageway(Drawing& drawing) {
  drawing.canvas.add_path(
      drawing.canvas.region(drivable_surface(drawing.road_map)),
      fmt::format(R"(fill="{}" fill-rule="evenodd" stroke="{}" stroke-width="{:.3f}")", kAsphalt,
                  kInk, drawing.sheet.stroke_m(0.1, 0.5)));
  std::string junctions;
  for (const Junction& junction : drawing.road_map.junctions()) {
    junctions += drawing.canvas.region(junction_surface(drawing.road_map, junction.id));
  }
  drawing.canvas.add_path(junctions, fmt::format(R"(fill="{}" fill-rule="evenodd")", kJunction));
}

/// Markings by kind, gathered so that each kind is one path.
struct Markings {
  std::string solid, dashed, opposite;
};

bool is_drivable_neighbour(const RoadMap& road_map, const std::optional<Neighbour>& neighbour) {
  return neighbour && is_drivable(road_map.lane(neighbour->lane).type);
}

void add_markings(const Drawing& drawing, const Lane& lane, Markings& markings) {
  const LaneLinks& links = drawing.road_map.graph().of(lane.id);
  const std::string left = drawing.canvas.line(lane.left.in_map.points());
  const std::string right = drawing.canvas.line(lane.right.in_map.points());
  if (!is_drivable_neighbour(drawing.road_map, links.right)) {
    markings.solid += right;
  } else {
    (links.right->change_allowed() ? markings.dashed : markings.solid) += right;
  }
  if (!is_drivable_neighbour(drawing.road_map, links.left)) {
    markings.solid += left;
  } else if (!links.left->same_direction && lane.id < links.left->lane) {
    markings.opposite += left;  // once; a left neighbour of the same direction has drawn its right
  }
}

void draw_markings(Drawing& drawing) {
  Markings markings;
  for (const Lane& lane : drawing.road_map.lanes()) {
    if (is_drivable(lane.type) && !lane.junction) add_markings(drawing, lane, markings);
  }
  const auto stroke = [&](const char* colour) {
    return fmt::format(R"(fill="none" stroke="{}" stroke-width="{:.3f}")", colour,
                       drawing.sheet.stroke_m(0.15, 0.45));
  };
  const double dash_m = drawing.sheet.stroke_m(3.0, 5.0);
  drawing.canvas.add_path(markings.solid, stroke(kMarking));
  drawing.canvas.add_path(
      markings.dashed,
      stroke(kMarking) + fmt::format(R"( stroke-dasharray="{:.3f} {:.3f}")", dash_m, 1.5 * dash_m));
  drawing.canvas.add_path(markings.opposite, stroke(kOpposite));
}

/// Arrow heads along the centreline, evenly spaced, none where the lane is too short for one.
std::string direction_arrows(const Drawing& drawing, const Lane& lane) {
  const double spacing_m = drawing.sheet.stroke_m(18.0, 45.0);
  const double size_m = drawing.sheet.stroke_m(0.9, 2.6);
  const int count = static_cast<int>(std::lround(lane.length_m() / spacing_m));
  std::string data;
  for (int i = 0; i < count; ++i) {
    const geometry::Pose2 map_from_arrow = lane.pose_at((i + 0.5) * lane.length_m() / count);
    data += drawing.canvas.ring({map_from_arrow * Vector2d(size_m, 0.0),
                                 map_from_arrow * Vector2d(-size_m, 0.6 * size_m),
                                 map_from_arrow * Vector2d(-0.5 * size_m, 0.0),
                                 map_from_arrow * Vector2d(-size_m, -0.6 * size_m)});
  }
  return data;
}

void draw_directions(Drawing& drawing) {
  std::string centrelines, arrows;
  for (const Lane& lane : drawing.road_map.lanes()) {
    if (!is_drivable(lane.type)) continue;
    centrelines += drawing.canvas.line(lane.centre.in_map.points());
    arrows += direction_arrows(drawing, lane);
  }
  drawing.canvas.add_path(
      centrelines,
      fmt::format(R"(fill="none" stroke="{}" stroke-opacity="0.55" stroke-width="{:.3f}")",
                  kDirection, drawing.sheet.stroke_m(0.08, 0.35)));
  drawing.canvas.add_path(arrows, fmt::format(R"(fill="{}")", kDirection));
}

/// A light as a dark box with three lamps, a sign as a disc; tail to the ground it stands on.
std::string signal_symbol(const Drawing& drawing, const Signal& signal) {
  const Vector2d at = drawing.canvas.to_picture(signal.in_map);
  const double r = drawing.sheet.stroke_m(0.45, 1.5);
  if (!signal.dynamic) {
    return fmt::format(
        R"(<circle cx="{:.2f}" cy="{:.2f}" r="{:.2f}" fill="#ffffff" stroke="#c8372d" )"
        R"(stroke-width="{:.2f}"><title>{}</title></circle>)",
        at.x(), at.y(), 1.3 * r, 0.5 * r, xml_text(signal.source_id + " " + signal.name));
  }
  std::string lamps;
  constexpr const char* kLamps[] = {"#e5483d", "#f3c14b", "#55c26a"};
  for (int i = 0; i < 3; ++i) {
    lamps += fmt::format(R"(<circle cx="{:.2f}" cy="{:.2f}" r="{:.2f}" fill="{}"/>)", at.x(),
                         at.y() + (i - 1) * 1.9 * r, 0.8 * r, kLamps[i]);
  }
  return fmt::format(
      R"(<g><title>{}</title><rect x="{:.2f}" y="{:.2f}" width="{:.2f}" height="{:.2f}" )"
      R"(rx="{:.2f}" fill="{}"/>{}</g>)",
      xml_text(signal.source_id + " " + signal.name), at.x() - 1.3 * r, at.y() - 3.2 * r, 2.6 * r,
      6.4 * r, 0.7 * r, kInk, lamps);
}

void draw_signals(Drawing& drawing) {
  for (const Signal& signal : drawing.road_map.signals()) {
    drawing.canvas.add(signal_symbol(drawing, signal));
  }
}

/// The largest of 1, 2, 5, 10, … metres that is no longer.
double round_length_m(double longest_m) {
  const double power = std::pow(10.0, std::floor(std::log10(longest_m)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= longest_m) return digit * power;
  }
  return power;
}

void draw_scale_bar(Drawing& drawing) {
  const double px = drawing.sheet.px_m;
  const double length_m = round_length_m(0.2 * drawing.sheet.size_m.x());
  const double right = drawing.sheet.size_m.x() - 24 * px, y = drawing.sheet.size_m.y() + 46 * px;
  drawing.canvas.add(
      fmt::format(R"(<path d="M{:.2f} {:.2f}v{:.2f}h{:.2f}v{:.2f}" fill="none" stroke="{}" )"
                  R"(stroke-width="{:.3f}"/>)",
                  right - length_m, y - 8 * px, 8 * px, length_m, -8 * px, kInk, 2 * px));
  drawing.canvas.add(fmt::format(
      R"(<text x="{:.2f}" y="{:.2f}" font-size="{:.3f}" text-anchor="middle">{} m</text>)",
      right - 0.5 * length_m, y - 6 * px, 16 * px, length_m));
}

std::string counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

void draw_caption(Drawing& drawing) {
  const RoadMap& road_map = drawing.road_map;
  const double px = drawing.sheet.px_m, top = drawing.sheet.size_m.y();
  const std::string crs = road_map.crs().empty() ? "coordinate system unknown" : road_map.crs();
  const auto text = [&](double y_px, double size_px, const std::string& words) {
    drawing.canvas.add(fmt::format(R"(<text x="{:.2f}" y="{:.2f}" font-size="{:.3f}">{}</text>)",
                                   24 * px, top + y_px * px, size_px * px, xml_text(words)));
  };
  text(26, 20,
       fmt::format("{} · {} · {} · {} · {}", road_map.format(),
                   counted(road_map.roads().size(), "road"),
                   counted(road_map.lanes().size(), "lane"),
                   counted(road_map.junctions().size(), "junction"),
                   counted(road_map.signals().size(), "signal")));
  text(50, 14, crs);
}

std::string document(const Drawing& drawing, double longer_side_px) {
  const Sheet& sheet = drawing.sheet;
  const Vector2d size_m(sheet.size_m.x(), sheet.size_m.y() + sheet.caption_m);
  const Vector2d corner = drawing.road_map.to_source(sheet.upper_left_in_map);
  const double px_per_m = longer_side_px / sheet.longer_m;
  return fmt::format(R"(<svg xmlns="http://www.w3.org/2000/svg" width="{:.0f}" height="{:.0f}" )"
                     R"(viewBox="0 0 {:.3f} {:.3f}" font-family="Helvetica, Arial, sans-serif" )"
                     R"(fill="{}" stroke-linejoin="round">)",
                     size_m.x() * px_per_m, size_m.y() * px_per_m, size_m.x(), size_m.y(), kInk) +
         fmt::format("\n<desc>metres; source x = {} + x, source y = {} - y</desc>\n", corner.x(),
                     corner.y()) +
         fmt::format("<rect width=\"{:.3f}\" height=\"{:.3f}\" fill=\"{}\"/>\n", size_m.x(),
                     size_m.y(), kPaper) +
         drawing.canvas.elements() + "</svg>\n";
}

}  // namespace

std::string write_svg(const RoadMap& road_map, const SvgOptions& options) {
  const Sheet sheet(extent_of(road_map), options.longer_side_px);
  Drawing drawing{road_map, sheet, SvgCanvas(sheet.upper_left_in_map, 0.05 * sheet.px_m)};
  draw_ground(drawing);
  draw_carriageway(drawing);
  draw_markings(drawing);
  draw_directions(drawing);
  draw_signals(drawing);
  draw_scale_bar(drawing);
  draw_caption(drawing);
  return document(drawing, options.longer_side_px);
}

}  // namespace roadbed::map
