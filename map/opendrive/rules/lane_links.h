#pragma once

#include <functional>
#include <optional>
#include <string>

#include "roadbed/map/opendrive/rules/source.h"

namespace roadbed::map::opendrive::rules {

/// Least width that a lane has to have to be there [m]; files round their numbers.
constexpr double kNoWidthM = 1e-4;

/// One of the two ends of a lane, along the reference line of its road.
struct LaneEnd {
  const RoadSource* road = nullptr;
  const LaneSection* section = nullptr;
  const LaneRecord* lane = nullptr;
  ContactPoint end = ContactPoint::start;

  std::string element() const { return lane_element(*road, *section, lane->id); }
  /// Along the road.
  double s_m() const;
  /// None where the lane goes by borders, or its widths do not reach the end.
  std::optional<double> width_m() const;
  bool has_no_width() const;
  /// Whether traffic runs towards this end; on a lane of both directions it does towards each.
  bool drives_towards() const;
  bool drives_away() const { return other().drives_towards(); }
  LaneEnd other() const;

  auto operator<=>(const LaneEnd&) const = default;
};

/// A lane's <predecessor> or <successor>, or a <laneLink> of a junction from the incoming road to
/// the connecting one; both lanes are there.
struct LaneLink {
  enum class Kind { in_road, across_roads, in_junction } kind;
  LaneEnd from, to;
  pugi::xml_node node;  ///< that says so: the lane, or the <connection>
};

/// Calls `check` for every link that the file lists; one that both lanes list counts twice.
void for_each_lane_link(const Source& source, const std::function<void(const LaneLink&)>& check);

constexpr const char* end_name(ContactPoint end) {
  return end == ContactPoint::start ? "start" : "end";
}

constexpr const char* link_name(ContactPoint end) {
  return end == ContactPoint::start ? "predecessor" : "successor";
}

/// The road's link at one of its ends.
const std::optional<RoadLink>& road_link(const RoadSource& road, ContactPoint end);

/// The first section, or the last; null where there is none.
const LaneSection* end_section(const RoadSource& road, ContactPoint end);

/// The lanes that a lane names at one of its ends.
const std::vector<int>& linked_lanes(const LaneRecord& lane, ContactPoint end);

}  // namespace roadbed::map::opendrive::rules
