#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/geometry/curves/piecewise_cubic.h"
#include "roadbed/geometry/curves/plan_view.h"
#include "roadbed/map/files/xml.h"
#include "roadbed/map/validation/rule.h"

// An OpenDRIVE document as it stands, faults and all. Numbers that are missing or broken are NaN:
// comparisons with them are false, so that one fault is not found by many rules.

namespace roadbed::map::opendrive::rules {

/// <geometry>, with its ends as its own curve gives them.
struct GeometrySource {
  pugi::xml_node node;
  double s_m = 0.0, length_m = 0.0;
  std::optional<geometry::PlanPiece> piece;  ///< none if its numbers are broken
  std::optional<geometry::PlanPoint> start, end;
};

/// A cubic record of a profile (elevation, width, …), with the element that holds it.
struct CubicSource {
  pugi::xml_node node;
  geometry::CubicRecord record;
};

struct LaneSource {
  pugi::xml_node node;
  std::string_view side;  ///< "left", "center" or "right"
  int id = 0;
  std::vector<int> predecessors, successors;
};

struct SectionSource {
  pugi::xml_node node;
  double s_m = 0.0, end_s_m = 0.0;
  std::vector<LaneSource> lanes;  ///< as listed; those without a whole number for an id left out
  std::vector<std::pair<int, std::size_t>> by_id;  ///< ids with their places among the lanes

  /// The first lane of that id.
  const LaneSource* find(int id) const;
  /// Whether it counts for the one side only that it has lanes on.
  bool is_single_sided() const { return node.attribute("singleSide").as_bool(); }
};

struct RoadSource {
  pugi::xml_node node;
  std::string id;
  std::string junction;  ///< empty outside of junctions
  double length_m = 0.0;
  std::vector<GeometrySource> geometry;
  std::vector<SectionSource> sections;

  std::string element() const { return "road " + id; }
  /// Where the road is, for findings without a place of their own.
  std::optional<Eigen::Vector2d> place() const;
  std::optional<Eigen::Vector2d> place_at(double s_m) const;
};

/// What a schema would complain of.
struct SchemaFault {
  enum class Kind { missing_element, missing_attribute, not_a_number, unknown_value } kind;
  pugi::xml_node node;
  std::string message;
};

struct Source {
  explicit Source(const XmlDocument& document);

  const XmlDocument& xml;
  std::vector<RoadSource> roads;
  std::map<std::string_view, const RoadSource*> road_by_id;  ///< the first of each id
  std::vector<pugi::xml_node> junctions;
  std::map<std::string_view, pugi::xml_node> junction_by_id;
  std::vector<SchemaFault> schema_faults;

  const RoadSource* find_road(std::string_view id) const;
  double number(pugi::xml_node node, const char* attribute) const;
  std::vector<CubicSource> cubics(pugi::xml_node parent, const char* name, const char* s_attribute,
                                  double s_add_m) const;
};

struct SourceRule {
  validation::RuleInfo info;
  void (*check)(const Source& source, const validation::ValidateOptions& options,
                validation::Report& report);
};

/// What is missing, broken or unknown, by a table of the standard's elements.
std::vector<SchemaFault> find_schema_faults(const XmlDocument& xml);

std::span<const SourceRule> schema_rules();      ///< elements, attributes, values
std::span<const SourceRule> header_rules();      ///< revision, CRS
std::span<const SourceRule> id_rules();          ///< unique ids, references
std::span<const SourceRule> curve_rules();       ///< the reference line
std::span<const SourceRule> profile_rules();     ///< elevation, superelevation, lane offset, width
std::span<const SourceRule> lane_rules();        ///< sections and lanes
std::span<const SourceRule> linkage_rules();     ///< links of roads and lanes
std::span<const SourceRule> junction_rules();    ///< connections
std::span<const SourceRule> redundancy_rules();  ///< what is said twice
std::span<const SourceRule> signal_rules();      ///< signals, controllers, objects, speeds

/// All of the above.
std::vector<SourceRule> source_rules();

validation::ElementLines element_lines(const XmlDocument& xml);

/// "lane 12/0/-1": road, index of the section, lane.
std::string lane_element(const RoadSource& road, const SectionSource& section, int lane);

/// The finding's element, line and place in one go.
validation::Finding& add_at(validation::Report& report, const Source& source,
                            const RoadSource& road, pugi::xml_node node, std::string message);

}  // namespace roadbed::map::opendrive::rules
