#pragma once

#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "roadbed/map/files/xml.h"
#include "roadbed/map/validation/rule.h"

// A CommonRoad file (2018b, 2020a) as it stands, faults and all.

namespace roadbed::map::commonroad::rules {

using ById = std::unordered_map<std::string_view, pugi::xml_node>;

struct Source {
  explicit Source(const XmlDocument& document);

  const XmlDocument& xml;
  ById lanelets, signs, lights;  ///< the first of each id
};

struct SourceRule {
  validation::RuleInfo info;
  void (*check)(const Source& source, const validation::ValidateOptions& options,
                validation::Report& report);
};

std::span<const SourceRule> source_rules();

validation::ElementLines element_lines(const XmlDocument& xml);

}  // namespace roadbed::map::commonroad::rules
