#pragma once

#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/opendrive/rules/source.h"

namespace roadbed::map::opendrive::rules {

using Cubics = std::vector<CubicElement>;

/// Records of a profile up to `end_s_m`, without those that hold nowhere: of several at one station
/// all but the last, and what begins at the end or beyond it.
Cubics holding(const std::vector<CubicElement>& listed, double end_s_m);

/// Calls `check(record, length, next)` for every record; `next` is null for the last one.
template <typename Check>
void for_each_record(const Cubics& records, double end_s_m, const Check& check) {
  for (std::size_t i = 0; i < records.size(); ++i) {
    const CubicElement* next = i + 1 < records.size() ? &records[i + 1] : nullptr;
    const double length_m = (next ? next->record.s_m : end_s_m) - records[i].record.s_m;
    if (length_m >= 0.0) check(records[i], length_m, next);
  }
}

/// Calls `check(road, section, lane)` for every lane but the centre one.
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

/// A finding about a record, placed at a station.
validation::Finding& add_record(validation::Report& report, const Source& source,
                                const RoadSource& road, const CubicElement& record, double s_m,
                                std::string message);

}  // namespace roadbed::map::opendrive::rules
