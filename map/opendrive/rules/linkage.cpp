#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "roadbed/map/opendrive/rules/lane_links.h"

namespace roadbed::map::opendrive::rules {
namespace {

using End = ContactPoint;

/// <predecessor> or <successor> of a road that names another road which is there.
struct LinkedEnd {
  pugi::xml_node node;
  const RoadSource* from = nullptr;
  End at = End::start;
  const RoadSource* to = nullptr;
  std::optional<End> contact;
};

std::optional<LinkedEnd> link_at(const Source& source, const RoadSource& road, End at) {
  const std::optional<RoadLink>& link = road_link(road, at);
  if (!link || link->to_junction) return {};
  const RoadSource* to = source.find_road(link->element_id);
  if (to == nullptr) return {};
  return LinkedEnd{link->node, &road, at, to, link->contact};
}

template <typename Check>
void for_each_road_link(const Source& source, const Check& check) {
  for (const RoadSource& road : source.roads) {
    for (const End end : {End::start, End::end}) {
      if (const auto link = link_at(source, road, end)) check(*link);
    }
  }
}

void one_sided_roads(const Source& source, const validation::ValidateOptions&,
                     validation::Report& report) {
  for_each_road_link(source, [&](const LinkedEnd& link) {
    if (!link.contact) return;
    const std::optional<RoadLink>& back = road_link(*link.to, *link.contact);
    const std::string id = back ? back->element_id : std::string();
    const bool to_junction = back && back->to_junction;
    if (back &&
        (to_junction ? id == link.from->record.junction_id || !link.to->record.junction_id.empty()
                     : id == link.from->record.id)) {
      return;
    }
    // Several connecting roads meet a road's end; that end names their junction, or nothing.
    if (!link.from->record.junction_id.empty() && !back) return;
    add_at(report, source, *link.from, link.node,
           fmt::format("its {} is the {} of road {}, whose {} is {}; make both name each other",
                       link_name(link.at), end_name(*link.contact), link.to->record.id,
                       link_name(*link.contact),
                       back ? fmt::format("{} {}", to_junction ? "junction" : "road", id)
                            : std::string("not given")));
  });
}

void missing_contact_points(const Source& source, const validation::ValidateOptions&,
                            validation::Report& report) {
  for_each_road_link(source, [&](const LinkedEnd& link) {
    if (link.contact || link.node.attribute("elementS")) return;
    add_at(report, source, *link.from, link.node,
           fmt::format("its {} does not say whether it meets the start or the end of road {}; add "
                       "contactPoint",
                       link_name(link.at), link.to->record.id));
  });
}

std::optional<Eigen::Vector2d> end_of(const RoadSource& road, End end) {
  if (road.geometry.empty()) return {};
  const auto& point = end == End::start ? road.geometry.front().start : road.geometry.back().end;
  if (!point) return {};
  return point->pose.position();
}

void contact_points_off(const Source& source, const validation::ValidateOptions& options,
                        validation::Report& report) {
  for_each_road_link(source, [&](const LinkedEnd& link) {
    if (!link.contact || !link.from->record.junction_id.empty() ||
        !link.to->record.junction_id.empty())
      return;
    const auto here = end_of(*link.from, link.at), there = end_of(*link.to, *link.contact);
    if (!here || !there || (*here - *there).norm() <= options.max_gap_m) return;
    validation::Finding& finding = add_at(
        report, source, *link.from, link.node,
        fmt::format("its {} is {:.3f} m from the {} of road {}, which it is linked to; correct "
                    "contactPoint, the link or a reference line",
                    end_name(link.at), (*here - *there).norm(), end_name(*link.contact),
                    link.to->record.id));
    finding.in_map = here;
  });
}

void ambiguous_links(const Source& source, const validation::ValidateOptions&,
                     validation::Report& report) {
  std::map<std::pair<const RoadSource*, End>, std::vector<LinkedEnd>> by_target;
  for_each_road_link(source, [&](const LinkedEnd& link) {
    if (!link.contact || !link.from->record.junction_id.empty()) return;
    by_target[{link.to, *link.contact}].push_back(link);
  });
  for (const RoadSource& road : source.roads) {  // in order of the file, not of addresses
    for (const End end : {End::start, End::end}) {
      const auto found = by_target.find({&road, end});
      if (found == by_target.end() || found->second.size() < 2) continue;
      for (const LinkedEnd& link : found->second) {
        add_at(report, source, *link.from, link.node,
               fmt::format("shares the {} of road {} with {} other roads; use a junction",
                           end_name(end), road.record.id, found->second.size() - 1));
      }
    }
  }
}

bool holds(const std::vector<int>& ids, int id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

/// One side of a seam between lane sections.
struct Seam {
  const RoadSource* road;
  const LaneSection* section;
  End end;
};

/// Links over a seam that the other side does not return.
void find_one_sided(const Source& source, const Seam& here, const Seam& there,
                    validation::Report& report) {
  for (const LaneRecord& lane : here.section->listed()) {
    if (lane.id == 0) continue;
    for (const int target : linked_lanes(lane, here.end)) {
      const LaneRecord* other = there.section->find(target);
      if (other != nullptr && holds(linked_lanes(*other, there.end), lane.id)) continue;
      add_at(report, source, *here.road, lane.node,
             fmt::format("its {} is lane {} of road {}, {}; make both name each other",
                         link_name(here.end), target, there.road->record.id,
                         other == nullptr
                             ? "which is not there"
                             : fmt::format("which does not have it as {}", link_name(there.end))))
          .element = lane_element(*here.road, *here.section, lane.id);
    }
  }
}

void one_sided_lanes(const Source& source, const validation::ValidateOptions&,
                     validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for (std::size_t i = 1; i < road.record.sections.size(); ++i) {
      const LaneSection &before = road.record.sections[i - 1], &after = road.record.sections[i];
      if (before.single_side || after.single_side) continue;
      find_one_sided(source, {&road, &before, End::end}, {&road, &after, End::start}, report);
      find_one_sided(source, {&road, &after, End::start}, {&road, &before, End::end}, report);
    }
  }
  for_each_road_link(source, [&](const LinkedEnd& link) {
    if (!link.contact || !link.from->record.junction_id.empty() ||
        !link.to->record.junction_id.empty())
      return;
    const LaneSection* here = end_section(*link.from, link.at);
    const LaneSection* there = end_section(*link.to, *link.contact);
    if (here == nullptr || there == nullptr) return;
    find_one_sided(source, {link.from, here, link.at}, {link.to, there, *link.contact}, report);
  });
}

void linked_lanes_without_road(const Source& source, const validation::ValidateOptions&,
                               validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for (const End end : {End::start, End::end}) {
      const LaneSection* section = end_section(road, end);
      if (section == nullptr || road_link(road, end)) continue;
      for (const LaneRecord& lane : section->listed()) {
        if (lane.id == 0 || linked_lanes(lane, end).empty()) continue;
        add_at(report, source, road, lane.node,
               fmt::format("has a {} although its road has none; link the road or remove it",
                           link_name(end)))
            .element = lane_element(road, *section, lane.id);
      }
    }
  }
}

bool drives(const LaneRecord& lane) {
  static const std::set<std::string_view> kTypes = {
      "driving", "entry", "exit", "onRamp", "offRamp", "connectingRamp", "bidirectional"};
  return kTypes.contains(lane.node.attribute("type").value());
}

bool any_drives(const LaneSection& section) {
  return std::ranges::any_of(section.listed(), drives);
}

void roads_linked_without_lanes(const Source& source, const validation::ValidateOptions&,
                                validation::Report& report) {
  for_each_road_link(source, [&](const LinkedEnd& link) {
    const LaneSection* here = end_section(*link.from, link.at);
    if (here == nullptr || !link.contact || !any_drives(*here)) return;
    const LaneSection* there = end_section(*link.to, *link.contact);
    const bool linked = std::ranges::any_of(here->listed(), [&](const LaneRecord& lane) {
      return drives(lane) && !linked_lanes(lane, link.at).empty();
    });
    if (linked || there == nullptr || !any_drives(*there)) return;
    add_at(report, source, *link.from, link.node,
           fmt::format("its {} is road {}, but none of its driving lanes is linked there; link "
                       "them",
                       link_name(link.at), link.to->record.id));
  });
}

constexpr std::array<SourceRule, 7> kLinkageRules = {{
    {{"link.road-one-sided", "asam.net:xodr:1.9.0:road.linkage.both_sides_consistency",
      validation::Severity::warning, "a road's link is not returned by the other road"},
     one_sided_roads},
    {{"link.contact-point-missing", "asam.net:xodr:1.4.0:road.linkage.road_link_attribute_usage",
      validation::Severity::warning,
      "a road's link does not say which end of the other road it meets"},
     missing_contact_points},
    {{"link.contact-point-off", "asam.net:xodr:1.7.0:road.geometry.contact_point",
      validation::Severity::warning, "linked reference lines do not meet where contactPoint says"},
     contact_points_off},
    {{"link.ambiguous", "asam.net:xodr:1.4.0:road.linkage.is_junction_needed",
      validation::Severity::warning,
      "several roads are linked to the same end of a road without a junction"},
     ambiguous_links},
    {{"link.lane-one-sided", "asam.net:xodr:1.4.0:road.lane.link.lanes_across_lane_sections",
      validation::Severity::warning,
      "a lane's link is not returned by the lane of the next section or road"},
     one_sided_lanes},
    {{"link.lane-without-road", "asam.net:xodr:1.4.0:road.lane.link.no_link",
      validation::Severity::info, "a lane is linked over an end of its road that is not linked"},
     linked_lanes_without_road},
    {{"link.roads-without-lanes",
      {},
      validation::Severity::warning,
      "roads with driving lanes are linked, but none of those lanes"},
     roads_linked_without_lanes},
}};

}  // namespace

std::span<const SourceRule> linkage_rules() { return kLinkageRules; }

}  // namespace roadbed::map::opendrive::rules
