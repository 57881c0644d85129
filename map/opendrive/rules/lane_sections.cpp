#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <set>

#include "roadbed/map/opendrive/rules/cubic.h"
#include "roadbed/map/opendrive/rules/source.h"
#include "roadbed/map/opendrive/values.h"

namespace roadbed::map::opendrive::rules {
namespace {

void missing_sections(const Source& source, const validation::ValidateOptions&,
                      validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    if (!road.record.sections.empty()) continue;
    add_at(report, source, road, road.record.node, "has no lane section; add one at s 0");
  }
}

void late_sections(const Source& source, const validation::ValidateOptions& options,
                   validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    if (road.record.sections.empty() || !(road.record.sections[0].s_m > options.max_gap_m))
      continue;
    add_at(report, source, road, road.record.sections[0].node,
           fmt::format("its first lane section begins at s {} m; begin it at 0",
                       road.record.sections[0].s_m));
  }
}

void unordered_sections(const Source& source, const validation::ValidateOptions&,
                        validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for (std::size_t i = 1; i < road.record.sections.size(); ++i) {
      if (!(road.record.sections[i].s_m < road.record.sections[i - 1].s_m)) continue;
      add_at(report, source, road, road.record.sections[i].node,
             fmt::format("lane section at s {} m stands behind that at {} m; list them in order",
                         road.record.sections[i].s_m, road.record.sections[i - 1].s_m));
    }
  }
}

void empty_sections(const Source& source, const validation::ValidateOptions&,
                    validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for (std::size_t i = 0; i < road.record.sections.size(); ++i) {
      const LaneSection& section = road.record.sections[i];
      const double length_m = road.end_s_m(section) - section.s_m;
      const bool shares = section.single_side || (i + 1 < road.record.sections.size() &&
                                                  road.record.sections[i + 1].single_side);
      if (!(length_m <= 0.0) || shares) continue;
      add_at(report, source, road, section.node,
             fmt::format("lane section at s {} m has no length; remove it or correct its s",
                         section.s_m));
    }
  }
}

/// Ids of one side, by distance from the middle.
std::vector<int> side_ids(const LaneSection& section, int sign) {
  std::vector<int> ids;
  for (const LaneRecord& lane : section.listed()) {
    if (lane.id * sign > 0) ids.push_back(std::abs(lane.id));
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

void gaps_in_numbers(const Source& source, const validation::ValidateOptions&,
                     validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for (const LaneSection& section : road.record.sections) {
      for (const int sign : {1, -1}) {
        const std::vector<int> ids = side_ids(section, sign);
        for (std::size_t i = 0; i < ids.size(); ++i) {
          if (ids[i] <= static_cast<int>(i) + 1) continue;
          add_at(report, source, road, section.node,
                 fmt::format("lane {} is missing between the middle and lane {}; number the lanes "
                             "without gaps",
                             sign * (static_cast<int>(i) + 1), sign * ids[i]));
          break;
        }
      }
    }
  }
}

void lanes_on_wrong_side(const Source& source, const validation::ValidateOptions&,
                         validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for (const LaneSection& section : road.record.sections) {
      for (const LaneRecord& lane : section.listed()) {
        const bool fits = std::string_view(lane.side) == "left"
                              ? lane.id > 0
                              : std::string_view(lane.side) == "center" || lane.id < 0;
        if (fits) continue;
        add_at(report, source, road, lane.node,
               fmt::format("stands in <{}>; left lanes have positive ids, right ones negative",
                           lane.side))
            .element = lane_element(road, section, lane.id);
      }
    }
  }
}

void broken_centres(const Source& source, const validation::ValidateOptions&,
                    validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for (const LaneSection& section : road.record.sections) {
      const auto in_centre = [](const LaneRecord& lane) {
        return std::string_view(lane.side) == "center";
      };
      const auto count = std::ranges::count_if(section.listed(), in_centre);
      const LaneRecord* zero = section.find(0);
      if (!section.node.child("center") || (count == 1 && zero && in_centre(*zero))) continue;
      add_at(report, source, road, section.node,
             fmt::format("lane section at s {} m needs one centre lane with id 0, has {} lanes in "
                         "<center>; correct it",
                         section.s_m, count));
    }
  }
}

void wide_centres(const Source& source, const validation::ValidateOptions&,
                  validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for (const LaneSection& section : road.record.sections) {
      for (const LaneRecord& lane : section.listed()) {
        const auto width = lane.node.child("width");
        if (std::string_view(lane.side) != "center" || !width) continue;
        add_at(report, source, road, width,
               "the centre lane has a width, which it cannot have; remove it");
      }
    }
  }
}

void level_inside(const Source& source, const validation::ValidateOptions&,
                  validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for (const LaneSection& section : road.record.sections) {
      for (const int sign : {1, -1}) {
        bool level = false;
        for (const int distance : side_ids(section, sign)) {
          const LaneRecord& lane = *section.find(sign * distance);
          if (level && !lane.level) {
            validation::Finding& finding =
                add_at(report, source, road, lane.node,
                       "is not level although a lane further in is; level all lanes from there to "
                       "the road's edge");
            finding.element = lane_element(road, section, lane.id);
            if (!source.is_since(7)) {  // before, nothing was said of lanes further out
              finding.severity = validation::Severity::info;
              finding.asam_rule.clear();
            }
          }
          level = level || lane.level;
        }
      }
    }
  }
}

/// Whether a station is in the set, up to rounding.
bool holds(const std::set<double>& stations_m, double s_m) {
  const auto found = stations_m.lower_bound(s_m - kRoundingM);
  return found != stations_m.end() && *found <= s_m + kRoundingM;
}

void mixed_access(const Source& source, const validation::ValidateOptions&,
                  validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for (const LaneSection& section : road.record.sections) {
      for (const LaneRecord& lane : section.listed()) {
        std::set<double> allow, deny;
        for (const auto access : lane.node.children("access")) {
          const double s_m = source.number(access, "sOffset");
          const std::string_view rule = access.attribute("rule").value();
          if (std::isnan(s_m) || (rule != "allow" && rule != "deny")) continue;
          (rule == "allow" ? allow : deny).insert(s_m);
          if (!holds(rule == "allow" ? deny : allow, s_m)) continue;
          add_at(report, source, road, access,
                 fmt::format("allows and denies access at sOffset {} m; keep one kind", s_m))
              .element = lane_element(road, section, lane.id);
        }
      }
    }
  }
}

geometry::PiecewiseCubic border_of(const LaneRecord& lane) {
  std::vector<geometry::CubicRecord> records;
  for (const CubicElement& cubic : whole(lane.border.listed)) {
    records.push_back(cubic.record);
  }
  std::stable_sort(records.begin(), records.end(),
                   [](const auto& a, const auto& b) { return a.s_m < b.s_m; });
  return geometry::PiecewiseCubic(std::move(records));
}

/// The difference of two borders from s on, up to the next record of either.
geometry::CubicRecord difference(const geometry::PiecewiseCubic& outer,
                                 const geometry::PiecewiseCubic& inner, double s_m, double end_m) {
  const double middle_m = 0.5 * (s_m + end_m), length_m = end_m - s_m;
  const auto at = [&](double x_m) {
    const auto o = outer.at(x_m, middle_m), i = inner.at(x_m, middle_m);
    return geometry::CubicValue{o.value - i.value, o.d1 - i.d1, o.d2 - i.d2};
  };
  const auto start = at(s_m), end = at(end_m);
  return {s_m, start.value, start.d1, 0.5 * start.d2, (end.d2 - start.d2) / (6.0 * length_m)};
}

/// Where two borders of one side are most swapped.
std::optional<LeastValue> crossing(const geometry::PiecewiseCubic& outer,
                                   const geometry::PiecewiseCubic& inner, double from_m,
                                   double to_m, int sign) {
  constexpr double kNone = 1e-3;  // [m]
  std::set<double> stations{from_m, to_m};
  for (const auto* border : {&outer, &inner}) {
    for (const auto& record : border->records()) {
      if (record.s_m > from_m && record.s_m < to_m) stations.insert(record.s_m);
    }
  }
  std::optional<LeastValue> worst;
  for (auto s = stations.begin(); std::next(s) != stations.end(); ++s) {
    geometry::CubicRecord cubic = difference(outer, inner, *s, *std::next(s));
    for (double* value : {&cubic.a, &cubic.b, &cubic.c, &cubic.d}) *value *= sign;
    const LeastValue least = least_value(cubic, *std::next(s) - *s);
    if (least.value >= -kNone || (worst && worst->value <= least.value)) continue;
    worst = LeastValue{*s + least.ds_m, least.value};
  }
  return worst;
}

void crossing_borders(const Source& source, const validation::ValidateOptions&,
                      validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for (const LaneSection& section : road.record.sections) {
      if (!(road.end_s_m(section) > section.s_m)) continue;
      for (const LaneRecord& lane : section.listed()) {
        const int sign = lane.id > 0 ? 1 : -1;
        const LaneRecord* inner = section.find(lane.id - sign);
        if (lane.id == 0 || lane.border.listed.empty() || !lane.width.listed.empty()) continue;
        if (inner == nullptr || (inner->id != 0 && inner->border.listed.empty())) continue;
        const auto worst =
            crossing(border_of(lane), border_of(*inner), section.s_m, road.end_s_m(section), sign);
        if (!worst) continue;
        validation::Finding& finding =
            add_at(report, source, road, lane.node,
                   fmt::format("its border is {:.3f} m inside that of lane {} at s {:.2f} m; "
                               "correct one of them",
                               -worst->value, inner->id, worst->ds_m));
        finding.element = lane_element(road, section, lane.id);
        finding.in_map = road.place_at(worst->ds_m);
      }
    }
  }
}

constexpr std::array<SourceRule, 11> kLaneRules = {{
    {{"section.missing", "asam.net:xodr:1.4.0:road.lane_section.lane_sect_req",
      validation::Severity::error, "a road has no lane section"},
     missing_sections},
    {{"section.first", "asam.net:xodr:1.9.0:road.lane.lane_sect_first",
      validation::Severity::warning, "a road's first lane section does not begin at 0"},
     late_sections},
    {{"section.order", "asam.net:xodr:1.4.0:road.lane_section.elem_asc_order",
      validation::Severity::warning, "lane sections are not in order of s"},
     unordered_sections},
    {{"section.zero-length", "asam.net:xodr:1.4.0:road.lane_section.valid_length",
      validation::Severity::warning, "a lane section has no length"},
     empty_sections},
    {{"lane.numbering", "asam.net:xodr:1.4.0:road.lane.lane_order_no_gaps",
      validation::Severity::error, "lane numbers have gaps"},
     gaps_in_numbers},
    {{"lane.side", "asam.net:xodr:1.4.0:road.lane.lanes_numbered_correctly",
      validation::Severity::error, "a lane stands on the side that its number does not belong to"},
     lanes_on_wrong_side},
    {{"lane.centre", "asam.net:xodr:1.4.0:road.lane.center_lane_id", validation::Severity::warning,
      "a section does not have one centre lane of id 0"},
     broken_centres},
    {{"lane.centre-width", "asam.net:xodr:1.4.0:road.lane.center_lane_no_width",
      validation::Severity::warning, "a centre lane has a width"},
     wide_centres},
    {{"lane.level", "asam.net:xodr:1.7.0:road.lane.level_true_one_side",
      validation::Severity::error, "a lane is not level although one further in is"},
     level_inside},
    {{"lane.access-mixed", "asam.net:xodr:1.7.0:road.lane.access.no_mix_of_deny_or_allow",
      validation::Severity::error, "a lane allows and denies access at the same place"},
     mixed_access},
    {{"lane.border-crossing", "asam.net:xodr:1.4.0:road.lane.border.overlap_with_inner_lanes",
      validation::Severity::error, "a lane's border crosses that of the lane inside of it"},
     crossing_borders},
}};

}  // namespace

std::span<const SourceRule> lane_rules() { return kLaneRules; }

}  // namespace roadbed::map::opendrive::rules
