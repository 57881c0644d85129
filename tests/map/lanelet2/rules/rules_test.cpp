// Every rule about Lanelet2's text: silent on a faultless file, and speaking up at one slip.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "roadbed/map/files/xml.h"
#include "roadbed/map/formats.h"
#include "roadbed/map/lanelet2/rules/source.h"
#include "roadbed/tests/support/slips.h"

namespace roadbed::map::validation {
namespace {

/// Nodes `first` … `first` + 3 at x = 0, 10, 20, 30 and one y, ten metres apart.
std::string nodes(int first, double y_m) {
  std::string text;
  for (int i = 0; i < 4; ++i) {
    text += "<node id=\"" + std::to_string(first + i) +
            "\" lat=\"49\" lon=\"8\"><tag k=\"local_x\" v=\"" + std::to_string(10 * i) +
            "\"/><tag k=\"local_y\" v=\"" + std::to_string(y_m) + "\"/></node>\n";
  }
  return text;
}

std::string way(const std::string& id, const std::string& from, const std::string& to) {
  return "<way id=\"" + id + "\"><nd ref=\"" + from + "\"/><nd ref=\"" + to +
         "\"/><tag k=\"type\" v=\"line_thin\"/></way>\n";
}

std::string lanelet(const std::string& id, const std::string& left, const std::string& right) {
  return "<relation id=\"" + id + "\"><member type=\"way\" ref=\"" + left +
         "\" role=\"left\"/><member type=\"way\" ref=\"" + right +
         "\" role=\"right\"/><member type=\"relation\" ref=\"900\" role=\"regulatory_element\"/>"
         "<tag k=\"type\" v=\"lanelet\"/><tag k=\"subtype\" v=\"road\"/>"
         "<tag k=\"location\" v=\"urban\"/><tag k=\"speed_limit\" v=\"50 km/h\"/></relation>\n";
}

/// Three lanelets eastwards, one behind the other.
std::string clean_file() {
  return "<osm version=\"0.6\">\n" + nodes(30, 3.5) + nodes(40, 0.0) +
         "<node id=\"50\" lat=\"49\" lon=\"8.001\"/>\n" + way("10", "30", "31") +
         way("11", "31", "32") + way("12", "32", "33") + way("20", "40", "41") +
         way("21", "41", "42") + way("22", "42", "43") + lanelet("100", "10", "20") +
         lanelet("101", "11", "21") + lanelet("102", "12", "22") +
         "<relation id=\"900\"><member type=\"way\" ref=\"10\" role=\"refers\"/>"
         "<tag k=\"type\" v=\"regulatory_element\"/><tag k=\"subtype\" v=\"speed_limit\"/>"
         "</relation>\n</osm>\n";
}

std::vector<tests::Slip> slips() {
  const std::string middle_left = R"(<member type="way" ref="11" role="left"/>)";
  const std::string middle_right = R"(<member type="way" ref="21" role="right"/>)";
  return {
      {"lanelet2.duplicate-id", R"(<way id="11">)", R"(<way id="10">)"},
      {"lanelet2.dangling-member", R"(ref="11" role)", R"(ref="77" role)"},
      {"lanelet2.dangling-area", R"(<tag k="location" v="urban"/>)",
       R"(<tag k="location" v="urban"/><tag k="intersection_area" v="77"/>)"},
      {"lanelet2.missing-border", middle_left, ""},
      {"lanelet2.short-way", R"(<nd ref="32"/>)", ""},
      {"lanelet2.no-subtype", R"(<tag k="subtype" v="road"/>)", ""},
      {"lanelet2.no-participant", R"(v="road")", R"(v="racetrack")"},
      {"lanelet2.no-location", R"(<tag k="location" v="urban"/>)", ""},
      {"lanelet2.unknown-regulation", R"(v="speed_limit")", R"(v="honk")"},
      {"lanelet2.regulation-without-refers", R"(role="refers")", R"(role="cancels")"},
      {"lanelet2.unused-regulation", R"(<relation id="900">)", R"(<relation id="901">)"},
      {"lanelet2.swapped-borders", middle_left + middle_right,
       R"(<member type="way" ref="21" role="left"/><member type="way" ref="11" role="right"/>)"},
      {"lanelet2.unshared-border", R"(<way id="11"><nd ref="31"/>)",
       "<node id=\"51\" lat=\"49\" lon=\"8\"><tag k=\"local_x\" v=\"10.02\"/><tag k=\"local_y\" "
       "v=\"3.5\"/></node><way id=\"11\"><nd ref=\"51\"/>"},
      {"lanelet2.zero-coordinates", R"(lat="49" lon="8.001")", R"(lat="0" lon="0")"},
      {"lanelet2.broken-coordinates", R"(lat="49" lon="8.001")", R"(lat="149" lon="8")"},
      {"lanelet2.border-without-type", R"(<tag k="type" v="line_thin"/>)", ""},
      {"lanelet2.broken-speed", R"(v="50 km/h")", R"(v="fifty")"},
  };
}

TEST(Lanelet2Rules, FindNothingInAFaultlessFile) {
  for (const Finding& finding :
       format_of(clean_file())->judge(clean_file(), "file.osm", {}).findings) {
    ADD_FAILURE() << finding.rule << ": " << finding.element << ": " << finding.message;
  }
}

TEST(Lanelet2Rules, FindEverySlipAndSayWhereItIs) {
  tests::expect_each_is_found(slips(), clean_file(), "file.osm");
}

TEST(Lanelet2Rules, SayOnceWhatTheReaderSeesToo) {
  tests::expect_each_is_found_once({"lanelet2.dangling-member", "lanelet2.missing-border"}, slips(),
                                   clean_file(), "file.osm");
}

TEST(Lanelet2Rules, AreAllTried) {
  tests::expect_all_are_tried(slips(), lanelet2::rules::source_rules());
}

TEST(Lanelet2Rules, PassOverWhatAnEditorDeleted) {
  std::string text = clean_file();
  text.insert(text.find("<way"), R"(<way id="99" action="delete"></way>)");
  EXPECT_TRUE(tests::source_findings(text, "file.osm", "lanelet2.short-way").empty());
}

TEST(Lanelet2Rules, LeaveALaneletAloneThatBeginsAndEndsInAPoint) {
  std::string text = clean_file();
  text.insert(text.find("<relation"), way("23", "41", "42"));
  text.insert(text.find("<way"), nodes(60, -3.0));
  text.insert(text.find("<relation"),
              "<way id=\"24\"><nd ref=\"41\"/><nd ref=\"61\"/><nd ref=\"42\"/>"
              "<tag k=\"type\" v=\"line_thin\"/></way>\n" +
                  lanelet("103", "23", "24"));
  EXPECT_TRUE(tests::source_findings(text, "file.osm", "lanelet2.swapped-borders").empty());
}

TEST(Lanelet2Rules, LeaveALaneletsOwnCornersApartWhereItHasNoWidth) {
  std::string text = clean_file();
  const std::size_t corner = text.find("0.000000", text.find("<node id=\"43\""));
  text.replace(corner, 8, "3.450000");
  EXPECT_TRUE(tests::source_findings(text, "file.osm", "lanelet2.unshared-border").empty());
}

TEST(Lanelet2Rules, TakeTwoWayLaneletsForWhatTheyAre) {
  std::string text = clean_file();
  const std::string road = R"(<tag k="type" v="lanelet"/>)";
  for (std::size_t at = text.find(road); at != std::string::npos; at = text.find(road, at + 60)) {
    text.insert(at, R"(<tag k="one_way" v="no"/>)");
  }
  EXPECT_TRUE(tests::source_findings(text, "file.osm", "lanelet2.swapped-borders").empty());
}

}  // namespace
}  // namespace roadbed::map::validation
