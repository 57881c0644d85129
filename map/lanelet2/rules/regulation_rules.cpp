#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "roadbed/map/lanelet2/rules/source.h"
#include "roadbed/map/lanelet2/traffic_rules.h"

namespace roadbed::map::lanelet2::rules {
namespace {

void unknown_regulations(const Source& source, const validation::ValidateOptions&,
                         validation::Report& report) {
  static const std::set<std::string_view> kKnown = {
      "traffic_light", "traffic_sign",   "speed_limit",     "right_of_way",
      "all_way_stop",  "crosswalk",      "road_marking",    "no_stopping_area",
      "speed_bump",    "detection_area", "no_parking_area", "virtual_traffic_light",
      "roundabout",    "bus_stop_area"};
  for (const Relation* regulation : source.regulations) {
    const std::string_view subtype = regulation->subtype;
    if (kKnown.contains(subtype)) continue;
    add_at(report, source, *regulation,
           fmt::format("its subtype \"{}\" is no regulatory element that is known; correct it, or "
                       "see to it that who uses the map knows it",
                       subtype));
  }
}

void regulations_without_refers(const Source& source, const validation::ValidateOptions&,
                                validation::Report& report) {
  for (const Relation* regulation : source.regulations) {
    const std::string_view subtype = regulation->subtype;
    const bool of_lanes = subtype == "right_of_way" || subtype == "all_way_stop";
    const auto says_what = [&](const Member& member) {
      return member.role == "refers" ||
             (of_lanes && (member.role == "yield" || member.role == "right_of_way"));
    };
    if (std::ranges::any_of(regulation->members, says_what)) continue;
    const bool says_limit =
        subtype == "speed_limit" && (!value_of(regulation->tags, "sign_type").empty() ||
                                     !value_of(regulation->tags, "speed_limit").empty());
    if (says_limit) continue;
    add_at(report, source, *regulation,
           of_lanes ? "names no lanelet that yields or has the right of way; add them"
                    : "refers to nothing; add its sign, light or line as member \"refers\"");
  }
}

void unused_regulations(const Source& source, const validation::ValidateOptions&,
                        validation::Report& report) {
  std::set<std::int64_t> used;
  for (const Member& member : source.document.members) {
    if (member.role == "regulatory_element") used.insert(member.id);
  }
  for (const Relation* regulation : source.regulations) {
    if (used.contains(regulation->id)) continue;
    add_at(report, source, *regulation,
           "no lanelet or area names it; add it to those it holds for");
  }
}

constexpr std::array<SourceRule, 3> kRegulationRules = {{
    {{"lanelet2.unknown-regulation",
      {},
      validation::Severity::info,
      "a regulatory element has a subtype that is not known"},
     unknown_regulations},
    {{"lanelet2.regulation-without-refers",
      {},
      validation::Severity::warning,
      "a regulatory element refers to nothing"},
     regulations_without_refers},
    {{"lanelet2.unused-regulation",
      {},
      validation::Severity::warning,
      "no lanelet or area names a regulatory element"},
     unused_regulations},
}};

}  // namespace

std::span<const SourceRule> regulation_rules() { return kRegulationRules; }

}  // namespace roadbed::map::lanelet2::rules
