#include "roadbed/map/argoverse/lane_segments.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "roadbed/map/argoverse/words.h"
#include "roadbed/map/elements/lane_lines.h"
#include "roadbed/map/elements/outside_links.h"
#include "roadbed/map/elements/side.h"

namespace roadbed::map::argoverse {
namespace {

constexpr double kJoined_m = 1.0;  // borders further apart are not crossed

void set_use(const Entry& entry, Lane& lane, std::vector<ImportDiagnostic>& remarks) {
  const std::string word = entry.word("lane_type");
  const auto use = lane_use(word);
  lane.type = use ? use->type : LaneType::other;
  if (use) lane.participants = use->participants;
  if (!use) {
    remarks.push_back({"import.lane-type", true, entry.element, 0,
                       fmt::format("its lane_type is \"{}\", known are VEHICLE, BIKE and BUS; "
                                   "nobody drives there",
                                   word)});
  }
  lane.attributes.emplace_back("lane_type", word);
  const char* inside = entry.truth("is_intersection") ? "true" : "false";
  lane.attributes.emplace_back("is_intersection", inside);
}

void set_marks(const Entry& entry, Side side, const char* key, Lane& lane) {
  const auto mark = border_mark(entry.word(key), side);
  if (mark) (side == Side::left ? lane.left_marks : lane.right_marks) = {*mark};
}

/// Whether lanes beside each other are driven in the same direction: their chords are.
bool is_same_direction(const Lane& a, const Lane& b) {
  const auto chord = [](const Lane& lane) -> Eigen::Vector2d {
    return lane.centre.in_map.points().back() - lane.centre.in_map.points().front();
  };
  return chord(a).dot(chord(b)) >= 0.0;
}

}  // namespace

void LaneSegments::add(const Entry& entry, Frame& frame, std::vector<ImportDiagnostic>& remarks) {
  const auto leave_out = [&](const char* rule, const std::string& why) {
    remarks.push_back({rule, true, entry.element, 0, why + "; it is left out"});
  };
  const std::int64_t id = entry.id("id");
  Line3 left = entry.line("left_lane_boundary"), right = entry.line("right_lane_boundary");
  frame.to_map(left);
  frame.to_map(right);
  if (lane_of_id_.contains(id)) return leave_out("import.lane-id", "another one has its id");
  if (left.size() < 2 || right.size() < 2) {
    return leave_out(
        "import.short-border",
        fmt::format("its borders have {} and {} points, each needs 2", left.size(), right.size()));
  }
  Lane lane;
  lane.id = LaneId{static_cast<std::uint32_t>(lanes_.size())};
  lane.name = lane.origin.source_id = std::to_string(id);
  set_borders(left, right, lane);
  if (!(lane.length_m() > 0.0)) return leave_out("import.empty-lane", "it has no length");
  set_use(entry, lane, remarks);
  set_marks(entry, Side::left, "left_lane_mark_type", lane);
  set_marks(entry, Side::right, "right_lane_mark_type", lane);
  if (has_swapped_borders(lane)) {
    remarks.push_back({"import.swapped-borders", true, entry.element, 0,
                       "its left border lies to the right of its right one; swap them"});
  }
  lane_of_id_.emplace(id, lane.id);
  ids_.push_back(id);
  is_intersection_.push_back(entry.truth("is_intersection"));
  named_.push_back({entry.ids("successors"), entry.ids("predecessors"),
                    entry.optional_id("left_neighbor_id"), entry.optional_id("right_neighbor_id")});
  lanes_.push_back(std::move(lane));
}

std::optional<LaneId> LaneSegments::find(std::int64_t id) const {
  const auto found = lane_of_id_.find(id);
  if (found == lane_of_id_.end()) return {};
  return found->second;
}

std::vector<LaneLinks> LaneSegments::links(std::vector<ImportDiagnostic>& remarks) {
  std::vector<LaneLinks> links(lanes_.size());
  std::size_t outside = 0;
  const auto inside = [&](std::int64_t id) {
    const std::optional<LaneId> lane = find(id);
    outside += lane ? 0 : 1;
    return lane;
  };
  const auto keep = [](Lane& lane, std::string_view key, std::int64_t id) {
    lane.attributes.emplace_back(key, std::to_string(id));
  };
  const auto put_beside = [&](const Lane& lane, Side side, std::optional<std::int64_t> id) {
    const auto found = id ? inside(*id) : std::nullopt;
    if (!found || *found == lane.id) return;
    const Lane& other = lanes_[found->index];
    const bool same = is_same_direction(lane, other);
    std::vector<StationRange> windows;
    if (may_change(lane, side, other, same)) {
      windows = joined_ranges(lane, side, other, same, kJoined_m);
    }
    neighbour(links[lane.id.index], side) = Neighbour{other.id, same, std::move(windows)};
  };
  for (Lane& lane : lanes_) {
    const NamedLinks& named = named_[lane.id.index];
    for (const std::int64_t id : named.successors) {
      const auto to = inside(id);
      if (!to) keep(lane, kSuccessorsOutside, id);
      if (!to) continue;
      links[lane.id.index].successors.push_back(*to);
      links[to->index].predecessors.push_back(lane.id);
    }
    put_beside(lane, Side::left, named.left);
    put_beside(lane, Side::right, named.right);
  }
  for (LaneLinks& of_lane : links) {
    for (auto* list : {&of_lane.successors, &of_lane.predecessors}) {
      std::sort(list->begin(), list->end());
      list->erase(std::unique(list->begin(), list->end()), list->end());
    }
  }
  for (Lane& lane : lanes_) {
    for (const std::int64_t id : named_[lane.id.index].predecessors) {
      const auto from = inside(id);
      if (!from) keep(lane, kPredecessorsOutside, id);
      if (!from || std::ranges::binary_search(links[lane.id.index].predecessors, *from)) continue;
      remarks.push_back({"import.one-sided-link", true, "lane segment " + lane.name, 0,
                         fmt::format("names {} as its predecessor, which does not name it as its "
                                     "successor; the link is left out",
                                     id)});
    }
  }
  if (outside > 0) {
    remarks.push_back({"import.outside", false, "file", 0,
                       fmt::format("{} links lead to lane segments outside the file", outside)});
  }
  return links;
}

}  // namespace roadbed::map::argoverse
