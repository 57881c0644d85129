#include <fmt/format.h>

#include <array>
#include <set>

#include "roadbed/map/lanelet2/autoware/regulation_members.h"
#include "roadbed/map/lanelet2/autoware/rules.h"

namespace roadbed::map::lanelet2::autoware {
namespace {

using validation::Report;
using validation::ValidateOptions;

void unregulated_stop_lines(const VectorMap& map, const ValidateOptions&, Report& report) {
  std::set<std::int64_t> referred;
  for (const Relation* regulation : map.regulations()) {
    for (const std::string_view role : {"ref_line", "refers"}) {
      for (const Way* line : map.lines(*regulation, role)) referred.insert(line->id);
    }
  }
  for (const Way& way : map.document().ways) {
    if (way.type != "stop_line" || is_area(way) || referred.contains(way.id)) continue;
    add_issue(report, map, 1, way,
              "no regulatory element refers to this stop line, so that nobody stops at it; add a "
              "traffic_light, traffic_sign, road_marking or another one");
  }
}

void traffic_signs(const VectorMap& map, const ValidateOptions&, Report& report) {
  for (const Relation* regulation : map.regulations()) {
    if (regulation->subtype != "traffic_sign") continue;
    const auto signs = map.lines(*regulation, "refers"), lines = map.lines(*regulation, "ref_line");
    if (signs.empty()) {
      add_issue(report, map, 1, *regulation,
                "refers to no sign; add its line as member \"refers\"");
    }
    for (const Way* sign : signs) {
      if (sign->type == "traffic_sign" && sign->subtype == "stop_sign") continue;
      add_issue(report, map, 2, *sign,
                fmt::format("is the sign of traffic_sign element {} and of type \"{}\", subtype "
                            "\"{}\"; make it traffic_sign and stop_sign",
                            regulation->id, sign->type, sign->subtype));
    }
    if (lines.empty()) {
      add_issue(report, map, 3, *regulation,
                "has no ref_line; add the line at which the sign makes stop");
    }
    for (const Way* line : lines) {
      if (line->subtype == "stop_line") continue;
      add_issue(
          report, map, 4, *line,
          fmt::format("is the ref_line of traffic_sign element {} and of subtype \"{}\"; make "
                      "it stop_line",
                      regulation->id, line->subtype));
    }
    check_extent(map, report, 5, *regulation, validation::Severity::warning);
  }
}

void road_markings(const VectorMap& map, const ValidateOptions&, Report& report) {
  for (const Relation* regulation : map.regulations()) {
    if (regulation->subtype != "road_marking") continue;
    const auto lines = map.lines(*regulation, "refers");
    const std::size_t others = map.lines(*regulation, "ref_line").size();
    if (lines.size() != 1 || others > 0) {
      add_issue(report, map, 1, *regulation,
                fmt::format("has {} members \"refers\" and {} \"ref_line\"; it needs its stop line "
                            "as the only \"refers\", and no ref_line",
                            lines.size(), others));
    }
    for (const Way* line : lines) {
      if (line->type == "stop_line") continue;
      add_issue(report, map, 2, *line,
                fmt::format("is the marking of road_marking element {} and of type \"{}\"; make it "
                            "stop_line",
                            regulation->id, line->type));
    }
  }
}

constexpr std::array<Rule, 3> kStopLineRules = {{
    {{"autoware.stop-line.missing-regulation",
      {},
      validation::Severity::error,
      "no regulatory element refers to a stop line",
      "StopLine.MissingRegulatoryElements"},
     unregulated_stop_lines},
    {{"autoware.stop-line.traffic-sign",
      {},
      validation::Severity::error,
      "a traffic sign's regulatory element names the wrong signs or stop lines",
      "StopLine.RegulatoryElementDetailsForTrafficSigns"},
     traffic_signs},
    {{"autoware.intersection.road-marking",
      {},
      validation::Severity::error,
      "a road marking's regulatory element does not name just one stop line",
      "Intersection.RoadMarkings"},
     road_markings},
}};

}  // namespace

std::span<const Rule> stop_line_rules() { return kStopLineRules; }

}  // namespace roadbed::map::lanelet2::autoware
