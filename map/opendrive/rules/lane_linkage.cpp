// What the two lanes of a link owe each other: a width where they meet, and the same lean.

#include <fmt/format.h>

#include <array>
#include <map>
#include <set>
#include <utility>

#include "roadbed/map/opendrive/rules/lane_links.h"

namespace roadbed::map::opendrive::rules {
namespace {

using End = ContactPoint;

validation::Finding& add_lane(validation::Report& report, const Source& source, const LaneEnd& at,
                              std::string message) {
  validation::Finding& finding =
      add_at(report, source, *at.road, at.lane->node, std::move(message));
  finding.element = at.element();
  finding.in_map = at.road->place_at(at.s_m());
  return finding;
}

/// Ends of lanes at which some connection of a junction links them.
std::set<LaneEnd> ends_in_junctions(const Source& source) {
  std::set<LaneEnd> ends;
  for_each_lane_link(source, [&](const LaneLink& link) {
    if (link.kind != LaneLink::Kind::in_junction) return;
    ends.insert(link.from);
    ends.insert(link.to);
  });
  return ends;
}

template <ContactPoint end>
void links_without_width(const Source& source, const validation::ValidateOptions&,
                         validation::Report& report) {
  const std::set<LaneEnd> in_junctions = ends_in_junctions(source);
  for (const RoadSource& road : source.roads) {
    for (const LaneSection& section : road.record.sections) {
      for (const LaneRecord& lane : section.listed()) {
        const LaneEnd at{&road, &section, &lane, end};
        const bool is_linked = !linked_lanes(lane, end).empty() || in_junctions.contains(at);
        if (lane.id == 0 || !is_linked || !at.has_no_width()) continue;
        add_lane(report, source, at,
                 fmt::format("has no width at its {}, s {:.3f} m, but a {} there; remove the link",
                             end_name(end), at.s_m(), link_name(end)));
      }
    }
  }
}

/// Which lanes' ends have no width, each looked at once.
class BareEnds {
 public:
  bool has(const LaneEnd& lane) {
    const auto [known, is_new] = known_.emplace(lane, false);
    if (is_new) known->second = lane.has_no_width();
    return known->second;
  }

 private:
  std::map<LaneEnd, bool> known_;
};

void appearing_lanes(const Source& source, const validation::ValidateOptions&,
                     validation::Report& report) {
  BareEnds bare;
  std::set<LaneEnd> told;
  const auto look_at = [&](const LaneEnd& lane, const LaneEnd& beside, LaneLink::Kind kind) {
    // Along one road lanes appear in the direction of s; what vanishes there and has a successor
    // is another rule's.
    if (kind == LaneLink::Kind::in_road && lane.end == End::end) return;
    if (!bare.has(lane) || bare.has(beside) || !told.insert(lane).second) return;
    add_lane(
        report, source, lane,
        fmt::format("has no width yet where lane {} is linked to it; link only the lane that goes "
                    "on",
                    beside.element().substr(5)));
  };
  for_each_lane_link(source, [&](const LaneLink& link) {
    look_at(link.to, link.from, link.kind);
    look_at(link.from, link.to, link.kind);
  });
}

/// Whether anything makes the road lean, from which a level lane is kept.
bool leans(const RoadSource& road) {
  const RoadRecord& record = road.record;
  for (const CubicElement& element : record.superelevation.listed) {
    const auto& [s_m, a, b, c, d] = element.record;
    if (a != 0.0 || b != 0.0 || c != 0.0 || d != 0.0) return true;
  }
  return !record.shape.empty() || !record.strips.empty() || !record.crossfall_left.empty() ||
         !record.crossfall_right.empty();
}

void level_changes(const Source& source, const validation::ValidateOptions&,
                   validation::Report& report) {
  std::set<std::pair<LaneEnd, LaneEnd>> told;
  for_each_lane_link(source, [&](const LaneLink& link) {
    if (link.from.lane->level == link.to.lane->level) return;
    if (told.contains({link.to, link.from}) || !told.emplace(link.from, link.to).second) return;
    validation::Finding& finding = add_lane(
        report, source, link.from,
        fmt::format("is{} level, but lane {}, which it is linked to, is{}; give both the same "
                    "level",
                    link.from.lane->level ? "" : " not", link.to.element().substr(5),
                    link.to.lane->level ? "" : " not"));
    if (!source.is_since(7)) finding.asam_rule.clear();
    const bool matters = leans(*link.from.road) || leans(*link.to.road);
    if (!matters) finding.severity = validation::Severity::info;
  });
}

constexpr std::array<SourceRule, 4> kLaneLinkageRules = {{
    {{"link.zero-width-start", "asam.net:xodr:1.7.0:road.lane.link.zero_width_at_start",
      validation::Severity::warning,
      "a lane has a predecessor although it has no width at its start, along the road"},
     links_without_width<End::start>},
    {{"link.zero-width-end", "asam.net:xodr:1.7.0:road.lane.link.zero_width_at_end",
      validation::Severity::warning,
      "a lane has a successor although it has no width at its end, along the road"},
     links_without_width<End::end>},
    {{"link.appearing-lane", "asam.net:xodr:1.4.0:road.lane.link.new_lane_appear",
      validation::Severity::warning,
      "a lane that begins with no width is linked to the lane beside it"},
     appearing_lanes},
    {{"lane.level-change", "asam.net:xodr:1.7.0:road.lane.level_true_one_side",
      validation::Severity::warning,
      "of two linked lanes one is level (a note where neither road leans)"},
     level_changes},
}};

}  // namespace

std::span<const SourceRule> lane_linkage_rules() { return kLaneLinkageRules; }

}  // namespace roadbed::map::opendrive::rules
