#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/geometry/curves/plan_view.h"
#include "roadbed/map/files/xml.h"
#include "roadbed/map/opendrive/document.h"
#include "roadbed/map/validation/rule.h"

namespace roadbed::map::opendrive::rules {

/// A curve of a reference line, with its ends as it gives them itself.
struct CurveSource {
  const GeometryRecord& record;
  std::optional<geometry::PlanPoint> start, end;  ///< none if its numbers are broken

  pugi::xml_node node() const { return record.node; }
};

/// A road with the ends of its curves.
struct RoadSource {
  const RoadRecord& record;
  std::vector<CurveSource> geometry;

  std::string element() const { return "road " + record.id; }
  /// Where the road is, for findings without a place of their own.
  std::optional<Eigen::Vector2d> place() const;
  std::optional<Eigen::Vector2d> place_at(double s_m) const;
  /// Where a section ends: at the one listed after it.
  double end_s_m(const LaneSection& section) const;
};

/// What a schema would complain of.
struct SchemaFault {
  enum class Kind {
    missing_element,
    missing_attribute,
    not_a_number,
    unknown_value,
    incomplete,
    invalid_value
  } kind;
  pugi::xml_node node;
  std::string message;

  static constexpr std::size_t kKinds = 6;
};

/// A document, as the file lists it, with what rules look up in it.
struct Source {
  Source(const XmlDocument& xml, const Document& document);

  const XmlDocument& xml;
  const Document& document;
  std::vector<RoadSource> roads;
  std::map<std::string_view, const RoadSource*> road_by_id;          ///< the first of each id
  std::map<std::string_view, const JunctionRecord*> junction_by_id;  ///< the first of each id
  std::vector<SchemaFault> schema_faults;

  const RoadSource* find_road(std::string_view id) const;
  /// Whether the file is of revision 1.`minor` of the standard or a later one, or of none.
  bool is_since(int minor) const;
  /// Of an attribute, NaN if it is missing or broken.
  double number(pugi::xml_node node, const char* attribute) const;
};

/// Records of a profile whose numbers are whole, in the order in which they hold.
std::vector<CubicElement> whole(const std::vector<CubicElement>& listed);

struct SourceRule {
  validation::RuleInfo info;
  void (*check)(const Source& source, const validation::ValidateOptions& options,
                validation::Report& report);
};

/// What is missing, broken or unknown, by the table of the standard's elements.
std::vector<SchemaFault> find_schema_faults(const XmlDocument& xml);

std::span<const SourceRule> schema_rules();         ///< elements, attributes, values
std::span<const SourceRule> header_rules();         ///< revision, CRS
std::span<const SourceRule> id_rules();             ///< unique ids, references
std::span<const SourceRule> curve_rules();          ///< the reference line
std::span<const SourceRule> record_rules();         ///< where records of profiles begin
std::span<const SourceRule> profile_rules();        ///< elevation, superelevation, lane offset
std::span<const SourceRule> width_rules();          ///< widths and borders of lanes
std::span<const SourceRule> lane_rules();           ///< sections and lanes
std::span<const SourceRule> linkage_rules();        ///< links of roads and lanes
std::span<const SourceRule> lane_linkage_rules();   ///< what linked lanes owe each other
std::span<const SourceRule> junction_rules();       ///< connections
std::span<const SourceRule> redundancy_rules();     ///< what is said twice
std::span<const SourceRule> signal_rules();         ///< signals, controllers, objects, speeds
std::span<const SourceRule> signal_board_rules();   ///< boards of several signs
std::span<const SourceRule> object_rules();         ///< outlines, skeletons, markings of objects
std::span<const SourceRule> object_type_rules();    ///< what objects of a type may have
std::span<const SourceRule> cross_section_rules();  ///< strips of a road's surface

/// All of the above.
std::vector<SourceRule> source_rules();

/// What all rules find in a document.
std::vector<validation::Finding> check(const XmlDocument& xml, const Document& document,
                                       const validation::ValidateOptions& options);

/// Marks the remarks of the reader that say what the text's rules found: about a line that has a
/// finding, or about links of a road whose links have one.
void mark_told(std::vector<ImportDiagnostic>& remarks,
               const std::vector<validation::Finding>& findings);

validation::ElementLines element_lines(const XmlDocument& xml, const Document& document);

/// "lane 12/0/-1": road, index of the section, lane.
std::string lane_element(const RoadSource& road, const LaneSection& section, int lane);

/// The finding's element, line and place in one go.
validation::Finding& add_at(validation::Report& report, const Source& source,
                            const RoadSource& road, pugi::xml_node node, std::string message);

}  // namespace roadbed::map::opendrive::rules
