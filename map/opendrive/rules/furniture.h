#pragma once

#include <cmath>
#include <string>
#include <utility>

#include "roadbed/map/opendrive/rules/source.h"

namespace roadbed::map::opendrive::rules {

/// "signal 12", "object 7".
inline std::string thing_name(pugi::xml_node node) {
  return std::string(node.name()) + " " + node.attribute("id").value();
}

/// Calls `check(road, node)` for every signal ("signals", "signal"), or object, of every road.
template <typename Check>
void for_each_thing(const Source& source, const char* parent, const char* name,
                    const Check& check) {
  for (const RoadSource& road : source.roads) {
    for (const auto node : road.record.node.child(parent).children(name)) check(road, node);
  }
}

/// A finding about a signal or an object, placed at its s; its line is that of `at`, the thing or
/// an element in it.
inline validation::Finding& add_thing(validation::Report& report, const Source& source,
                                      const RoadSource& road, pugi::xml_node thing,
                                      std::string message, pugi::xml_node at = {}) {
  validation::Finding& finding = add_at(report, source, road, at ? at : thing, std::move(message));
  finding.element = thing_name(thing);
  const double s_m = source.number(thing, "s");
  if (!std::isnan(s_m)) finding.in_map = road.place_at(s_m);
  return finding;
}

}  // namespace roadbed::map::opendrive::rules
