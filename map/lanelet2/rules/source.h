#pragma once

#include <Eigen/Core>
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/lanelet2/build_map.h"
#include "roadbed/map/validation/rule.h"

namespace roadbed::map::lanelet2::rules {

/// Where a lanelet begins, or where it ends: the nodes of its two borders.
struct Edge {
  std::uint32_t left = 0, right = 0;  ///< places in Document::nodes
  auto operator<=>(const Edge&) const = default;
};

/// A relation of type lanelet, with its ends in driving direction where a lane is made of it.
struct Lanelet {
  const Relation& relation;
  std::optional<Edge> start, end;

  std::string_view tag(std::string_view key) const;
};

/// A document, with what rules look up in it.
struct Source {
  /// @param built  of the document; without lanes where none could be built.
  Source(const Document& document, const BuiltLanes& built);

  const Document& document;
  std::vector<Lanelet> lanelets;
  std::vector<const Relation*> regulations;

  /// In the source's coordinates; none without local_x and local_y.
  std::optional<Eigen::Vector2d> local_place(std::uint32_t node) const;
};

/// One-way lanelets that run against those before and behind them. One that begins or ends in a
/// point, where it has no sides, is none.
std::vector<const Lanelet*> lanelets_with_swapped_borders(const Source& source);

struct SourceRule {
  validation::RuleInfo info;
  void (*check)(const Source& source, const validation::ValidateOptions& options,
                validation::Report& report);
};

std::span<const SourceRule> element_rules();  ///< nodes, ways, relations: ids, references, places
std::span<const SourceRule> lanelet_rules();  ///< lanelets and their borders
std::span<const SourceRule> regulation_rules();  ///< regulatory elements

/// All of the above.
std::vector<SourceRule> source_rules();

/// What all rules find in a document.
std::vector<validation::Finding> check(const Document& document, const BuiltLanes& built,
                                       const validation::ValidateOptions& options);

validation::ElementLines element_lines(const Document& document);

/// A finding about an element of the file, with its line.
validation::Finding& add_at(validation::Report& report, const Source& source, const Node& node,
                            std::string message);
validation::Finding& add_at(validation::Report& report, const Source& source, const Way& way,
                            std::string message);
validation::Finding& add_at(validation::Report& report, const Source& source,
                            const Relation& relation, std::string message);
/// The same about the lane that a lanelet is.
validation::Finding& add_at(validation::Report& report, const Source& source,
                            const Lanelet& lanelet, std::string message);

}  // namespace roadbed::map::lanelet2::rules
