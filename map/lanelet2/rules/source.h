#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "roadbed/map/files/xml.h"
#include "roadbed/map/validation/rule.h"

// A Lanelet2 file (OSM XML) as it stands, faults and all.

namespace roadbed::map::lanelet2::rules {

using ById = std::unordered_map<std::string_view, pugi::xml_node>;
using Nodes = std::vector<std::string_view>;  ///< ids

/// The value of a tag of an element, empty if it has none.
std::string_view tag(pugi::xml_node element, std::string_view key);

/// A relation of type lanelet with its borders in driving direction.
struct Lanelet {
  pugi::xml_node node;
  Nodes left, right;  ///< empty if a border is missing or broken

  std::string element() const;
};

struct Source {
  explicit Source(const XmlDocument& document);

  const XmlDocument& xml;
  /// In the order of the file; what an editor marked as deleted is left out.
  std::vector<pugi::xml_node> node_list, way_list, relation_list;
  ById nodes, ways, relations;  ///< the first of each id
  std::vector<Lanelet> lanelets;
  std::vector<pugi::xml_node> regulations;

  /// In local_x and local_y where the node has them, else metres about the first node's latitude:
  /// good for comparing places, but not the map's coordinates.
  std::optional<Eigen::Vector2d> place(std::string_view node) const;
  /// The map's coordinates; none without local_x and local_y.
  std::optional<Eigen::Vector2d> local_place(std::string_view node) const;

 private:
  void read(pugi::xml_node element);
  Nodes border(pugi::xml_node relation, std::string_view role);
  Lanelet lanelet(pugi::xml_node relation);

  double first_latitude_rad_ = 0.0;
  std::size_t nodes_left_;  // that borders may repeat: many lanelets may name one long way
};

struct SourceRule {
  validation::RuleInfo info;
  void (*check)(const Source& source, const validation::ValidateOptions& options,
                validation::Report& report);
};

std::span<const SourceRule> lanelet_rules();     ///< lanelets, their borders, nodes and ways
std::span<const SourceRule> regulation_rules();  ///< regulatory elements

/// All of the above.
std::vector<SourceRule> source_rules();

/// A finding about a lanelet, or about any other element, with its line.
validation::Finding& add_at(validation::Report& report, const Source& source,
                            const Lanelet& lanelet, std::string message);
validation::Finding& add_at(validation::Report& report, const Source& source,
                            pugi::xml_node element, std::string message);

validation::ElementLines element_lines(const XmlDocument& xml);

}  // namespace roadbed::map::lanelet2::rules
