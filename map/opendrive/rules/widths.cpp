#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "roadbed/map/opendrive/rules/cubic.h"
#include "roadbed/map/opendrive/rules/records.h"

namespace roadbed::map::opendrive::rules {
namespace {

Cubics widths(const RoadSource& road, const LaneSection& section, const LaneRecord& lane) {
  return holding(lane.width.listed, road.end_s_m(section));
}

void width_steps(const Source& source, const validation::ValidateOptions& options,
                 validation::Report& report) {
  for_each_lane(
      source, [&](const RoadSource& road, const LaneSection& section, const LaneRecord& lane) {
        for_each_record(
            widths(road, section, lane), road.end_s_m(section),
            [&](const CubicElement& before, double length_m, const CubicElement* after) {
              if (after == nullptr) return;
              const double step = after->record.a - value_at(before.record, length_m);
              if (std::abs(step) <= options.max_step_m) return;
              add_record(report, source, road, *after, after->record.s_m,
                         fmt::format("width steps by {:.3f} m at s {:.3f} m; make the records meet",
                                     step, after->record.s_m))
                  .element = lane_element(road, section, lane.id);
            });
      });
}

void negative_widths(const Source& source, const validation::ValidateOptions&,
                     validation::Report& report) {
  constexpr double kNone = 1e-3;  // [m]
  for_each_lane(
      source, [&](const RoadSource& road, const LaneSection& section, const LaneRecord& lane) {
        for_each_record(
            widths(road, section, lane), road.end_s_m(section),
            [&](const CubicElement& record, double length_m, const CubicElement*) {
              const LeastValue least = least_value(record.record, length_m);
              if (least.value >= -kNone) return;
              const double s_m = record.record.s_m + least.ds_m;
              add_record(report, source, road, record, s_m,
                         fmt::format("width is {:.3f} m at s {:.2f} m; correct the record so that "
                                     "it stays at least 0",
                                     least.value, s_m))
                  .element = lane_element(road, section, lane.id);
            });
      });
}

void steep_widths(const Source& source, const validation::ValidateOptions&,
                  validation::Report& report) {
  constexpr double kSteepest = 3.0;     // [m/m], 72°: no lane widens like that, but by a step
  constexpr double kShortest_m = 1e-3;  // a step that is written as a ramp is a step
  for_each_lane(source, [&](const RoadSource& road, const LaneSection& section,
                            const LaneRecord& lane) {
    for_each_record(widths(road, section, lane), road.end_s_m(section),
                    [&](const CubicElement& record, double length_m, const CubicElement*) {
                      const LeastValue steepest = greatest_slope(record.record, length_m);
                      if (steepest.value <= kSteepest || length_m < kShortest_m) return;
                      const double s_m = record.record.s_m + steepest.ds_m;
                      add_record(report, source, road, record, s_m,
                                 fmt::format("width changes by {:.1f} m per metre at s {:.3f} m, "
                                             "which no lane does; correct b, c or d",
                                             steepest.value, s_m))
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
    for (const CubicElement& record : whole(lane.width.listed)) {
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

/// Lanes of one side of a section go by widths or by borders, not some by these and some by those.
void mixed_sides(const Source& source, const validation::ValidateOptions&,
                 validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for (const LaneSection& section : road.record.sections) {
      for (const int sign : {1, -1}) {
        const LaneRecord *by_border = nullptr, *by_width = nullptr;
        for (const LaneRecord& lane : section.listed()) {
          if (lane.id * sign <= 0) continue;
          const bool has_width = !lane.width.listed.empty();
          if (has_width) by_width = &lane;
          if (!has_width && lane.node.child("border") && !by_border) by_border = &lane;
        }
        if (by_border == nullptr || by_width == nullptr) continue;
        add_at(report, source, road, by_border->node,
               fmt::format("goes by borders but lane {} beside it by widths; describe all lanes of "
                           "a side by one of them",
                           by_width->id))
            .element = lane_element(road, section, by_border->id);
      }
    }
  }
}

void borders_with_offset(const Source& source, const validation::ValidateOptions&,
                         validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    const Cubics offsets = holding(road.record.lane_offset.listed, road.record.length_m);
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

void offsets_with_border(const Source& source, const validation::ValidateOptions&,
                         validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    if (road.record.lane_offset.listed.empty()) continue;
    const bool has_border =
        std::ranges::any_of(road.record.sections, [](const LaneSection& section) {
          return std::ranges::any_of(section.listed(), [](const LaneRecord& lane) {
            return static_cast<bool>(lane.node.child("border"));
          });
        });
    if (!has_border) continue;
    add_record(report, source, road, road.record.lane_offset.listed.front(),
               road.record.lane_offset.listed.front().record.s_m,
               "the road has a lane offset although lanes of it go by borders; describe them by "
               "widths");
  }
}

constexpr std::array<SourceRule, 9> kWidthRules = {{
    {{"width.step",
      {},
      validation::Severity::warning,
      "a lane's width steps by more than --max-step inside its section"},
     width_steps},
    {{"width.negative", "asam.net:xodr:1.4.0:road.lane.width.lane_width_validity",
      validation::Severity::error, "a lane's width is negative"},
     negative_widths},
    {{"width.steep",
      {},
      validation::Severity::warning,
      "a lane's width changes by more than 3 m per metre"},
     steep_widths},
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
    {{"width.mixed-side", "asam.net:xodr:1.4.0:road.lane.border.exclusive_width_border",
      validation::Severity::warning,
      "some lanes of a section's side have widths and others borders"},
     mixed_sides},
    {{"width.border-with-offset", "asam.net:xodr:1.4.0:road.lane.border.exclusive_offset_border",
      validation::Severity::warning, "a lane has borders although its road has a lane offset"},
     borders_with_offset},
    {{"lane-offset.with-border",
      "asam.net:xodr:1.4.0:road.lanes.lane_offset.no_offset_if_border_defined",
      validation::Severity::info, "a road has a lane offset and lanes with borders"},
     offsets_with_border},
}};

}  // namespace

std::span<const SourceRule> width_rules() { return kWidthRules; }

}  // namespace roadbed::map::opendrive::rules
