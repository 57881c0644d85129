#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/map/files/xml_characters.h"
#include "roadbed/map/opendrive/element_readers.h"
#include "roadbed/map/opendrive/read.h"
#include "roadbed/map/opendrive/rules/source.h"
#include "roadbed/map/repair/element_text.h"
#include "roadbed/map/repair/lane_seam.h"
#include "roadbed/map/repair/near_ends.h"
#include "roadbed/map/repair/proposals.h"

namespace roadbed::map::inline repair {
namespace {

using Eigen::Vector2d;
using opendrive::LaneRecord;
using opendrive::LaneSection;
using opendrive::RoadLink;
using opendrive::rules::CurveSource;
using opendrive::rules::RoadSource;
using opendrive::rules::Source;
using End = opendrive::ContactPoint;

constexpr double kRounding_m = 1e-3;  // of s in files

const char* link_name(End end) { return end == End::start ? "predecessor" : "successor"; }
const char* end_name(End end) { return end == End::start ? "start" : "end"; }
End other(End end) { return end == End::start ? End::end : End::start; }

const std::optional<RoadLink>& link_of(const RoadSource& road, End end) {
  return end == End::start ? road.record.predecessor : road.record.successor;
}

/// Of a road's reference line, in its own direction.
std::optional<geometry::Pose2> line_end(const RoadSource& road, End end) {
  if (road.geometry.empty()) return {};
  const auto& point = end == End::start ? road.geometry.front().start : road.geometry.back().end;
  if (!point) return {};
  return point->pose;
}

/// Where a road ends, and in which direction one leaves it there.
struct Exit {
  Vector2d at;
  double heading_rad;
};

std::optional<Exit> exit_at(const RoadSource& road, End end) {
  const auto pose = line_end(road, end);
  if (!pose) return {};
  const double turn_rad = end == End::start ? std::numbers::pi : 0.0;
  return Exit{pose->position(), pose->heading_rad + turn_rad};
}

const LaneSection* section_at(const RoadSource& road, End end) {
  if (road.record.sections.empty()) return nullptr;
  return end == End::start ? &road.record.sections.front() : &road.record.sections.back();
}

std::optional<SeamSide> seam_at(const RoadSource& road, End end) {
  const LaneSection* section = section_at(road, end);
  const auto pose = line_end(road, end);
  if (section == nullptr || !pose) return {};
  return SeamSide{&road, section, end, *pose};
}

const std::vector<int>& targets(const LaneRecord& lane, End end) {
  return end == End::start ? lane.predecessors : lane.successors;
}

class OpenDriveProposer {
 public:
  OpenDriveProposer(const std::string& bytes, const std::string& name, const RepairOptions& options)
      : bytes_(bytes),
        options_(options),
        xml_(bytes, name),
        document_(opendrive::read_document(xml_)),
        source_(xml_, document_) {}

  std::vector<Repair> propose() {
    for (const RoadSource& road : source_.roads) {
      remove_empty_curves(road);
      set_stations(road);
      set_length(road);
      close_gaps(road);
      return_lane_links(road);
      link_sections(road);
      for (const End end : {End::start, End::end}) mend_link(road, end);
      give_types(road);
    }
    link_ends();
    return std::move(repairs_);
  }

 private:
  void add(std::string rule, std::string element, pugi::xml_node node, std::string what,
           std::vector<TextEdit> edits, double moved_m = 0.0) {
    repairs_.push_back({std::move(rule), std::move(element), xml_.line_of(node), std::move(what),
                        moved_m, std::move(edits)});
  }

  TextEdit with_number(pugi::xml_node node, const char* name, double value) const {
    return text_of(bytes_, node).with_attribute(name, fmt::format("{}", value));
  }

  void remove_empty_curves(const RoadSource& road) {
    const auto is_empty = [](const CurveSource& curve) {
      return curve.record.length_m < opendrive::kShortestPieceM;
    };
    if (std::ranges::all_of(road.geometry, is_empty)) return;
    for (const CurveSource& curve : road.geometry) {
      if (!is_empty(curve)) continue;
      add("curve.zero-length", road.element(), curve.node(),
          fmt::format("its curve at s {} m, which had no length, is gone", curve.record.s_m),
          {text_of(bytes_, curve.node()).without()});
    }
  }

  /// Stations that are off by less than the tolerance: a larger slip may be one of a length.
  void set_stations(const RoadSource& road) {
    std::vector<TextEdit> edits;
    double s_m = 0.0, most_m = 0.0;
    for (const CurveSource& curve : road.geometry) {
      const double off_m = std::abs(curve.record.s_m - s_m);
      if (!(off_m <= options_.tolerance_m)) return;
      if (off_m > kRounding_m) edits.push_back(with_number(curve.node(), "s", s_m));
      most_m = std::max(most_m, off_m);
      s_m += curve.record.length_m;
    }
    if (edits.empty()) return;
    add("curve.station", road.element(), road.record.node,
        "its curves now have the s at which those before them end", std::move(edits), most_m);
  }

  void set_length(const RoadSource& road) {
    if (road.geometry.empty()) return;
    const double end_m = road.geometry.back().record.s_m + road.geometry.back().record.length_m;
    const double off_m = std::abs(end_m - road.record.length_m);
    if (!(off_m > options_.validate.max_gap_m && off_m <= options_.tolerance_m)) return;
    add("curve.road-length", road.element(), road.record.node,
        fmt::format("its length is now {} m, that of its reference line", end_m),
        {with_number(road.record.node, "length", end_m)}, off_m);
  }

  /// Curves are moved onto the end of the one before, and those behind them with them.
  void close_gaps(const RoadSource& road) {
    std::vector<TextEdit> edits;
    Vector2d moved(0.0, 0.0);
    double most_m = 0.0;
    for (std::size_t i = 1; i < road.geometry.size(); ++i) {
      const CurveSource &before = road.geometry[i - 1], &after = road.geometry[i];
      if (!before.end || !after.start) return;
      const Vector2d gap = before.end->pose.position() - after.start->pose.position();
      if (gap.norm() > options_.validate.max_gap_m) moved += gap;
      if (moved.isZero()) continue;
      most_m = std::max(most_m, moved.norm());
      edits.push_back(with_number(after.node(), "x", xml_.number(after.node(), "x") + moved.x()));
      edits.push_back(with_number(after.node(), "y", xml_.number(after.node(), "y") + moved.y()));
    }
    if (edits.empty() || most_m > options_.tolerance_m) return;
    add("curve.gap", road.element(), road.record.node,
        fmt::format("its curves now begin where those before them end, at most {:.3f} m from where "
                    "they did",
                    most_m),
        std::move(edits), most_m);
  }

  void return_lane_links(const RoadSource& road) {
    const auto& sections = road.record.sections;
    for (std::size_t i = 1; i < sections.size(); ++i) {
      if (sections[i - 1].single_side || sections[i].single_side) continue;
      return_links({&road, &sections[i - 1], End::end}, {&road, &sections[i], End::start});
      return_links({&road, &sections[i], End::start}, {&road, &sections[i - 1], End::end});
    }
    for (const End end : {End::start, End::end}) {
      const std::optional<RoadLink>& link = link_of(road, end);
      if (!link || link->to_junction || !link->contact || !road.record.junction_id.empty())
        continue;
      const RoadSource* to = source_.find_road(link->element_id);
      if (to == nullptr || !to->record.junction_id.empty()) continue;
      const LaneSection *here = section_at(road, end), *there = section_at(*to, *link->contact);
      if (here == nullptr || there == nullptr) continue;
      return_links({&road, here, end}, {to, there, *link->contact});
    }
  }

  /// Links of lanes over a seam that the other side does not return, where it has none of its own.
  void return_links(const SeamSide& here, const SeamSide& there) {
    for (const LaneRecord& lane : here.section->listed()) {
      for (const int target : targets(lane, here.end)) {
        const LaneRecord* back = there.section->find(target);
        if (lane.id == 0 || back == nullptr || !targets(*back, there.end).empty()) continue;
        add("link.lane-one-sided", lane_element(*there.road, *there.section, target), back->node,
            fmt::format("now names lane {} of road {} as its {}, which names it", lane.id,
                        here.road->record.id, link_name(there.end)),
            {with_lane_link(*back, there.end, lane.id)});
      }
    }
  }

  /// Lanes that go on where a section of a road ends, but do not say so.
  void link_sections(const RoadSource& road) {
    const auto& sections = road.record.sections;
    for (std::size_t i = 1; i < sections.size(); ++i) {
      if (sections[i - 1].single_side || sections[i].single_side) continue;
      const SeamSide before{&road, &sections[i - 1], End::end};
      const SeamSide after{&road, &sections[i], End::start};
      const auto lanes = meeting_lanes(before, after, options_.tolerance_m);
      // What nobody drives on is no dead end.
      if (std::ranges::none_of(lanes, [](auto& of) { return is_drivable(of.here->type); }))
        continue;
      std::vector<TextEdit> edits;
      for (const SeamLanes& of : lanes) add_links(of, before, after, edits);
      add("link.dead-end", road.element(), sections[i].node,
          fmt::format("its lanes of the same number and type are linked over s {} m, where their "
                      "corners meet",
                      sections[i].s_m),
          std::move(edits));
    }
  }

  void add_links(const SeamLanes& lanes, const SeamSide& here, const SeamSide& there,
                 std::vector<TextEdit>& edits) const {
    edits.push_back(with_lane_link(*lanes.here, here.end, lanes.there->id));
    edits.push_back(with_lane_link(*lanes.there, there.end, lanes.here->id));
  }

  TextEdit with_lane_link(const LaneRecord& lane, End end, int id) const {
    const std::string link = fmt::format(R"(<{} id="{}"/>)", link_name(end), id);
    return with_link(lane.node, end, link, lane.node.first_child());
  }

  /// Puts a predecessor before a successor, both into <link>, and that before `first`.
  TextEdit with_link(pugi::xml_node node, End end, const std::string& link,
                     pugi::xml_node first) const {
    const pugi::xml_node links = node.child("link");
    if (links) {
      const pugi::xml_node after = end == End::start ? links.child("successor") : pugi::xml_node();
      return after ? text_of(bytes_, after).with_sibling_before(link)
                   : text_of(bytes_, links).with_last_child(link);
    }
    while (first && first.type() != pugi::node_element) first = first.next_sibling();
    const std::string whole = "<link>" + link + "</link>";
    if (!first) return text_of(bytes_, node).with_last_child(whole);
    // In the place of the first character, so that two repairs do not both make a <link>.
    TextEdit edit = text_of(bytes_, first).with_sibling_before(whole);
    edit.size = 1;
    edit.text += '<';
    return edit;
  }

  TextEdit with_road_link(const RoadSource& road, End end, const RoadSource& to,
                          End contact) const {
    const std::string link =
        fmt::format(R"(<{} elementType="road" elementId="{}" contactPoint="{}"/>)", link_name(end),
                    xml_text(to.record.node.attribute("id").value()), end_name(contact));
    return with_link(road.record.node, end, link, road.record.node.first_child());
  }

  /// Distance between two ends that face each other; none if they do not.
  std::optional<double> gap_m(const RoadSource& a, End at_a, const RoadSource& b, End at_b) const {
    const auto here = exit_at(a, at_a), there = exit_at(b, at_b);
    if (!here || !there) return {};
    const double turn_rad =
        geometry::wrap_angle(here->heading_rad - there->heading_rad + std::numbers::pi);
    if (std::abs(turn_rad) > options_.validate.max_kink_rad) return {};
    return (here->at - there->at).norm();
  }

  void mend_link(const RoadSource& road, End end) {
    const std::optional<RoadLink>& link = link_of(road, end);
    if (!link || link->to_junction || !link->contact || !road.record.junction_id.empty()) return;
    const RoadSource* to = source_.find_road(link->element_id);
    if (to == nullptr || to == &road || !to->record.junction_id.empty()) return;
    const auto apart_m = gap_m(road, end, *to, *link->contact);
    const auto other_m = gap_m(road, end, *to, other(*link->contact));
    if (other_m && *other_m <= options_.validate.max_gap_m && !apart_m) {
      add("link.contact-point-off", road.element(), link->node,
          fmt::format("its {} now meets the {} of road {}, which is there", link_name(end),
                      end_name(other(*link->contact)), to->record.id),
          {text_of(bytes_, link->node)
               .with_attribute("contactPoint", end_name(other(*link->contact)))});
    } else if (apart_m && *apart_m <= options_.tolerance_m && !link_of(*to, *link->contact)) {
      return_road_link(road, end, *to, *link->contact);
    }
  }

  /// With the links of lanes that go on there: roads linked without them are another fault.
  void return_road_link(const RoadSource& road, End end, const RoadSource& to, End contact) {
    std::vector<TextEdit> edits{with_road_link(to, contact, road, end)};
    const auto here = seam_at(road, end), there = seam_at(to, contact);
    if (here && there) {
      for (const SeamLanes& of : meeting_lanes(*here, *there, options_.tolerance_m)) {
        add_links(of, *here, *there, edits);
      }
    }
    const bool has_lanes = edits.size() > 1;
    add("link.road-one-sided", to.element(), to.record.node,
        fmt::format(
            "its {} is now road {}, which names it{}", link_name(contact), road.record.id,
            has_lanes ? "; lanes of the same number and type whose corners meet are linked" : ""),
        std::move(edits));
  }

  void give_types(const RoadSource& road) {
    for (const LaneSection& section : road.record.sections) {
      for (const LaneRecord& lane : section.listed()) {
        if (lane.id == 0 || lane.node.attribute("type")) continue;
        add("schema.missing-attribute", lane_element(road, section, lane.id), lane.node,
            "is now of type none: nobody drives there, as before",
            {text_of(bytes_, lane.node).with_attribute("type", "none")});
      }
    }
  }

  struct FreeEnd {
    const RoadSource* road;
    End end;
  };

  /// Ends of roads without a link, of which just two meet.
  void link_ends() {
    std::vector<FreeEnd> ends;
    NearPoints places(options_.tolerance_m);
    for (const RoadSource& road : source_.roads) {
      for (const End end : {End::start, End::end}) {
        const auto leave = exit_at(road, end);
        if (!leave || link_of(road, end) || !road.record.junction_id.empty()) continue;
        places.add(leave->at, ends.size());
        ends.push_back({&road, end});
      }
    }
    for (std::size_t i = 0; i < ends.size(); ++i) {
      std::vector<std::size_t> there;
      places.visit(exit_at(*ends[i].road, ends[i].end)->at, [&](std::size_t k) {
        if (k != i) there.push_back(k);
      });
      if (there.size() != 1 || there.front() < i) continue;
      const FreeEnd &a = ends[i], &b = ends[there.front()];
      if (a.road != b.road && gap_m(*a.road, a.end, *b.road, b.end)) link(a, b);
    }
  }

  /// The second road as a whole, or else the first one, to where its end meets the other's: one
  /// that is free at its other end, too. Returns how far; the ends may stay apart where none is.
  double close_ends(const FreeEnd& a, const FreeEnd& b, std::vector<TextEdit>& edits) const {
    const Vector2d gap = exit_at(*a.road, a.end)->at - exit_at(*b.road, b.end)->at;
    if (gap.norm() <= options_.validate.max_gap_m) return 0.0;
    for (const auto& [free, by] : {std::pair(b, gap), std::pair(a, Vector2d(-gap))}) {
      if (link_of(*free.road, other(free.end))) continue;
      for (const CurveSource& curve : free.road->geometry) {
        edits.push_back(with_number(curve.node(), "x", xml_.number(curve.node(), "x") + by.x()));
        edits.push_back(with_number(curve.node(), "y", xml_.number(curve.node(), "y") + by.y()));
      }
      return gap.norm();
    }
    return 0.0;
  }

  void link(const FreeEnd& a, const FreeEnd& b) {
    std::vector<TextEdit> edits{with_road_link(*a.road, a.end, *b.road, b.end),
                                with_road_link(*b.road, b.end, *a.road, a.end)};
    const auto here = seam_at(*a.road, a.end), there = seam_at(*b.road, b.end);
    if (!here || !there) return;
    for (const SeamLanes& of : free_lanes(*here, *there)) add_links(of, *here, *there, edits);
    const double moved_m = close_ends(a, b, edits);
    add("link.dead-end", a.road->element(), a.road->record.node,
        fmt::format("its {} is now road {}, whose {} is there; lanes of the same number and type "
                    "are linked",
                    link_name(a.end), b.road->record.id, end_name(b.end)),
        std::move(edits), moved_m);
  }

  const std::string& bytes_;
  const RepairOptions& options_;
  XmlDocument xml_;
  opendrive::Document document_;
  Source source_;
  std::vector<Repair> repairs_;
};

}  // namespace

std::vector<Repair> propose_open_drive(const std::string& bytes, const std::string& name,
                                       const RepairOptions& options) {
  return OpenDriveProposer(bytes, name, options).propose();
}

}  // namespace roadbed::map::repair
