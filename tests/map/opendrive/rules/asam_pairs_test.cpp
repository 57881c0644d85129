// ASAM's own valid and invalid files, whose names say what is to be found.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "roadbed/map/validate_file.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map::validation {
namespace {

struct Pair {
  const char* file;
  const char* asam_rule;  ///< that the file is about, without what all of them begin with
  bool valid;
};

std::ostream& operator<<(std::ostream& out, const Pair& pair) { return out << pair.file; }

constexpr const char* kGaps = "1.7.0:lane_smoothness.contact_point_no_horizontal_gaps";
constexpr const char* kLevel = "1.7.0:road.lane.level_true_one_side";
constexpr const char* kSchema = "1.0.0:xml.valid_schema";
constexpr const char* kVersion = "1.0.0:xml.version_is_defined";
constexpr const char* kLength = "1.7.0:road.geometry.parampoly3.length_match";
constexpr const char* kAcross = "1.4.0:road.lane.link.lanes_across_lane_sections";
constexpr const char* kStart = "1.7.0:junctions.connection.start_along_linkage";
constexpr const char* kEnd = "1.7.0:junctions.connection.end_opposite_linkage";
constexpr const char* kContact = "1.7.0:road.geometry.contact_point";

constexpr Pair kPairs[] = {
    {"road_lane_level_true_one_side/road_lane_level_true_one_side_valid", kLevel, true},
    {"road_lane_level_true_one_side/road_lane_level_true_one_side_invalid", kLevel, false},
    // The rule is of revision 1.7, the file of 1.6: there is a note, without ASAM's name.
    {"road_lane_level_true_one_side/road_lane_level_true_one_side_invalid_older_schema_version",
     kLevel, true},
    {"valid_schema/positive18", kSchema, true},
    {"valid_schema/negative16", kSchema, false},
    {"valid_schema/negative17", kSchema, false},
    {"valid_schema/negative18", kSchema, false},
    {"valid_schema/unsupported_schema", kSchema, false},
    {"road_geometry_param_poly3_length_match/road_geometry_param_poly3_length_match_valid", kLength,
     true},
    {"road_geometry_param_poly3_length_match/road_geometry_param_poly3_length_match_invalid",
     kLength, false},
    {"road_geometry_param_poly3_length_match/"
     "road_geometry_param_poly3_length_match_invalid_multiple_cases",
     kLength, false},
    {"road_lane_link_lanes_across_lane_sections/road_lane_link_lanes_across_lane_sections_valid",
     kAcross, true},
    {"road_lane_link_lanes_across_lane_sections/"
     "road_lane_link_lanes_across_lane_sections_invalid_wrong_id",
     kAcross, false},
    {"road_lane_link_lanes_across_lane_sections/"
     "road_lane_link_lanes_across_lane_sections_invalid_non_existing_lanes",
     kAcross, false},
    {"road_lane_link_lanes_across_lane_sections/"
     "road_lane_link_lanes_across_lane_sections_invalid_no_predecessor_road",
     kAcross, false},
    {"valid_xml_document/xml.valid_xml_document.negative", "1.0.0:xml.valid_xml_document", false},
    {"junction_connection_linkage/junction_connection_linkage_valid", kStart, true},
    {"junction_connection_linkage/junction_connection_linkage_valid", kEnd, true},
    {"junction_connection_linkage/junction_connection_linkage_invalid", kStart, false},
    {"junction_connection_linkage/junction_connection_linkage_invalid", kEnd, false},
    {"smoothness_example/simple_valid", kGaps, true},
    {"smoothness_example/junction_valid_conn_smoothness", kGaps, true},
    {"smoothness_example/multiple_successor_valid", kGaps, true},
    {"smoothness_example/junction_invalid_conn_smoothness", kGaps, false},
    {"smoothness_example/multiple_successor_invalid", kGaps, false},
    {"smoothness_example/many_invalid", kGaps, false},
    {"road_geometry_contact_point/valid_1", kContact, true},
    {"road_geometry_contact_point/valid_2", kContact, true},
    {"road_geometry_contact_point/valid_3", kContact, true},
    {"road_geometry_contact_point/invalid", kContact, false},
    {"road_geometry_contact_point/invalid_2", kContact, false},
    {"version_is_defined/negative_no_attr", kVersion, false},
    {"version_is_defined/negative_no_type", kVersion, false},
};

class AsamPairs : public ::testing::TestWithParam<Pair> {};

TEST_P(AsamPairs, AreToldApart) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const Pair& pair = GetParam();
  const auto file = folder / "opendrive/asam-ev+qc-opendrive" / (std::string(pair.file) + ".xodr");
  const auto findings = validate_file(file).findings;
  const std::string rule = std::string("asam.net:xodr:") + pair.asam_rule;
  const auto found = std::find_if(findings.begin(), findings.end(), [&](const Finding& finding) {
    return finding.asam_rule == rule;
  });
  if (pair.valid) {
    EXPECT_TRUE(found == findings.end()) << found->element << ": " << found->message;
  } else {
    EXPECT_TRUE(found != findings.end());
  }
}

INSTANTIATE_TEST_SUITE_P(Files, AsamPairs, ::testing::ValuesIn(kPairs));

}  // namespace
}  // namespace roadbed::map::validation
