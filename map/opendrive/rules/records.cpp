// Where the records of profiles begin, and which of them hold.

#include "roadbed/map/opendrive/rules/records.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "roadbed/map/opendrive/values.h"

namespace roadbed::map::opendrive::rules {

Cubics holding(const std::vector<CubicElement>& listed, double end_s_m) {
  Cubics records = whole(listed), kept;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const double s_m = records[i].record.s_m;
    const bool has_next = i + 1 < records.size();
    const bool is_replaced = has_next && records[i + 1].record.s_m - s_m <= kRoundingM;
    if (!is_replaced && s_m < end_s_m - kRoundingM) kept.push_back(records[i]);
  }
  return kept;
}

validation::Finding& add_record(validation::Report& report, const Source& source,
                                const RoadSource& road, const CubicElement& record, double s_m,
                                std::string message) {
  validation::Finding& finding = add_at(report, source, road, record.node, std::move(message));
  finding.in_map = road.place_at(s_m);
  return finding;
}

namespace {

struct Ordered {
  const char *parent, *name, *s_attribute, *asam_rule;
};

void find_disorder(const Source& source, const RoadSource& road, pugi::xml_node parent,
                   const Ordered& kind, validation::Report& report) {
  double last_m = -1e300;
  for (const auto node : parent.children(kind.name)) {
    const double s_m = source.number(node, kind.s_attribute);
    if (s_m < last_m) {
      validation::Finding& finding =
          add_at(report, source, road, node,
                 fmt::format("<{}> at {} m stands behind one at {} m; list them in ascending order",
                             kind.name, s_m, last_m));
      finding.asam_rule = fmt::format("asam.net:xodr:1.4.0:{}", kind.asam_rule);
      // What rounding put back does no harm: it is taken at the station before it.
      if (last_m - s_m <= kRoundingM) finding.severity = validation::Severity::info;
    }
    if (s_m >= last_m) {
      last_m = s_m;
    }
  }
}

void unordered_records(const Source& source, const validation::ValidateOptions&,
                       validation::Report& report) {
  static constexpr Ordered kOfRoad[] = {
      {"elevationProfile", "elevation", "s", "road.elevation.elem_asc_order"},
      {"lateralProfile", "superelevation", "s", "road.superelevation.elem_asc_order"},
      {"lanes", "laneOffset", "s", "road.lanes.lane_offset.elem_asc_order"},
  };
  static constexpr Ordered kOfLane[] = {
      {"lane", "width", "sOffset", "road.lane.width.elem_asc_order"},
      {"lane", "border", "sOffset", "road.lane.border.elem_asc_order"},
      {"lane", "speed", "sOffset", "road.lane.speed.elem_asc_order"},
      {"lane", "roadMark", "sOffset", "road.lane.road_mark.elem_asc_order"},
      {"lane", "height", "sOffset", "road.lane.height.elem_asc_order"},
      {"lane", "access", "sOffset", "road.lane.access.elem_asc_order"},
      {"lane", "material", "sOffset", "road.lane.material.elem_asc_order"},
      {"lane", "rule", "sOffset", "road.lane.rule.elem_asc_order"},
  };
  for (const RoadSource& road : source.roads) {
    find_disorder(source, road, road.record.node, {"road", "type", "s", "road.type.elem_asc_order"},
                  report);
    for (const Ordered& kind : kOfRoad) {
      find_disorder(source, road, road.record.node.child(kind.parent), kind, report);
    }
    for (const LaneSection& section : road.record.sections) {
      for (const LaneRecord& lane : section.listed()) {
        for (const Ordered& kind : kOfLane) find_disorder(source, road, lane.node, kind, report);
      }
    }
  }
}

/// A profile of a road or a lane: its records, what they are called, and what has them.
struct Where {
  const std::vector<CubicElement>& listed;
  std::string element;
};

/// Calls `check(road, where)` for every profile of roads, and of lanes if asked for.
template <typename Check>
void for_each_profile(const Source& source, bool of_lanes, const Check& check) {
  for (const RoadSource& road : source.roads) {
    for (const Profile* profile :
         {&road.record.elevation, &road.record.superelevation, &road.record.lane_offset}) {
      check(road, Where{profile->listed, road.element()});
    }
  }
  if (!of_lanes) return;
  for_each_lane(source,
                [&](const RoadSource& road, const LaneSection& section, const LaneRecord& lane) {
                  for (const Profile* profile : {&lane.width, &lane.border}) {
                    check(road, Where{profile->listed, lane_element(road, section, lane.id)});
                  }
                });
}

void add_late_start(const Source& source, const RoadSource& road, pugi::xml_node first,
                    validation::Report& report) {
  const double s_m = source.number(first, "s"), value = source.number(first, "a");
  if (!(s_m > kRoundingM) || !(std::abs(value) > kRoundingM)) return;
  add_at(report, source, road, first,
         fmt::format("<{}> begins at s {:.3f} m with {:.3f}, but is 0 before it; begin it at s 0",
                     first.name(), s_m, value))
      .in_map = road.place_at(s_m);
}

void late_starts(const Source& source, const validation::ValidateOptions&,
                 validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    const pugi::xml_node node = road.record.node;
    for (const auto& [parent, name] : {std::pair{"elevationProfile", "elevation"},
                                       {"lateralProfile", "superelevation"},
                                       {"lateralProfile", "crossfall"},
                                       {"lanes", "laneOffset"}}) {
      add_late_start(source, road, node.child(parent).child(name), report);
    }
  }
}

bool is_same(const geometry::CubicRecord& a, const geometry::CubicRecord& b) {
  return a.a == b.a && a.b == b.b && a.c == b.c && a.d == b.d;
}

void replaced_records(const Source& source, const validation::ValidateOptions&,
                      validation::Report& report) {
  for_each_profile(source, true, [&](const RoadSource& road, const Where& where) {
    const Cubics records = whole(where.listed);
    for (std::size_t i = 1; i < records.size(); ++i) {
      const auto &before = records[i - 1].record, &record = records[i].record;
      if (record.s_m - before.s_m > kRoundingM || is_same(before, record)) continue;
      add_record(report, source, road, records[i], record.s_m,
                 fmt::format("a second <{}> begins at s {:.3f} m and holds in place of the first; "
                             "remove one of them",
                             records[i].node.name(), record.s_m))
          .element = where.element;
    }
  });
}

void records_beyond_roads(const Source& source, const validation::ValidateOptions& options,
                          validation::Report& report) {
  for_each_profile(source, false, [&](const RoadSource& road, const Where& where) {
    for (const CubicElement& element : whole(where.listed)) {
      if (!(element.record.s_m > road.record.length_m + options.max_gap_m)) continue;
      add_record(report, source, road, element, road.record.length_m,
                 fmt::format("<{}> begins at s {:.3f} m, beyond the road's end at {:.3f} m, and "
                             "never holds; remove it or correct s",
                             element.node.name(), element.record.s_m, road.record.length_m));
    }
  });
}

constexpr std::array<SourceRule, 4> kRecordRules = {{
    {{"profile.order", "asam.net:xodr:1.4.0:road.elevation.elem_asc_order",
      validation::Severity::warning,
      "records of elevation, superelevation, lane offset, width, border, speed, road mark, height, "
      "access, material, rule or type are not in ascending order"},
     unordered_records},
    {{"profile.late-start",
      {},
      validation::Severity::warning,
      "an elevation, superelevation, crossfall or lane offset begins after its road, and not at 0"},
     late_starts},
    {{"profile.same-station",
      {},
      validation::Severity::warning,
      "two records of elevation, superelevation, lane offset, width or border begin at one place"},
     replaced_records},
    {{"profile.beyond-road",
      {},
      validation::Severity::info,
      "a record of elevation, superelevation or lane offset begins beyond the end of its road"},
     records_beyond_roads},
}};

}  // namespace

std::span<const SourceRule> record_rules() { return kRecordRules; }

}  // namespace roadbed::map::opendrive::rules
