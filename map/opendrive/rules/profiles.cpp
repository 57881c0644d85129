#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "roadbed/map/opendrive/rules/cubic.h"
#include "roadbed/map/opendrive/rules/source.h"

namespace roadbed::map::opendrive::rules {
namespace {

using Cubics = std::vector<CubicElement>;

Cubics elevation(const RoadSource& road) { return whole(road.record.elevation.listed); }
Cubics superelevation(const RoadSource& road) { return whole(road.record.superelevation.listed); }
Cubics lane_offset(const RoadSource& road) { return whole(road.record.lane_offset.listed); }

/// Calls `check(record, length, next)` for every record; `next` is null for the last one.
template <typename Check>
void for_each_record(const Cubics& records, double end_s_m, const Check& check) {
  for (std::size_t i = 0; i < records.size(); ++i) {
    const CubicElement* next = i + 1 < records.size() ? &records[i + 1] : nullptr;
    const double length_m = (next ? next->record.s_m : end_s_m) - records[i].record.s_m;
    if (length_m >= 0.0) check(records[i], length_m, next);
  }
}

validation::Finding& add(validation::Report& report, const Source& source, const RoadSource& road,
                         const CubicElement& record, double s_m, std::string message) {
  validation::Finding& finding = add_at(report, source, road, record.node, std::move(message));
  finding.in_map = road.place_at(s_m);
  return finding;
}

struct Quantity {
  const char *name, *unit;
};

/// A step of a profile's value from one record to the next.
void add_step(validation::Report& report, const Source& source, const RoadSource& road,
              const CubicElement& before, double length_m, const CubicElement& after,
              double max_step, const Quantity& what) {
  const double step = after.record.a - value_at(before.record, length_m);
  if (std::abs(step) <= max_step) return;
  add(report, source, road, after, after.record.s_m,
      fmt::format("{} steps by {:.3f} {} at s {:.3f} m; make the records meet", what.name, step,
                  what.unit, after.record.s_m));
}

void find_steps(const Source& source, const RoadSource& road, const Cubics& records,
                double max_step, const Quantity& what, validation::Report& report) {
  for_each_record(records, road.record.length_m,
                  [&](const CubicElement& before, double length_m, const CubicElement* after) {
                    if (after == nullptr) return;
                    add_step(report, source, road, before, length_m, *after, max_step, what);
                  });
}

void elevation_steps(const Source& source, const validation::ValidateOptions& options,
                     validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    find_steps(source, road, elevation(road), options.max_step_m, {"elevation", "m"}, report);
  }
}

void superelevation_steps(const Source& source, const validation::ValidateOptions&,
                          validation::Report& report) {
  constexpr double kMaxStep = 0.01;  // [rad], 5 cm at 5 m from the middle
  for (const RoadSource& road : source.roads) {
    find_steps(source, road, superelevation(road), kMaxStep, {"superelevation", "rad"}, report);
  }
}

/// Whether a lane section begins there: its lanes may be numbered from another line on, and whether
/// their borders go on is asked of the lanes.
bool begins_section(const RoadSource& road, double s_m) {
  constexpr double kSame_m = 0.01;
  return std::any_of(
      road.record.sections.begin(), road.record.sections.end(),
      [&](const LaneSection& section) { return std::abs(section.s_m - s_m) < kSame_m; });
}

void lane_offset_steps(const Source& source, const validation::ValidateOptions& options,
                       validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for_each_record(lane_offset(road), road.record.length_m,
                    [&](const CubicElement& before, double length_m, const CubicElement* after) {
                      if (after == nullptr || begins_section(road, after->record.s_m)) return;
                      add_step(report, source, road, before, length_m, *after, options.max_step_m,
                               {"lane offset", "m"});
                    });
  }
}

void slope_jumps(const Source& source, const validation::ValidateOptions& options,
                 validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for_each_record(elevation(road), road.record.length_m,
                    [&](const CubicElement& before, double length_m, const CubicElement* after) {
                      if (after == nullptr) return;
                      const double jump = after->record.b - slope_at(before.record, length_m);
                      if (std::abs(jump) <= options.max_slope_jump) return;
                      add(report, source, road, *after, after->record.s_m,
                          fmt::format("the road's slope jumps by {:.1f} % at s {:.3f} m; round the "
                                      "elevation off",
                                      100.0 * jump, after->record.s_m));
                    });
  }
}

void steep_roads(const Source& source, const validation::ValidateOptions& options,
                 validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for_each_record(elevation(road), road.record.length_m,
                    [&](const CubicElement& record, double length_m, const CubicElement*) {
                      const LeastValue steepest = greatest_slope(record.record, length_m);
                      if (steepest.value <= options.max_slope || length_m == 0.0) return;
                      add(report, source, road, record, record.record.s_m + steepest.ds_m,
                          fmt::format("the road's slope reaches {:.0f} % at s {:.2f} m, more than "
                                      "a car climbs; correct the elevation",
                                      100.0 * steepest.value, record.record.s_m + steepest.ds_m));
                    });
  }
}

void steep_crossfalls(const Source& source, const validation::ValidateOptions&,
                      validation::Report& report) {
  constexpr double kSteepest = 0.35;  // [rad]; roads stay below 0.1, test tracks go beyond 0.5
  for (const RoadSource& road : source.roads) {
    for (const CubicElement& record : superelevation(road)) {
      if (std::abs(record.record.a) <= kSteepest) continue;
      add(report, source, road, record, record.record.s_m,
          fmt::format("superelevation is {:.2f} rad at s {:.2f} m; check whether it is meant in "
                      "degrees",
                      record.record.a, record.record.s_m));
      break;
    }
  }
}

/// Elevations of real roads, from the Dead Sea's shore to the highest passes [m].
bool is_on_earth(double elevation_m) { return elevation_m > -450.0 && elevation_m < 6000.0; }

void elevation_outliers(const Source& source, const validation::ValidateOptions&,
                        validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for (const CubicElement& record : elevation(road)) {
      if (is_on_earth(record.record.a)) continue;
      add(report, source, road, record, record.record.s_m,
          fmt::format("elevation is {:.1f} m at s {:.2f} m, where no road is; correct it",
                      record.record.a, record.record.s_m));
      break;
    }
  }
}

/// Calls `check(road, section, lane)` for every lane that has a width.
template <typename Check>
void for_each_lane(const Source& source, const Check& check) {
  for (const RoadSource& road : source.roads) {
    for (const LaneSection& section : road.record.sections) {
      for (const LaneRecord& lane : section.listed()) {
        if (lane.id != 0) check(road, section, lane);
      }
    }
  }
}

Cubics widths(const LaneRecord& lane) { return whole(lane.width.listed); }

void width_steps(const Source& source, const validation::ValidateOptions& options,
                 validation::Report& report) {
  for_each_lane(
      source, [&](const RoadSource& road, const LaneSection& section, const LaneRecord& lane) {
        for_each_record(
            widths(lane), road.end_s_m(section),
            [&](const CubicElement& before, double length_m, const CubicElement* after) {
              if (after == nullptr) return;
              const double step = after->record.a - value_at(before.record, length_m);
              if (std::abs(step) <= options.max_step_m) return;
              add(report, source, road, *after, after->record.s_m,
                  fmt::format("width steps by {:.3f} m at s {:.3f} m; make the records meet", step,
                              after->record.s_m))
                  .element = lane_element(road, section, lane.id);
            });
      });
}

void negative_widths(const Source& source, const validation::ValidateOptions&,
                     validation::Report& report) {
  constexpr double kNone = 1e-3;  // [m]
  for_each_lane(source, [&](const RoadSource& road, const LaneSection& section,
                            const LaneRecord& lane) {
    for_each_record(widths(lane), road.end_s_m(section),
                    [&](const CubicElement& record, double length_m, const CubicElement*) {
                      const LeastValue least = least_value(record.record, length_m);
                      if (least.value >= -kNone) return;
                      const double s_m = record.record.s_m + least.ds_m;
                      add(report, source, road, record, s_m,
                          fmt::format("width is {:.3f} m at s {:.2f} m; correct the record so that "
                                      "it stays at least 0",
                                      least.value, s_m))
                          .element = lane_element(road, section, lane.id);
                    });
  });
}

void widths_without_start(const Source& source, const validation::ValidateOptions&,
                          validation::Report& report) {
  for_each_lane(
      source, [&](const RoadSource& road, const LaneSection& section, const LaneRecord& lane) {
        const auto first = lane.width.listed.empty() ? pugi::xml_node() : lane.width.listed[0].node;
        const bool begins = first && !(source.number(first, "sOffset") > 1e-3);
        if (begins || !lane.border.listed.empty()) return;
        add_at(report, source, road, lane.node,
               first ? "its first width does not begin at sOffset 0; say the width from there on"
                     : "has neither width nor border; add one")
            .element = lane_element(road, section, lane.id);
      });
}

void widths_beyond_sections(const Source& source, const validation::ValidateOptions& options,
                            validation::Report& report) {
  for_each_lane(source, [&](const RoadSource& road, const LaneSection& section,
                            const LaneRecord& lane) {
    for (const CubicElement& record : widths(lane)) {
      if (!(record.record.s_m > road.end_s_m(section) + options.max_gap_m)) continue;
      add_at(report, source, road, record.node,
             fmt::format("a width begins at s {:.3f} m, beyond the section's end at {:.3f} m, and "
                         "never holds; remove it or correct sOffset",
                         record.record.s_m, road.end_s_m(section)))
          .element = lane_element(road, section, lane.id);
    }
  });
}

void widths_with_borders(const Source& source, const validation::ValidateOptions&,
                         validation::Report& report) {
  for_each_lane(source,
                [&](const RoadSource& road, const LaneSection& section, const LaneRecord& lane) {
                  if (lane.width.listed.empty() || lane.border.listed.empty()) return;
                  add_at(report, source, road, lane.node,
                         "has both width and border; keep the widths, which hold by the standard")
                      .element = lane_element(road, section, lane.id);
                });
}

void borders_with_offset(const Source& source, const validation::ValidateOptions&,
                         validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    const Cubics offsets = lane_offset(road);
    bool moved = false;
    for (const CubicElement& offset : offsets) {
      const auto& r = offset.record;
      moved = moved || r.a != 0.0 || r.b != 0.0 || r.c != 0.0 || r.d != 0.0;
    }
    if (!moved) continue;
    for (const LaneSection& section : road.record.sections) {
      for (const LaneRecord& lane : section.listed()) {
        if (lane.border.listed.empty()) continue;
        add_at(report, source, road, lane.node,
               "has a border although its road has a lane offset; describe the lane by widths")
            .element = lane_element(road, section, lane.id);
      }
    }
  }
}

struct Ordered {
  const char *parent, *name, *s_attribute, *asam_rule;
};

void find_disorder(const Source& source, const RoadSource& road, pugi::xml_node parent,
                   const Ordered& kind, validation::Report& report) {
  double last_m = -1e300;
  for (const auto node : parent.children(kind.name)) {
    const double s_m = source.number(node, kind.s_attribute);
    if (s_m < last_m) {
      add_at(report, source, road, node,
             fmt::format("<{}> at {} m stands behind one at {} m; list them in ascending order",
                         kind.name, s_m, last_m))
          .asam_rule = fmt::format("asam.net:xodr:1.4.0:{}", kind.asam_rule);
    } else if (s_m >= last_m) {
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

constexpr std::array<SourceRule, 14> kProfileRules = {{
    {{"profile.order", "asam.net:xodr:1.4.0:road.elevation.elem_asc_order",
      validation::Severity::warning,
      "records of elevation, superelevation, lane offset, width, border, speed, road mark or type "
      "are not in ascending order"},
     unordered_records},
    {{"elevation.step",
      {},
      validation::Severity::warning,
      "the elevation of a road steps by more than --max-step"},
     elevation_steps},
    {{"elevation.slope-jump",
      {},
      validation::Severity::warning,
      "the slope of a road jumps by more than --max-slope-jump"},
     slope_jumps},
    {{"elevation.steep", {}, validation::Severity::warning, "a road is steeper than --max-slope"},
     steep_roads},
    {{"elevation.outlier",
      {},
      validation::Severity::warning,
      "a road is below -450 m or above 6000 m, where no road is"},
     elevation_outliers},
    {{"superelevation.step",
      {},
      validation::Severity::warning,
      "the superelevation of a road steps by more than 0.01 rad"},
     superelevation_steps},
    {{"superelevation.steep",
      {},
      validation::Severity::info,
      "superelevation is more than 0.35 rad"},
     steep_crossfalls},
    {{"lane-offset.step",
      {},
      validation::Severity::warning,
      "the lane offset of a road steps by more than --max-step inside a lane section"},
     lane_offset_steps},
    {{"width.step",
      {},
      validation::Severity::warning,
      "a lane's width steps by more than --max-step inside its section"},
     width_steps},
    {{"width.negative", "asam.net:xodr:1.4.0:road.lane.width.lane_width_validity",
      validation::Severity::error, "a lane's width is negative"},
     negative_widths},
    {{"width.missing", "asam.net:xodr:1.7.0:road.lane.width.width_defined_whole_section",
      validation::Severity::warning, "a lane has no width at the start of its section"},
     widths_without_start},
    {{"width.beyond-section",
      {},
      validation::Severity::info,
      "a width begins beyond the end of its section"},
     widths_beyond_sections},
    {{"width.with-border", "asam.net:xodr:1.4.0:road.lane.border.exclusive_width_border",
      validation::Severity::warning, "a lane has both widths and borders"},
     widths_with_borders},
    {{"width.border-with-offset", "asam.net:xodr:1.4.0:road.lane.border.exclusive_offset_border",
      validation::Severity::warning, "a lane has borders although its road has a lane offset"},
     borders_with_offset},
}};

}  // namespace

std::span<const SourceRule> profile_rules() { return kProfileRules; }

}  // namespace roadbed::map::opendrive::rules
