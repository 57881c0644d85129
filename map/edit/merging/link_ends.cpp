#include "roadbed/map/edit/merging/link_ends.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "roadbed/map/edit/merging/lane_corners.h"
#include "roadbed/map/edit/merging/near_ends.h"
#include "roadbed/map/edit/plan_cut.h"
#include "roadbed/map/edit/road_cut.h"
#include "roadbed/map/edit/xml_edit.h"

namespace roadbed::map::inline edit::inline merging {
namespace {

constexpr double kSameDirectionRad = 0.1;

struct RoadEnd {
  pugi::xml_node road;
  bool at_start;
  std::size_t source;
  geometry::Pose2 outwards;  ///< heading away from the road

  std::string id() const { return road.attribute("id").value(); }
  const char* contact() const { return at_start ? "start" : "end"; }
  const char* link() const { return at_start ? "predecessor" : "successor"; }
  std::string called() const { return fmt::format("{} of road {}", contact(), id()); }
};

bool leads_somewhere(pugi::xml_node road, const char* link) {
  return road.child("link").child(link) || find_clip_memory(road).child("link").child(link);
}

std::vector<RoadEnd> free_ends(pugi::xml_node root,
                               const std::map<std::string, std::size_t>& sources) {
  std::vector<RoadEnd> ends;
  for (const auto road : root.children("road")) {
    const std::string_view junction = road.attribute("junction").value();
    const auto source = sources.find(road.attribute("id").value());
    if ((!junction.empty() && junction != "-1") || source == sources.end()) continue;
    for (const bool at_start : {true, false}) {
      if (leads_somewhere(road, at_start ? "predecessor" : "successor")) continue;
      geometry::Pose2 pose = reference_pose(road, at_start ? 0.0 : number(road, "length"));
      if (at_start) pose.heading_rad += std::numbers::pi;
      ends.push_back({road, at_start, source->second, pose});
    }
  }
  return ends;
}

pugi::xml_node end_section(const RoadEnd& end) {
  const auto sections = children(end.road.child("lanes"), "laneSection");
  if (sections.empty()) return {};
  return end.at_start ? sections.front() : sections.back();
}

// Lanes of a section by their ids, the middle one left out.
std::map<int, pugi::xml_node> lanes_of(pugi::xml_node section) {
  std::map<int, pugi::xml_node> lanes;
  for (const char* side : {"left", "right"}) {
    for (const auto lane : section.child(side).children("lane")) {
      lanes[lane.attribute("id").as_int()] = lane;
    }
  }
  return lanes;
}

void link_lane(pugi::xml_node lane, const char* link, int to) {
  pugi::xml_node links = ordered_child(lane, "link", kLaneOrder);
  if (links.child(link)) return;
  pugi::xml_node made = std::string_view(link) == "predecessor" ? links.prepend_child(link)
                                                                : links.append_child(link);
  made.append_attribute("id").set_value(to);
}

void link_road(const RoadEnd& end, const RoadEnd& to) {
  pugi::xml_node links = ordered_child(end.road, "link", kRoadOrder);
  pugi::xml_node made =
      end.at_start ? links.prepend_child(end.link()) : links.append_child(end.link());
  set_text(made, "elementType", "road");
  set_text(made, "elementId", to.id());
  set_text(made, "contactPoint", to.contact());
}

/// What became of a place where two ends meet.
struct Outcome {
  std::string what;
  double gap_m;
};

/// An end, and what it is like there.
struct ShapedEnd {
  const RoadEnd& end;
  const RoadEndShape& shape;
};

double space_between_m(const ShapedEnd& a, const ShapedEnd& b) {
  return std::hypot((a.end.outwards.position() - b.end.outwards.position()).norm(),
                    a.shape.height_m - b.shape.height_m);
}

/// Lanes of two ends that face each other.
struct FacingLanes {
  int id, other;
  bool same_type;
  double gap_m;  ///< between their corners
};

// Lanes face each other by their ids, mirrored where both roads begin or end there.
std::vector<FacingLanes> facing_lanes(const ShapedEnd& a, const ShapedEnd& b) {
  const int sign = a.end.at_start == b.end.at_start ? -1 : 1;
  std::vector<FacingLanes> facing;
  for (const auto& [id, lane] : a.shape.lanes) {
    const auto other = b.shape.lanes.find(sign * id);
    if (other == b.shape.lanes.end()) continue;
    facing.push_back(
        {id, sign * id, lane.type == other->second.type, distance_m(lane, other->second)});
  }
  return facing;
}

void link_all(const RoadEnd& a, const RoadEnd& b, const std::vector<FacingLanes>& facing) {
  auto lanes = lanes_of(end_section(a)), others = lanes_of(end_section(b));
  for (const FacingLanes& pair : facing) {
    link_lane(lanes[pair.id], a.link(), pair.other);
    link_lane(others[pair.other], b.link(), pair.id);
  }
  link_road(a, b);
  link_road(b, a);
}

Outcome say_why_not(const ShapedEnd& a, const ShapedEnd& b,
                    const std::vector<FacingLanes>& facing) {
  if (facing.empty()) return {"no lanes that face each other", space_between_m(a, b)};
  double nearest_m = HUGE_VAL;
  for (const FacingLanes& pair : facing) {
    if (pair.same_type) nearest_m = std::min(nearest_m, pair.gap_m);
  }
  if (nearest_m == HUGE_VAL) return {"lanes are of other types", space_between_m(a, b)};
  return {"lanes do not meet", nearest_m};
}

// Lanes that meet are linked.
Outcome link(const ShapedEnd& a, const ShapedEnd& b, double tolerance_m) {
  const std::vector<FacingLanes> facing = facing_lanes(a, b);
  std::vector<FacingLanes> meeting;
  std::vector<int> apart;
  double gap_m = 0.0;
  for (const FacingLanes& pair : facing) {
    if (pair.same_type && pair.gap_m <= tolerance_m) {
      meeting.push_back(pair);
      gap_m = std::max(gap_m, pair.gap_m);
    } else {
      apart.push_back(pair.id);
    }
  }
  if (meeting.empty()) return say_why_not(a, b, facing);
  link_all(a.end, b.end, meeting);
  if (apart.empty()) return {"linked", gap_m};
  return {fmt::format("linked but for lanes {} of road {}", fmt::join(apart, ", "), a.end.id()),
          gap_m};
}

bool face(const RoadEnd& a, const RoadEnd& b) {
  const double turn = a.outwards.heading_rad - b.outwards.heading_rad + std::numbers::pi;
  return std::abs(std::remainder(turn, 2.0 * std::numbers::pi)) <= kSameDirectionRad;
}

/// Free ends, and which of different files meet in the plane.
class MeetingEnds {
 public:
  MeetingEnds(std::vector<RoadEnd> ends, double tolerance_m)
      : ends_(std::move(ends)), tolerance_m_(tolerance_m), near_(ends_.size()) {
    std::vector<Eigen::Vector2d> places;
    for (const RoadEnd& end : ends_) places.push_back(end.outwards.position());
    NearEnds near(places, tolerance_m);
    for (std::size_t i = 0; i < ends_.size(); ++i) find_near(near, i);
    read_shapes();
    for (std::size_t i = 0; i < ends_.size(); ++i) meeting_.push_back(count_meeting(i));
  }

  std::size_t size() const { return ends_.size(); }
  const RoadEnd& end(std::size_t i) const { return ends_[i]; }
  const std::vector<std::size_t>& near(std::size_t i) const { return near_[i]; }

  Outcome join(std::size_t i, std::size_t k) const {
    const ShapedEnd a = shaped(i), b = shaped(k);
    const double apart_m = space_between_m(a, b);
    if (apart_m > tolerance_m_) return {"heights do not meet", apart_m};
    if (meeting_[i] > 1 || meeting_[k] > 1) return {"more than two ends meet", apart_m};
    if (!face(a.end, b.end)) return {"not in one direction", apart_m};
    return link(a, b, tolerance_m_);
  }

 private:
  void find_near(NearEnds& all, std::size_t i) {
    const Eigen::Vector2d at = ends_[i].outwards.position();
    for (const std::size_t k : all.around(at)) {
      const bool near = (ends_[k].outwards.position() - at).norm() <= tolerance_m_;
      if (!near || ends_[k].source == ends_[i].source) continue;
      all.add_pair();
      near_[i].push_back(k);
    }
  }

  // Of those ends that others are near to.
  void read_shapes() {
    shapes_.resize(ends_.size());
    std::vector<RoadEndPlace> places;
    std::vector<std::size_t> read;
    for (std::size_t i = 0; i < ends_.size(); ++i) {
      if (near_[i].empty()) continue;
      places.push_back({ends_[i].road, ends_[i].at_start});
      read.push_back(i);
    }
    std::vector<RoadEndShape> shapes = shapes_of(places);
    for (std::size_t i = 0; i < read.size(); ++i) shapes_[read[i]] = std::move(shapes[i]);
  }

  ShapedEnd shaped(std::size_t i) const { return {ends_[i], shapes_[i]}; }

  // How many meet an end, in the plane and in height.
  std::ptrdiff_t count_meeting(std::size_t i) const {
    return std::count_if(near_[i].begin(), near_[i].end(), [&](std::size_t k) {
      return space_between_m(shaped(i), shaped(k)) <= tolerance_m_;
    });
  }

  std::vector<RoadEnd> ends_;
  double tolerance_m_;
  std::vector<std::vector<std::size_t>> near_;
  std::vector<RoadEndShape> shapes_;
  std::vector<std::ptrdiff_t> meeting_;
};

}  // namespace

void link_coinciding_ends(pugi::xml_node root, const std::map<std::string, std::size_t>& sources,
                          double tolerance_m, std::vector<Seam>& seams) {
  const MeetingEnds ends(free_ends(root, sources), tolerance_m);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (const std::size_t other : ends.near(i)) {
      if (other < i) continue;
      const RoadEnd &a = ends.end(i), &b = ends.end(other);
      Outcome outcome = ends.join(i, other);
      seams.push_back({a.called(), b.called(), outcome.gap_m, std::move(outcome.what),
                       a.outwards.x_m, a.outwards.y_m});
    }
  }
}

}  // namespace roadbed::map::edit::merging
