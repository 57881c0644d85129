#include "roadbed/map/opendrive/build_lanes.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "roadbed/map/opendrive/element_readers.h"
#include "roadbed/map/opendrive/sample_borders.h"

namespace roadbed::map::opendrive {
namespace {

// An end of a lane in the sense of the road's s, not of driving.
struct LaneEnd {
  LaneId lane;
  ContactPoint at;
};

class Linker {
 public:
  Linker(const Document& document, const BuiltLanes& built, std::vector<ImportDiagnostic>& remarks)
      : document_(document), built_(built), remarks_(remarks), links_(built.lanes.size()) {
    for (std::size_t i = 0; i < document.roads.size(); ++i) road_index_[document.roads[i].id] = i;
  }

  std::vector<LaneLinks> link() {
    for (std::size_t road = 0; road < document_.roads.size(); ++road) {
      link_sections(road);
      link_road_end(road, document_.roads[road].predecessor, ContactPoint::start);
      link_road_end(road, document_.roads[road].successor, ContactPoint::end);
      for (std::size_t s = 0; s < document_.roads[road].sections.size(); ++s) {
        link_neighbours(road, s);
      }
    }
    for (const JunctionRecord& junction : document_.junctions) {
      for (const JunctionConnection& connection : junction.connections) {
        link_connection(junction, connection);
      }
    }
    remark_links_against_direction();
    for (LaneLinks& links : links_) {
      for (std::vector<LaneId>* list : {&links.successors, &links.predecessors}) {
        std::sort(list->begin(), list->end());
        list->erase(std::unique(list->begin(), list->end()), list->end());
      }
    }
    return std::move(links_);
  }

 private:
  const RoadRecord& road_at(std::size_t index) const { return document_.roads[index]; }

  std::optional<LaneId> find(std::size_t road, std::size_t section, int lane) const {
    const auto found = built_.ids.find({road, section, lane});
    if (found == built_.ids.end()) return {};
    return found->second;
  }

  // The lane at an end of a road.
  std::optional<LaneId> lane_at(std::size_t road, ContactPoint end, int lane) const {
    if (road_at(road).sections.empty()) return {};
    return find(road, end_section(road_at(road), end, lane), lane);
  }

  bool leaves_at(const LaneEnd& end) const {
    return built_.forward[end.lane.index] == (end.at == ContactPoint::end);
  }

  void fault(const std::string& element, long line, const std::string& message) {
    remarks_.push_back({"import.link", true, element, line, message});
  }

  // Two lane ends touch: whichever lane drives out of its end leads to the one that drives in.
  void join(const LaneEnd& a, const LaneEnd& b, long line) {
    if (leaves_at(a) == leaves_at(b)) {
      const Lane& lane = built_.lanes[a.lane.index];
      if (!is_drivable(lane.type)) {
        against_.emplace(std::min(a.lane, b.lane), std::max(a.lane, b.lane));
        return;
      }
      fault("lane " + built_.lanes[a.lane.index].name, line,
            fmt::format("is linked to lane {} end to end against its direction; the link is left "
                        "out, correct the contact points or lane ids",
                        built_.lanes[b.lane.index].name));
      return;
    }
    const LaneEnd& from = leaves_at(a) ? a : b;
    const LaneEnd& to = leaves_at(a) ? b : a;
    links_[from.lane.index].successors.push_back(to.lane);
    links_[to.lane.index].predecessors.push_back(from.lane);
  }

  // Shoulders, sidewalks and the like are often linked across the road's middle.
  void remark_links_against_direction() {
    if (against_.empty()) return;
    remarks_.push_back(
        {"import.link-against-direction", false,
         "lane " + built_.lanes[against_.begin()->first.index].name, 0,
         fmt::format("{} links of this and other lanes that are not for driving join ends that "
                     "both drive in or both out; they are left out",
                     against_.size())});
  }

  void link_sections(std::size_t road) {
    const auto& sections = road_at(road).sections;
    for (std::size_t s = 0; s < sections.size(); ++s) {
      for (const auto& [id, lane] : sections[s].lanes) {
        const std::size_t next = next_section(road_at(road), s, id);
        if (id == 0 || next >= sections.size()) continue;
        for (const int to : lane.successors) {
          join_sections(road, s, id, next, to, lane.line);
          check_declared_back(road, id, next, to);
        }
      }
      for (const auto& [id, lane] : sections[s].lanes) link_back(road, s, id, lane);
    }
  }

  // A lane's predecessors in the section before it on its side.
  void link_back(std::size_t road, std::size_t section, int id, const LaneRecord& lane) {
    if (id == 0) return;
    const auto before = previous_section(road, section, id);
    if (!before) return;
    for (const int from : lane.predecessors) {
      const auto& lanes = road_at(road).sections[*before].lanes;
      const auto found = lanes.find(from);
      if (found == lanes.end()) {
        fault(lane_name(road, section, id), lane.line,
              fmt::format("is linked to lane {} of the section before, which is not there", from));
        continue;
      }
      join_sections(road, *before, from, section, id, lane.line);
      const auto& successors = found->second.successors;
      if (std::find(successors.begin(), successors.end(), id) == successors.end()) {
        fault(lane_name(road, *before, from), found->second.line,
              fmt::format("does not name lane {} of the next section, which names it; name each "
                          "other in both",
                          id));
      }
    }
  }

  void check_declared_back(std::size_t road, int id, std::size_t next, int to) {
    const auto& lanes = road_at(road).sections[next].lanes;
    const auto found = lanes.find(to);
    if (found == lanes.end()) return;  // said by join_sections
    const auto& back = found->second.predecessors;
    if (std::find(back.begin(), back.end(), id) == back.end()) {
      fault(lane_name(road, next, to), found->second.line,
            fmt::format("does not name lane {} of the section before, which names it; name each "
                        "other in both",
                        id));
    }
  }

  std::optional<std::size_t> previous_section(std::size_t road, std::size_t section,
                                              int sign) const {
    const LaneSection& record = road_at(road).sections[section];
    const std::size_t before = sign > 0 ? record.before_left : record.before_right;
    if (before >= road_at(road).sections.size()) return {};
    return before;
  }

  std::string lane_name(std::size_t road, std::size_t section, int id) const {
    return fmt::format("lane {}/{}/{}", road_at(road).id, section, id);
  }

  void join_sections(std::size_t road, std::size_t section, int lane, std::size_t next, int to,
                     long line) {
    const auto a = find(road, section, lane), b = find(road, next, to);
    if (a && b) {
      join({*a, ContactPoint::end}, {*b, ContactPoint::start}, line);
    } else if (a) {
      fault("lane " + built_.lanes[a->index].name, line,
            fmt::format("is linked to lane {} of the next section, which is not there", to));
    }
  }

  void link_road_end(std::size_t road, const std::optional<RoadLink>& link, ContactPoint end) {
    if (!link || link->to_junction) return;
    const RoadRecord& record = road_at(road);
    const auto other = road_index_.find(link->element_id);
    if (other == road_index_.end()) {
      fault("road " + record.id, record.line,
            fmt::format("is linked to road {}, which is not there", link->element_id));
      return;
    }
    if (record.sections.empty()) return;
    for (const int sign : {1, -1}) {
      link_side_end(road, end_section(record, end, sign), sign, *link, other->second, end);
    }
  }

  // The section nearest an end that says something of a side.
  static std::size_t end_section(const RoadRecord& road, ContactPoint end, int sign) {
    const std::size_t at_end = end == ContactPoint::start ? 0 : road.sections.size() - 1;
    const LaneSection& section = road.sections[at_end];
    const auto& lanes = section.lanes;
    const bool has_side =
        !lanes.empty() && (sign > 0 ? lanes.rbegin()->first > 0 : lanes.begin()->first < 0);
    if (!section.single_side || has_side) return at_end;
    const std::size_t next = sign > 0 ? section.next_left : section.next_right;
    const std::size_t before = sign > 0 ? section.before_left : section.before_right;
    const std::size_t inner = end == ContactPoint::start ? next : before;
    return inner < road.sections.size() ? inner : at_end;
  }

  void link_side_end(std::size_t road, std::size_t section, int sign, const RoadLink& link,
                     std::size_t other, ContactPoint end) {
    for (const auto& [id, lane] : road_at(road).sections[section].lanes) {
      if (id * sign <= 0) continue;
      const auto& targets = end == ContactPoint::start ? lane.predecessors : lane.successors;
      for (const int target : targets) {
        const auto a = find(road, section, id);
        const auto b = touched_end(link, other, target, end);
        if (a && b) {
          join({*a, end}, *b, lane.line);
        } else if (a) {
          fault("lane " + built_.lanes[a->index].name, lane.line,
                fmt::format("is linked to lane {} of road {}, which is not there", target,
                            link.element_id));
        }
      }
    }
  }

  // The lane end of another road that a road's own end touches: at one of that road's ends, or in
  // between where a virtual junction joins it. elementDir is the direction of travel from a
  // predecessor onto the road, and from the road onto a successor.
  std::optional<LaneEnd> touched_end(const RoadLink& link, std::size_t other, int lane,
                                     ContactPoint end) const {
    if (link.element_s_m) {
      const auto meeting = sections_meeting_at(road_at(other), *link.element_s_m);
      if (meeting) {
        const bool ends_there = (end == ContactPoint::start) == link.element_forward;
        const auto found = find(other, ends_there ? meeting->first : meeting->second, lane);
        if (!found) return {};
        return LaneEnd{*found, ends_there ? ContactPoint::end : ContactPoint::start};
      }
    }
    const ContactPoint usual = end == ContactPoint::end ? ContactPoint::start : ContactPoint::end;
    const ContactPoint contact = link.contact.value_or(nearest_end(link, other).value_or(usual));
    const auto found = lane_at(other, contact, lane);
    if (!found) return {};
    return LaneEnd{*found, contact};
  }

  // elementS at one of the road's ends.
  std::optional<ContactPoint> nearest_end(const RoadLink& link, std::size_t other) const {
    if (!link.element_s_m) return {};
    return *link.element_s_m > 0.5 * road_at(other).length_m ? ContactPoint::end
                                                             : ContactPoint::start;
  }

  void link_connection(const JunctionRecord& junction, const JunctionConnection& connection) {
    if (connection.predecessor && connection.successor) {
      link_virtual_connection(junction, connection);
      return;
    }
    const auto incoming = road_index_.find(connection.incoming_road);
    const auto connecting = road_index_.find(connection.connecting_road);
    if (incoming == road_index_.end() || connecting == road_index_.end()) {
      fault("junction " + junction.id, connection.line,
            fmt::format("connects road {} to road {}, one of which is not there",
                        connection.incoming_road, connection.connecting_road));
      return;
    }
    if (joins_in_between(connection, connecting->second)) return;  // said by the road's own link
    const auto end = incoming_end(junction, connection, incoming->second, connecting->second);
    if (!end) {
      fault("junction " + junction.id, connection.line,
            fmt::format("no end of road {} leads to it", connection.incoming_road));
      return;
    }
    for (const auto& [from, to] : connection.lane_links) {
      const auto a = lane_at(incoming->second, *end, from);
      const auto b = lane_at(connecting->second, connection.contact, to);
      if (a && b) {
        join({*a, *end}, {*b, connection.contact}, connection.line);
      } else {
        fault(
            "junction " + junction.id, connection.line,
            fmt::format("links lane {} of road {} to lane {} of road {}, one of which is not there",
                        from, connection.incoming_road, to, connection.connecting_road));
      }
    }
  }

  // A connection of a virtual junction that has no road: lanes lead from one road's inside straight
  // to another's.
  void link_virtual_connection(const JunctionRecord& junction,
                               const JunctionConnection& connection) {
    const auto from = road_index_.find(connection.predecessor->element_id);
    const auto to = road_index_.find(connection.successor->element_id);
    if (from == road_index_.end() || to == road_index_.end()) {
      fault("junction " + junction.id, connection.line,
            fmt::format("connects road {} to road {}, one of which is not there",
                        connection.predecessor->element_id, connection.successor->element_id));
      return;
    }
    for (const auto& [from_lane, to_lane] : connection.lane_links) {
      const auto a =
          touched_end(*connection.predecessor, from->second, from_lane, ContactPoint::start);
      const auto b = touched_end(*connection.successor, to->second, to_lane, ContactPoint::end);
      if (a && b) {
        join(*a, *b, connection.line);
      } else {
        fault(
            "junction " + junction.id, connection.line,
            fmt::format("links lane {} to lane {}, one of which is not there", from_lane, to_lane));
      }
    }
  }

  // The connecting road of a virtual junction meets its incoming road between that road's ends.
  bool joins_in_between(const JunctionConnection& connection, std::size_t connecting) const {
    const RoadRecord& via = road_at(connecting);
    const auto& link = connection.contact == ContactPoint::start ? via.predecessor : via.successor;
    return link && link->element_s_m && link->element_id == connection.incoming_road;
  }

  // The end of the incoming road that touches the connecting one: as the connecting road says,
  // else as the incoming road says.
  std::optional<ContactPoint> incoming_end(const JunctionRecord& junction,
                                           const JunctionConnection& connection,
                                           std::size_t incoming, std::size_t connecting) const {
    const RoadRecord& via = road_at(connecting);
    const auto& link = connection.contact == ContactPoint::start ? via.predecessor : via.successor;
    if (link && !link->to_junction && link->element_id == connection.incoming_road &&
        link->contact) {
      return link->contact;
    }
    const RoadRecord& road = road_at(incoming);
    const auto leads = [&](const std::optional<RoadLink>& l) {
      return l && l->to_junction && l->element_id == junction.id;
    };
    if (leads(road.successor)) return ContactPoint::end;
    if (leads(road.predecessor)) return ContactPoint::start;
    return {};
  }

  void link_neighbours(std::size_t road, std::size_t section) {
    const LaneSection& record = road_at(road).sections[section];
    std::optional<int> smaller;  // the lane with the next smaller id, 0 left out
    for (const auto& [id, lane] : record.lanes) {
      if (id == 0) continue;
      if (smaller) set_beside(road, section, *smaller, id);
      smaller = id;
    }
  }

  // `right` has the smaller id: it lies to the right, seen towards growing s.
  void set_beside(std::size_t road, std::size_t section, int right, int left) {
    const auto a = find(road, section, right), b = find(road, section, left);
    if (!a || !b) return;
    const bool same = built_.forward[a->index] == built_.forward[b->index];
    // The marking belongs to the lane whose outer border it is, the middle one to lane 0.
    const auto& lanes = road_at(road).sections[section].lanes;
    const auto owner = lanes.find(right > 0 ? right : (left < 0 ? left : 0));
    const LaneRecord* mark = owner == lanes.end() ? nullptr : &owner->second;
    (built_.forward[a->index] ? links_[a->index].left : links_[a->index].right) =
        Neighbour{*b, same, windows(*a, mark, true)};
    (built_.forward[b->index] ? links_[b->index].right : links_[b->index].left) =
        Neighbour{*a, same, windows(*b, mark, false)};
  }

  // Where a lane may be left across a marking, by its stations. Nothing is known of a marking that
  // is not there: it may not be crossed.
  std::vector<StationRange> windows(LaneId lane, const LaneRecord* mark, bool to_larger_id) const {
    if (mark == nullptr) return {};
    const LaneOrigin& origin = built_.lanes[lane.index].origin;
    const auto [low_m, high_m] = std::minmax(origin.road_from_s_m, origin.road_to_s_m);
    std::vector<StationRange> windows;
    for (const auto& stretch :
         in_driving_order(built_, lane, crossings(*mark, to_larger_id, low_m, high_m))) {
      if (stretch.value) windows.push_back({stretch.from_s_m, stretch.to_s_m});
    }
    return windows;
  }

  const Document& document_;
  const BuiltLanes& built_;
  std::vector<ImportDiagnostic>& remarks_;
  std::vector<LaneLinks> links_;
  std::map<std::string, std::size_t> road_index_;
  std::set<std::pair<LaneId, LaneId>> against_;  // lanes whose link is left out
};

}  // namespace

std::vector<LaneLinks> link_lanes(const Document& document, const BuiltLanes& built,
                                  std::vector<ImportDiagnostic>& remarks) {
  return Linker(document, built, remarks).link();
}

}  // namespace roadbed::map::opendrive
