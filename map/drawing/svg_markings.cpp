#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "roadbed/map/drawing/svg_drawing.h"

namespace roadbed::map::inline drawing::svg {
namespace {

using Eigen::Vector2d;

/// How a line is painted; lines of one look become one path.
struct Look {
  std::string_view colour = kWhite;
  bool dashed = false;
  bool twice = false;  ///< a double line
  auto operator<=>(const Look&) const = default;
};

using Paint = std::map<Look, std::string>;

/// The line between two stations, with both ends.
std::vector<Vector2d> part(const LaneLine& line, double from_s_m, double to_s_m) {
  std::vector<Vector2d> points{Lane::point_at(line, from_s_m)};
  for (std::size_t i = 0; i < line.station_m.size(); ++i) {
    if (line.station_m[i] > from_s_m && line.station_m[i] < to_s_m) {
      points.push_back(line.in_map.points()[i]);
    }
  }
  points.push_back(Lane::point_at(line, to_s_m));
  return points;
}

bool is_painted(MarkType type) {
  return type != MarkType::none && type != MarkType::curb && type != MarkType::grass &&
         type != MarkType::edge;
}

Look look_of(const BorderMark& mark) {
  Look look;
  if (mark.color == "yellow" || mark.color == "orange") look.colour = kYellow;
  look.dashed = mark.type == MarkType::broken || mark.type == MarkType::broken_broken ||
                mark.type == MarkType::botts_dots;
  look.twice = mark.type == MarkType::solid_solid || mark.type == MarkType::solid_broken ||
               mark.type == MarkType::broken_solid || mark.type == MarkType::broken_broken;
  return look;
}

void add_marks(const Drawing& drawing, const Lane& lane, bool is_left, Paint& paint) {
  const std::vector<BorderMark>& marks = is_left ? lane.left_marks : lane.right_marks;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const double to_s_m = i + 1 < marks.size() ? marks[i + 1].from_s_m : lane.length_m();
    if (!is_painted(marks[i].type) || to_s_m <= marks[i].from_s_m) continue;
    paint[look_of(marks[i])] +=
        drawing.canvas.line(part(is_left ? lane.left : lane.right, marks[i].from_s_m, to_s_m));
  }
}

bool is_drivable_neighbour(const RoadMap& road_map, const std::optional<Neighbour>& neighbour) {
  return neighbour && is_drivable(road_map.lane(neighbour->lane).type);
}

/// Where the source knows no markings: what the rules of the lanes on both sides amount to.
void add_likely_line(const Drawing& drawing, const Lane& lane, bool is_left, Paint& paint) {
  const LaneLinks& links = drawing.road_map.graph().of(lane.id);
  const std::optional<Neighbour>& beside = is_left ? links.left : links.right;
  Look look;
  if (is_drivable_neighbour(drawing.road_map, beside)) {
    if (!beside->same_direction) look.colour = kYellow;
    look.dashed = beside->same_direction && beside->change_allowed();
  }
  paint[look] += drawing.canvas.line((is_left ? lane.left : lane.right).in_map.points());
}

/// A border that two drivable lanes share is painted from one of them: the right one's left, or,
/// between opposite lanes, the one that comes first.
bool paints(const Drawing& drawing, const Lane& lane, bool is_left) {
  const LaneLinks& links = drawing.road_map.graph().of(lane.id);
  const std::optional<Neighbour>& beside = is_left ? links.left : links.right;
  if (!is_drivable_neighbour(drawing.road_map, beside)) return true;
  return beside->same_direction ? is_left : lane.id < beside->lane;
}

void add_border(const Drawing& drawing, const Lane& lane, bool is_left, Paint& paint) {
  if (!paints(drawing, lane, is_left)) return;
  const std::vector<BorderMark>& marks = is_left ? lane.left_marks : lane.right_marks;
  if (!marks.empty()) {
    add_marks(drawing, lane, is_left, paint);
  } else if (!lane.junction) {
    add_likely_line(drawing, lane, is_left, paint);
  }
}

/// Arrows along the centreline, evenly spaced, none where the lane is too short for one.
std::string direction_arrows(const Drawing& drawing, const Lane& lane) {
  const double spacing_m = drawing.sheet.stroke_m(30.0, 70.0);
  const double h = drawing.sheet.stroke_m(1.6, 3.4), w = 0.42 * h, stem = 0.12 * h;
  const int count = static_cast<int>(std::lround(lane.length_m() / spacing_m));
  std::string data;
  for (int i = 0; i < count; ++i) {
    const geometry::Pose2 map_from_arrow = lane.pose_at((i + 0.5) * lane.length_m() / count);
    geometry::Ring ring;
    for (const auto& [x, y] :
         {std::pair(h, 0.0), std::pair(0.1 * h, w), std::pair(0.1 * h, stem), std::pair(-h, stem),
          std::pair(-h, -stem), std::pair(0.1 * h, -stem), std::pair(0.1 * h, -w)}) {
      ring.push_back(map_from_arrow * Vector2d(x, y));
    }
    data += drawing.canvas.ring(ring);
  }
  return data;
}

}  // namespace

void draw_markings(Drawing& drawing, const std::vector<LaneId>& lanes) {
  Paint paint;
  for (const LaneId id : lanes) {
    const Lane& lane = drawing.road_map.lane(id);
    if (!is_drivable(lane.type)) continue;
    add_border(drawing, lane, true, paint);
    add_border(drawing, lane, false, paint);
  }
  const double width_m = drawing.sheet.stroke_m(0.15, 0.4);
  const double dash_m = drawing.sheet.stroke_m(3.0, 4.0);
  const std::string dashes =
      fmt::format(R"(stroke-dasharray="{:.3f} {:.3f}")", dash_m, 1.5 * dash_m);
  for (const auto& [look, data] : paint) {
    const std::string more = look.dashed ? dashes : "";
    drawing.canvas.add_path(data, stroke(look.colour, (look.twice ? 3.0 : 1.0) * width_m, more));
    if (look.twice) drawing.canvas.add_path(data, stroke(kAsphalt, width_m));
  }
}

void draw_directions(Drawing& drawing, const std::vector<LaneId>& lanes) {
  std::string ways, arrows;
  for (const LaneId id : lanes) {
    const Lane& lane = drawing.road_map.lane(id);
    if (!is_drivable(lane.type)) continue;
    if (lane.junction) ways += drawing.canvas.line(lane.centre.in_map.points());
    if (!lane.junction) arrows += direction_arrows(drawing, lane);
  }
  drawing.canvas.add_path(
      ways, stroke(kPath, drawing.sheet.stroke_m(0.12, 0.35), R"(stroke-opacity="0.6")"));
  drawing.canvas.add_path(arrows, fmt::format(R"(fill="{}")", kArrow));
}

}  // namespace roadbed::map::drawing::svg
