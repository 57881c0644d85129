#include "roadbed/map/opendrive/rules/lane_links.h"

#include <algorithm>

#include "roadbed/map/opendrive/rules/cubic.h"
#include "roadbed/map/opendrive/rules/records.h"

namespace roadbed::map::opendrive::rules {
namespace {

using End = ContactPoint;
using Check = std::function<void(const LaneLink&)>;

/// A section's end, with the road that it is of.
struct SeamSide {
  const RoadSource* road = nullptr;
  const LaneSection* section = nullptr;
  End end = End::start;

  LaneEnd of(const LaneRecord& lane) const { return {road, section, &lane, end}; }
};

void list_links(const SeamSide& here, const SeamSide& there, LaneLink::Kind kind,
                const Check& check) {
  for (const LaneRecord& lane : here.section->listed()) {
    if (lane.id == 0) continue;
    for (const int target : linked_lanes(lane, here.end)) {
      const LaneRecord* other = there.section->find(target);
      if (other != nullptr && target != 0) {
        check({kind, here.of(lane), there.of(*other), lane.node});
      }
    }
  }
}

void list_links_in_road(const RoadSource& road, const Check& check) {
  for (std::size_t i = 1; i < road.record.sections.size(); ++i) {
    const LaneSection &before = road.record.sections[i - 1], &after = road.record.sections[i];
    if (before.single_side || after.single_side) continue;
    const SeamSide end{&road, &before, End::end}, start{&road, &after, End::start};
    list_links(end, start, LaneLink::Kind::in_road, check);
    list_links(start, end, LaneLink::Kind::in_road, check);
  }
}

std::optional<SeamSide> side_at(const RoadSource* road, End end) {
  if (road == nullptr || end_section(*road, end) == nullptr) return {};
  return SeamSide{road, end_section(*road, end), end};
}

void list_links_across_roads(const Source& source, const RoadSource& road, const Check& check) {
  for (const End end : {End::start, End::end}) {
    const std::optional<RoadLink>& link = road_link(road, end);
    if (!link || link->to_junction || !link->contact) continue;
    const auto here = side_at(&road, end);
    const auto there = side_at(source.find_road(link->element_id), *link->contact);
    if (here && there) list_links(*here, *there, LaneLink::Kind::across_roads, check);
  }
}

/// The end of the incoming road that a connection begins at: that which the connecting road names,
/// or which is linked to the junction.
std::optional<End> incoming_end(const JunctionRecord& junction, const RoadSource& incoming,
                                const RoadSource& via, End contact) {
  const std::optional<RoadLink>& back = road_link(via, contact);
  if (back && !back->to_junction && back->element_id == incoming.record.id) return back->contact;
  for (const End end : {End::start, End::end}) {
    const std::optional<RoadLink>& link = road_link(incoming, end);
    const std::optional<RoadLink>& other =
        road_link(incoming, end == End::start ? End::end : End::start);
    const auto leads_in = [&](const std::optional<RoadLink>& to) {
      return to && to->to_junction && to->element_id == junction.id;
    };
    if (leads_in(link) && !leads_in(other)) return end;
  }
  return {};
}

void list_links_of(const Source& source, const JunctionRecord& junction,
                   const JunctionConnection& connection, const Check& check) {
  const RoadSource* incoming = source.find_road(connection.incoming_road);
  const RoadSource* via = source.find_road(connection.connecting_road);
  if (incoming == nullptr || via == nullptr) return;
  const auto end = incoming_end(junction, *incoming, *via, connection.contact);
  if (!end) return;
  const auto here = side_at(incoming, *end), there = side_at(via, connection.contact);
  if (!here || !there) return;
  for (const auto& [from_id, to_id] : connection.lane_links) {
    const LaneRecord *from = here->section->find(from_id), *to = there->section->find(to_id);
    if (from == nullptr || to == nullptr || from_id == 0 || to_id == 0) continue;
    check({LaneLink::Kind::in_junction, here->of(*from), there->of(*to), connection.node});
  }
}

}  // namespace

const std::optional<RoadLink>& road_link(const RoadSource& road, ContactPoint end) {
  return end == End::start ? road.record.predecessor : road.record.successor;
}

const LaneSection* end_section(const RoadSource& road, ContactPoint end) {
  if (road.record.sections.empty()) return nullptr;
  return end == End::start ? &road.record.sections.front() : &road.record.sections.back();
}

const std::vector<int>& linked_lanes(const LaneRecord& lane, ContactPoint end) {
  return end == End::start ? lane.predecessors : lane.successors;
}

double LaneEnd::s_m() const { return end == End::start ? section->s_m : road->end_s_m(*section); }

std::optional<double> LaneEnd::width_m() const {
  const double end_s_m = road->end_s_m(*section);
  const Cubics records = holding(lane->width.listed, end_s_m);
  if (records.empty() || records.front().record.s_m > section->s_m + 1e-3) return {};
  const geometry::CubicRecord& record =
      end == End::start ? records.front().record : records.back().record;
  return value_at(record, s_m() - record.s_m);
}

bool LaneEnd::has_no_width() const {
  const std::optional<double> width = width_m();
  return width && *width < kNoWidthM;
}

LaneEnd LaneEnd::other() const {
  LaneEnd other = *this;
  other.end = end == End::start ? End::end : End::start;
  return other;
}

bool LaneEnd::drives_towards() const {
  if (lane->direction == "both" || lane->type == LaneType::bidirectional) return true;
  bool forward = (lane->id < 0) != road->record.left_hand_traffic;
  if (lane->direction == "reversed") forward = !forward;
  return forward == (end == End::end);
}

void for_each_lane_link(const Source& source, const Check& check) {
  for (const RoadSource& road : source.roads) {
    list_links_in_road(road, check);
    list_links_across_roads(source, road, check);
  }
  for (const JunctionRecord& junction : source.document.junctions) {
    for (const JunctionConnection& connection : junction.connections) {
      list_links_of(source, junction, connection, check);
    }
  }
}

}  // namespace roadbed::map::opendrive::rules
