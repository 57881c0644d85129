// Every rule about CommonRoad's text: silent on a faultless file, and speaking up at one slip.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "roadbed/map/commonroad/rules/rules.h"
#include "roadbed/map/files/xml.h"
#include "roadbed/map/formats.h"
#include "roadbed/tests/support/slips.h"

namespace roadbed::map::validation {
namespace {

std::string bound(const char* name, double y_m, int from_x_m) {
  std::string text = std::string("<") + name + ">";
  for (const int x_m : {from_x_m, from_x_m + 50}) {
    text += "<point><x>" + std::to_string(x_m) + "</x><y>" + std::to_string(y_m) + "</y></point>";
  }
  return text + "</" + name + ">";
}

std::string lanelet(const std::string& id, int from_x_m, double y_m, const std::string& links) {
  return "<lanelet id=\"" + id + "\">" + bound("leftBound", y_m + 3.5, from_x_m) +
         bound("rightBound", y_m, from_x_m) + links + "</lanelet>\n";
}

/// Two lanelets eastwards, one behind the other, and one beside the first.
std::string clean_file() {
  return "<commonRoad commonRoadVersion=\"2020a\" timeStepSize=\"0.1\">\n" +
         lanelet("1", 0, 0.0,
                 R"(<successor ref="2"/><adjacentLeft ref="3" drivingDir="same"/>)"
                 R"(<stopLine><trafficSignRef ref="9"/></stopLine><trafficSignRef ref="9"/>)") +
         lanelet("2", 50, 0.0, R"(<predecessor ref="1"/>)") +
         lanelet("3", 0, 3.5, R"(<adjacentRight ref="1" drivingDir="same"/>)") +
         "<trafficSign id=\"9\"/>\n"
         "<intersection id=\"8\"><incoming id=\"7\"><incomingLanelet ref=\"1\"/>"
         "<successorsStraight ref=\"2\"/></incoming></intersection>\n</commonRoad>\n";
}

std::vector<tests::Slip> slips() {
  return {
      {"common-road.version", "2020a", "1999z"},
      {"common-road.duplicate-id", R"(<lanelet id="3">)", R"(<lanelet id="2">)"},
      {"common-road.dangling-reference", R"(<successor ref="2"/>)", R"(<successor ref="22"/>)"},
      {"common-road.successor-one-sided", R"(<predecessor ref="1"/>)", ""},
      {"common-road.adjacency-one-sided", R"(<adjacentRight ref="1" drivingDir="same"/>)",
       R"(<adjacentRight ref="1" drivingDir="opposite"/>)"},
      {"common-road.uneven-borders", "<leftBound>",
       "<leftBound><point><x>-1</x><y>3.5</y></point>"},
      {"common-road.stop-line-without-reference",
       R"(<stopLine><trafficSignRef ref="9"/></stopLine><trafficSignRef ref="9"/>)", "<stopLine/>"},
      {"common-road.dangling-stop-line", R"(<stopLine><trafficSignRef ref="9"/>)",
       R"(<stopLine><trafficSignRef ref="99"/>)"},
      {"common-road.unused-sign",
       R"(<stopLine><trafficSignRef ref="9"/></stopLine><trafficSignRef ref="9"/>)", ""},
      {"common-road.intersection", R"(<successorsStraight ref="2"/>)",
       R"(<successorsStraight ref="22"/>)"},
  };
}

TEST(CommonRoadRules, FindNothingInAFaultlessFile) {
  for (const Finding& finding :
       format_of(clean_file())->judge(clean_file(), "file.xml", {}).findings) {
    ADD_FAILURE() << finding.rule << ": " << finding.element << ": " << finding.message;
  }
}

TEST(CommonRoadRules, FindEverySlipAndSayWhereItIs) {
  tests::expect_each_is_found(slips(), clean_file(), "file.xml");
}

TEST(CommonRoadRules, SayOnceWhatTheReaderSeesToo) {
  tests::expect_each_is_found_once(
      {"common-road.duplicate-id", "common-road.dangling-reference",
       "common-road.successor-one-sided", "common-road.uneven-borders", "common-road.intersection"},
      slips(), clean_file(), "file.xml");
}

TEST(CommonRoadRules, AreAllTried) {
  tests::expect_all_are_tried(slips(), commonroad::rules::source_rules());
}

}  // namespace
}  // namespace roadbed::map::validation
