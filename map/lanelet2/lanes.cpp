#include "roadbed/map/lanelet2/build_map.h"

#include <fmt/format.h>

#include <algorithm>

#include "roadbed/map/elements/lane_lines.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/lanelet2/centreline.h"
#include "roadbed/map/lanelet2/traffic_rules.h"

namespace roadbed::map::lanelet2 {
namespace {

class LaneBuilder {
 public:
  explicit LaneBuilder(Document& document)
      : document_(document), points_left_(1'500'000 + document.text.size()) {
    built_.lane_of_relation.resize(document.relations.size());
  }

  BuiltLanes build() {
    built_.lanes.reserve(static_cast<std::size_t>(
        std::count_if(document_.relations.begin(), document_.relations.end(),
                      [](const Relation& relation) { return relation.type == "lanelet"; })));
    for (std::uint32_t i = 0; i < document_.relations.size(); ++i) {
      const Relation& relation = document_.relations[i];
      if (relation.type != "lanelet") continue;
      ++lanelets_;
      if (document_.relation_index.find(relation.id) == i) add(i);
    }
    if (built_.lanes.empty()) refuse();
    return std::move(built_);
  }

 private:
  [[noreturn]] void refuse() const {
    throw InputError(
        {.file = document_.name,
         .found = lanelets_ == 0
                      ? "no lanelet"
                      : fmt::format("none of its {} lanelets has two usable borders", lanelets_),
         .needed = "relations with type=lanelet and a left and a right way",
         .remedy = "give a Lanelet2 map; plain OpenStreetMap data has no lanes"});
  }

  // The only member of that role that is a way of two points or more; remarks why there is none.
  std::optional<std::uint32_t> only_way(const Relation& relation, std::string_view role) {
    std::optional<std::uint32_t> way;
    std::size_t count = 0;
    bool is_missing = false;
    for (const Member& member : relation.members) {
      if (member.role != role) continue;
      ++count;
      if (member.kind != MemberKind::way) continue;
      way = document_.way_index.find(member.id);
      is_missing = is_missing || !way;
    }
    if (count == 1 && way && document_.ways[*way].nodes.size() >= 2) return way;
    std::string reason = fmt::format("{} ways have the role {}, it needs one", count, role);
    if (count == 1 && !way) reason = fmt::format("its {} way is not in the file", role);
    if (count == 1 && way) reason = fmt::format("its {} way has fewer than 2 points", role);
    document_.fault(relation.at, "import.lanelet-border", reason + "; " + consequence(role))
        .in_text = count == 0 || (count == 1 && is_missing);
    return {};
  }

  static std::string consequence(std::string_view role) {
    return role == "centerline" ? "the line between its borders is taken"
                                : "the lanelet is left out";
  }

  Line3 points_of(const Border& border) {
    const Way& way = document_.ways[border.way];
    spend(way.nodes.size());
    Line3 points = document_.points(way);
    if (border.reversed) std::reverse(points.begin(), points.end());
    return points;
  }

  void spend(std::size_t points) {
    if (points > points_left_) {
      throw InputError({.file = document_.name,
                        .found = "its lanelets repeat more points than a map of this size can hold",
                        .remedy = "check whether many lanelets share one long border"});
    }
    points_left_ -= points;
  }

  std::optional<Centreline> explicit_centreline(const Relation& relation, const Line3& left,
                                                const Line3& right) {
    const bool has_one = std::any_of(relation.members.begin(), relation.members.end(),
                                     [](const Member& m) { return m.role == "centerline"; });
    if (!has_one) return {};
    const auto way = only_way(relation, "centerline");
    if (!way) return {};
    document_.ways[*way].used = true;
    Line3 centre = points_of({*way, false});
    const Eigen::Vector3d start = 0.5 * (left.front() + right.front());
    if ((centre.back() - start).squaredNorm() < (centre.front() - start).squaredNorm()) {
      std::reverse(centre.begin(), centre.end());
      document_.fault(relation.at, "import.centreline-reversed",
                      "its centreline runs against its borders and is taken the other way round");
    }
    return centreline_along(std::move(centre), left, right);
  }

  void add(std::uint32_t index) {
    const Relation& relation = document_.relations[index];
    const auto left_way = only_way(relation, "left");
    const auto right_way = only_way(relation, "right");
    if (!left_way || !right_way) return;
    Border left_border{*left_way, false}, right_border{*right_way, false};
    Line3 left = points_of(left_border), right = points_of(right_border);
    const Alignment alignment = align(left, right);
    left_border.reversed = alignment.left_reversed;
    right_border.reversed = alignment.right_reversed;
    if (left_border.reversed) std::reverse(left.begin(), left.end());
    if (right_border.reversed) std::reverse(right.begin(), right.end());
    auto centre = explicit_centreline(relation, left, right);
    if (!centre) centre = centreline_between(left, right);

    Lane lane = described(relation);
    lane.centre = lane_line(centre->points, {});
    if (lane.length_m() <= 0.0) {
      document_.fault(relation.at, "import.lanelet-length", "has no length and is left out");
      return;
    }
    lane.centre.station_m = lane.centre.in_map.stations_m();
    lane.left = lane_line(left, std::move(centre->left_station_m));
    lane.right = lane_line(right, std::move(centre->right_station_m));
    lane.polygon = lane_ring(lane.left.in_map, lane.right.in_map);
    add_marks(left_border, lane.left_marks);
    add_marks(right_border, lane.right_marks);
    for (const std::uint32_t way : {*left_way, *right_way}) document_.ways[way].used = true;
    built_.left.push_back(left_border);
    built_.right.push_back(right_border);
    built_.relations.push_back(index);
    built_.lane_of_relation[index] = lane.id;
    built_.lanes.push_back(std::move(lane));
  }

  Lane described(const Relation& relation) const {
    Lane lane;
    lane.id = LaneId{static_cast<std::uint32_t>(built_.lanes.size())};
    lane.origin.source_id = std::to_string(relation.id);
    lane.name = lane.origin.source_id;
    lane.attributes = attributes_of(relation.tags);
    lane.participants = participants(relation.tags);
    lane.type = lane_type(relation.subtype, lane.participants);
    lane.one_way = is_one_way(relation.tags, lane.participants);
    if (const auto limit = tagged_speed_mps(relation.tags, lane.participants)) {
      lane.speed_limits = {{0.0, limit}};
    }
    return lane;
  }

  void add_marks(const Border& border, std::vector<BorderMark>& marks) const {
    const auto mark = border_mark(document_.ways[border.way].tags, border.reversed);
    if (mark) marks.push_back(*mark);
  }

  Document& document_;
  std::size_t points_left_, lanelets_ = 0;
  BuiltLanes built_;
};

}  // namespace

BuiltLanes build_lanes(Document& document) { return LaneBuilder(document).build(); }

std::uint32_t first_node(const Document& document, const Border& border) {
  const auto& nodes = document.ways[border.way].nodes;
  return border.reversed ? nodes.back() : nodes.front();
}

std::uint32_t last_node(const Document& document, const Border& border) {
  return first_node(document, {border.way, !border.reversed});
}

}  // namespace roadbed::map::lanelet2
