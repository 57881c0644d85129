#include "roadbed/map/lanelet2/build_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <iterator>
#include <utility>

#include "roadbed/map/elements/lane_lines.h"
#include "roadbed/map/files/in_threads.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/lanelet2/centreline.h"
#include "roadbed/map/lanelet2/traffic_rules.h"

namespace roadbed::map::lanelet2 {
namespace {

// The lanes of a run of relations, counted from 0, and what there is to say of them.
struct LaneRun {
  std::vector<Lane> lanes;
  std::vector<std::size_t> folded;  // of them
  std::vector<Border> left, right;
  std::vector<std::uint32_t> relations;
  std::vector<std::uint32_t> ways;  // that they use
  std::vector<ImportDiagnostic> remarks;
};

// Of points that the lanes of a map may have; runs out for all of them.
class PointBudget {
 public:
  explicit PointBudget(const Document& document)
      : file_(document.name), left_(1'500'000 + static_cast<std::int64_t>(document.text.size())) {}

  void spend(std::size_t points) {
    if ((left_ -= static_cast<std::int64_t>(points)) >= 0) return;
    throw InputError({.file = file_,
                      .found = "its lanelets repeat more points than a map of this size can hold",
                      .remedy = "check whether many lanelets share one long border"});
  }

 private:
  const std::string& file_;
  std::atomic<std::int64_t> left_;
};

class LaneBuilder {
 public:
  LaneBuilder(const Document& document, PointBudget& budget)
      : document_(document), budget_(budget) {}

  LaneRun build(std::size_t from, std::size_t to) {
    built_.lanes.reserve(to - from);
    for (std::size_t i = from; i < to; ++i) {
      const Relation& relation = document_.relations[i];
      if (relation.type == "lanelet" &&
          document_.relation_index.find_near(relation.id, near_lanelet_) == i) {
        add(static_cast<std::uint32_t>(i));
      }
    }
    return std::move(built_);
  }

 private:
  ImportDiagnostic& fault(const Relation& relation, const char* rule, std::string message) {
    return built_.remarks.emplace_back(document_.fault_at(relation.at, rule, std::move(message)));
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
      way = document_.way_index.find_near(member.id, near_way_);
      is_missing = is_missing || !way;
    }
    if (count == 1 && way && document_.ways[*way].nodes.size() >= 2) return way;
    std::string reason = fmt::format("{} ways have the role {}, it needs one", count, role);
    if (count == 1 && !way) reason = fmt::format("its {} way is not in the file", role);
    if (count == 1 && way) reason = fmt::format("its {} way has fewer than 2 points", role);
    fault(relation, "import.lanelet-border", reason + "; " + consequence(role)).in_text =
        count == 0 || (count == 1 && is_missing);
    return {};
  }

  static std::string consequence(std::string_view role) {
    return role == "centerline" ? "the line between its borders is taken"
                                : "the lanelet is left out";
  }

  Line3 points_of(const Border& border) {
    const Way& way = document_.ways[border.way];
    budget_.spend(way.nodes.size());
    Line3 points = document_.points(way);
    if (border.reversed) std::reverse(points.begin(), points.end());
    return points;
  }

  std::optional<Centreline> explicit_centreline(const Relation& relation, const Line3& left,
                                                const Line3& right) {
    const bool has_one = std::any_of(relation.members.begin(), relation.members.end(),
                                     [](const Member& m) { return m.role == "centerline"; });
    if (!has_one) return {};
    const auto way = only_way(relation, "centerline");
    if (!way) return {};
    built_.ways.push_back(*way);
    Line3 centre = points_of({*way, false});
    const Eigen::Vector3d start = 0.5 * (left.front() + right.front());
    if ((centre.back() - start).squaredNorm() < (centre.front() - start).squaredNorm()) {
      std::reverse(centre.begin(), centre.end());
      fault(relation, "import.centreline-reversed",
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
      fault(relation, "import.lanelet-length", "has no length and is left out");
      return;
    }
    lane.centre.station_m = lane.centre.in_map.stations_m();
    lane.left = lane_line(left, std::move(centre->left_station_m));
    lane.right = lane_line(right, std::move(centre->right_station_m));
    if (lay_ring(lane)) built_.folded.push_back(built_.lanes.size());
    add_marks(left_border, lane.left_marks);
    add_marks(right_border, lane.right_marks);
    built_.ways.insert(built_.ways.end(), {*left_way, *right_way});
    built_.left.push_back(left_border);
    built_.right.push_back(right_border);
    built_.relations.push_back(index);
    built_.lanes.push_back(std::move(lane));
  }

  Lane described(const Relation& relation) const {
    Lane lane;
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

  const Document& document_;
  PointBudget& budget_;
  LaneRun built_;
  std::size_t near_lanelet_ = 0, near_way_ = 0;  // where the last ones were found
};

// One after the other, so that memory is taken for one lane at a time.
void unfold_lanes(std::vector<LaneRun>& runs, const Document& document) {
  geometry::WorkBudget budget(most_folding_steps(document.text.size()));
  for (LaneRun& run : runs) {
    for (const std::size_t folded : run.folded) {
      Lane& lane = run.lanes[folded];
      if (!budget.spend(kStepsPerFoldedPoint * lane.polygon.size())) {
        throw InputError({.file = document.name,
                          .element = "lanelet " + lane.name,
                          .found =
                              "it and those before it fold over themselves at more points than "
                              "a map of this size may",
                          .remedy = "check whether their borders run to and fro"});
      }
      unfold_ring(lane);
    }
  }
}

template <typename T>
void append(std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), std::move_iterator(from.begin()), std::move_iterator(from.end()));
  from = {};  // while it is in the cache
}

// Numbers the lanes of all runs, one run behind the other.
BuiltLanes joined(std::vector<LaneRun> runs, Document& document) {
  BuiltLanes built;
  built.lane_of_relation.resize(document.relations.size());
  std::size_t lanes = 0;
  for (const LaneRun& run : runs) lanes += run.lanes.size();
  built.lanes.reserve(lanes);
  for (LaneRun& run : runs) {
    append(run.lanes, built.lanes);
    append(run.left, built.left);
    append(run.right, built.right);
    append(run.relations, built.relations);
    append(run.remarks, document.remarks);
    for (const std::uint32_t way : run.ways) document.ways[way].used = true;
  }
  for (std::uint32_t i = 0; i < built.lanes.size(); ++i) {
    built.lanes[i].id = LaneId{i};
    built.lane_of_relation[built.relations[i]] = LaneId{i};
  }
  return built;
}

[[noreturn]] void refuse(const Document& document) {
  const auto lanelets = std::ranges::count(document.relations, "lanelet", &Relation::type);
  throw InputError(
      {.file = document.name,
       .found = lanelets == 0
                    ? "no lanelet"
                    : fmt::format("none of its {} lanelets has two usable borders", lanelets),
       .needed = "relations with type=lanelet and a left and a right way",
       .remedy = "give a Lanelet2 map; plain OpenStreetMap data has no lanes"});
}

}  // namespace

BuiltLanes build_lanes(Document& document, int threads) {
  PointBudget budget(document);
  constexpr std::size_t kRun = 1024;
  const std::size_t relations = document.relations.size();
  std::vector<LaneRun> runs((relations + kRun - 1) / kRun);
  in_threads(runs.size(), threads, [&](std::size_t i) {
    runs[i] = LaneBuilder(document, budget).build(i * kRun, std::min(relations, (i + 1) * kRun));
  });
  unfold_lanes(runs, document);
  BuiltLanes built = joined(std::move(runs), document);
  if (built.lanes.empty()) refuse(document);
  return built;
}

std::uint32_t first_node(const Document& document, const Border& border) {
  const auto& nodes = document.ways[border.way].nodes;
  return border.reversed ? nodes.back() : nodes.front();
}

std::uint32_t last_node(const Document& document, const Border& border) {
  return first_node(document, {border.way, !border.reversed});
}

}  // namespace roadbed::map::lanelet2
