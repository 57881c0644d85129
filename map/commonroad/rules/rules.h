#pragma once

#include <span>
#include <vector>

#include "roadbed/map/commonroad/document.h"
#include "roadbed/map/validation/rule.h"

namespace roadbed::map::commonroad::rules {

struct SourceRule {
  validation::RuleInfo info;
  void (*check)(const Document& document, const validation::ValidateOptions& options,
                validation::Report& report);
};

std::span<const SourceRule> source_rules();

/// What all rules find in a document.
std::vector<validation::Finding> check(const Document& document,
                                       const validation::ValidateOptions& options);

validation::ElementLines element_lines(const Document& document);

}  // namespace roadbed::map::commonroad::rules
