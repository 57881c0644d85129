#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/validation/finding.h"
#include "roadbed/map/validation/rule_choice.h"

namespace roadbed::map::validation {

/// Above these a rule speaks up.
struct ValidateOptions {
  double max_gap_m = 0.01;                     ///< between the ends of linked lanes
  double max_kink_rad = 0.05;                  ///< between the headings of linked centrelines
  double max_step_m = 0.02;                    ///< of elevation, width or lane offset
  double max_slope_jump = 0.05;                ///< between the slopes of two elevation records
  double max_slope = 0.3;                      ///< of the road's elevation
  double max_curvature_per_m = 0.4;            ///< of a drivable lane's centreline
  double max_curvature_jump_per_m = 0.25;      ///< between two curves of a reference line
  double max_speed_mps = 70.0;                 ///< of a speed limit
  double max_lateral_acceleration_mps2 = 8.0;  ///< at the speed limit in a bend
  double max_signal_distance_m = 50.0;         ///< from the nearest lane
  double max_object_distance_m = 100.0;        ///< from the nearest lane
  double min_overlap_m = 5.0;                  ///< along lanes that should not overlap
  double min_tagged_speed_kmph = 10.0;         ///< Autoware's range of speed_limit tags
  double max_tagged_speed_kmph = 50.0;
  double max_error_m = 1e-3;  ///< chord error of the lines that rules look at
  RuleChoice choice = {};     ///< which rules, and how grave
};

/// Line of each element that findings name: "road 12", "lane 12/0/-1", "lanelet 4".
using ElementLines = std::map<std::string, long, std::less<>>;

/// Patterns of the rules that the map itself says not to look at an element with; those of "map"
/// count for all elements.
using Suppressions = std::map<std::string, std::vector<std::string>, std::less<>>;

/// Takes the findings of one rule; a file can be made to have more than memory holds, so those
/// past the first thousand are only counted, which a last finding says.
class Report {
 public:
  /// Puts what a rule finds behind other findings; both are kept by reference.
  Report(const RuleInfo& rule, std::vector<Finding>& findings)
      : rule_(&rule), findings_(&findings) {}

  /// @param message  what was found, what is needed, what to do.
  /// @returns the finding, for what is particular about it; valid until the next one is added.
  Finding& add(std::string element, std::optional<Eigen::Vector2d> in_map, std::string message);

  /// Autoware's name of the rule's issue with that number: "Lane.BorderSharing-001".
  std::string autoware_issue(int number) const;

  /// To be called when the rule is through: says how many findings were only counted.
  void finish();

  static constexpr std::size_t kMost = 1000;

 private:
  const RuleInfo* rule_;
  std::vector<Finding>* findings_;
  std::size_t count_ = 0;
  Finding uncounted_;  ///< stands for those past the most
};

/// What those of a list of rules find that are asked for: each has an `info`, and a `check` of what
/// they all look at.
template <typename Rules, typename Source>
std::vector<Finding> findings_of(const Rules& rules, const Source& source,
                                 const ValidateOptions& options) {
  std::vector<Finding> findings;
  for (const auto& rule : rules) {
    if (!options.choice.asks_for(rule.info)) continue;
    Report report(rule.info, findings);
    rule.check(source, options, report);
    report.finish();
  }
  return findings;
}

}  // namespace roadbed::map::validation
