// Every rule about OpenDRIVE's text: silent on a faultless file, and speaking up where one thing in
// it is broken.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "roadbed/map/opendrive/rules/source.h"
#include "roadbed/map/validate_file.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/slips.h"

namespace roadbed::map::validation {
namespace {

std::string clean_file() {
  return tests::bytes_of(tests::tests_folder() / "map/opendrive/rules/clean.xodr");
}

std::vector<tests::Slip> slips() {
  const std::string road_2 = "<road name=\"curved\" length=\"110\" id=\"2\"";
  const std::string arc = R"(<arc curvature="0.02"/>)";
  return {
      {"schema.missing-element", R"(<center><lane id="0" type="none" level="false"/></center>)",
       ""},
      {"schema.missing-attribute", R"(hdg="0" length="40")", R"(length="40")"},
      {"schema.not-a-number", arc, R"(<arc curvature="1e999"/>)"},
      {"schema.unknown-value", R"(type="shoulder")", R"(type="hard shoulder")"},
      {"schema.incomplete", R"( junction="-1")", ""},
      {"schema.invalid-value", R"(<offset x="0" y="0" z="0")", R"(<offset x="0" y="0" z="up")"},
      {"header.missing", R"(<header revMajor="1" revMinor="7" name="rules" version="1.00">
  <geoReference>+proj=tmerc +lat_0=48 +lon_0=9 +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m</geoReference>
  <offset x="0" y="0" z="0" hdg="0"/>
 </header>)",
       ""},
      {"header.version", R"(revMinor="7")", R"(revMinor="seven")"},
      {"header.unknown-version", R"(revMinor="7")", R"(revMinor="77")"},
      {"crs.several", "<offset ", "<geoReference>EPSG:25832</geoReference><offset "},
      {"crs.offset", R"(<offset x="0")", R"(<offset x="east")"},
      {"crs.far-from-origin", R"(x="0" y="0" hdg="0" length="40")",
       R"(x="500000" y="0" hdg="0" length="40")"},
      {"id.duplicate", R"(id="9" name="sign")", R"(id="8" name="sign")"},
      {"id.duplicate-lane", R"(<lane id="-2" type="shoulder" level="true">)",
       R"(<lane id="-1" type="shoulder" level="true">)"},
      {"id.dangling-road-link", R"(elementId="2" contactPoint="start")",
       R"(elementId="22" contactPoint="start")"},
      {"id.dangling-junction", R"(junction="10")", R"(junction="11")"},
      {"id.dangling-connection", R"(incomingRoad="2")", R"(incomingRoad="22")"},
      {"id.dangling-signal", R"(signalId="8")", R"(signalId="88")"},
      {"curve.missing", "<controller ",
       R"(<road id="5" length="9" junction="-1"><lanes/></road><controller )"},
      {"curve.order", R"(<geometry s="70")", R"(<geometry s="10")"},
      {"curve.station", R"(<geometry s="70")", R"(<geometry s="71")"},
      {"curve.gap", R"(<geometry s="40" x="40")", R"(<geometry s="40" x="40.2")"},
      {"curve.kink", R"(x="150" y="0" hdg="0")", R"(x="150" y="0" hdg="0.1")"},
      {"curve.curvature-jump", arc, R"(<arc curvature="0.3"/>)"},
      {"curve.zero-length", R"(hdg="0" length="40")", R"(hdg="0" length="0")"},
      {"curve.road-length", R"(length="110")", R"(length="111")"},
      {"curve.absurd-length", R"(length="110")", R"(length="250000")"},
      {"curve.param-poly3-length", R"(bU="10")", R"(bU="11")"},
      {"curve.param-poly3-arc-length", R"(bU="1" )", R"(bU="10" )"},
      {"curve.param-poly3-normalized", R"(bU="10")", R"(bU="1")"},
      {"curve.param-poly3-start", R"(aU="0" bU="10" cU="0" dU="0" aV="0")",
       R"(aU="0" bU="10" cU="0" dU="0" aV="0.1")"},
      {"curve.several-shapes", arc, arc + "<line/>"},
      {"curve.straight-arc", arc, R"(<arc curvature="0"/>)"},
      {"curve.constant-spiral", R"(curvEnd="0")", R"(curvEnd="0.02")"},
      {"profile.order", R"(<elevation s="50")", R"(<elevation s="-50")"},
      {"profile.late-start", R"(<elevation s="0" a="10")", R"(<elevation s="5" a="10")"},
      {"profile.same-station", R"(<elevation s="50" a="10.5")", R"(<elevation s="0" a="10.5")"},
      {"profile.beyond-road", R"(<elevation s="50")", R"(<elevation s="150")"},
      {"elevation.step", R"(s="50" a="10.5")", R"(s="50" a="10.6")"},
      {"elevation.slope-jump", R"(b="0.02" c="0" d="0"/>)", R"(b="0.1" c="0" d="0"/>)"},
      {"elevation.steep", R"(b="0.02" c="0" d="0"/>)", R"(b="0.02" c="0.01" d="0"/>)"},
      {"elevation.outlier", R"(a="11.5")", R"(a="-1000")"},
      {"superelevation.step", R"(s="20" a="0.02")", R"(s="20" a="0.04")"},
      {"superelevation.steep", R"(s="20" a="0.02")", R"(s="20" a="2")"},
      {"lane-offset.step", R"(s="90" a="0")", R"(s="90" a="0.1")"},
      {"width.step", R"(sOffset="20" a="3.5")", R"(sOffset="20" a="3.6")"},
      {"width.negative", R"(sOffset="20" a="3.5" b="0")", R"(sOffset="20" a="3.5" b="-0.2")"},
      {"width.steep", R"(sOffset="20" a="3.5" b="0")", R"(sOffset="20" a="3.5" b="35")"},
      {"width.missing", R"(<width sOffset="0" a="1.50")", R"(<width sOffset="1" a="1.50")"},
      {"width.beyond-section", R"(<width sOffset="20")", R"(<width sOffset="61")"},
      {"width.with-border", R"(<border sOffset="0" a="-5")",
       R"(<width sOffset="0" a="1" b="0" c="0" d="0"/><border sOffset="0" a="-5")"},
      {"width.mixed-side", R"(<border sOffset="0" a="-5" b="0" c="0" d="0"/>)",
       R"(<width sOffset="0" a="1.5" b="0" c="0" d="0"/>)"},
      {"lane-offset.with-border",
       R"(<laneSection s="0">
    <center><lane id="0" type="none" level="false"/></center>
    <right>
     <lane id="-1" type="driving" level="false">
      <border)",
       R"(<laneOffset s="0" a="0" b="0" c="0" d="0"/><laneSection s="0">
    <center><lane id="0" type="none" level="false"/></center>
    <right>
     <lane id="-1" type="driving" level="false">
      <border)"},
      {"width.border-with-offset",
       R"(<laneSection s="0">
    <center><lane id="0" type="none" level="false"/></center>
    <right>
     <lane id="-1" type="driving" level="false">
      <border)",
       R"(<laneOffset s="0" a="1" b="0" c="0" d="0"/><laneSection s="0">
    <center><lane id="0" type="none" level="false"/></center>
    <right>
     <lane id="-1" type="driving" level="false">
      <border)"},
      {"section.missing", "<controller ",
       R"(<road id="5" length="9" junction="-1"><lanes/></road><controller )"},
      {"section.first", "<laneSection s=\"0\">\n    <center>",
       "<laneSection s=\"1\">\n    <center>"},
      {"section.order", R"(<laneSection s="60">)", R"(<laneSection s="-60">)"},
      {"section.zero-length", R"(<laneSection s="60">)", R"(<laneSection s="0">)"},
      {"lane.numbering", R"(<lane id="-2" type="shoulder" level="true">)",
       R"(<lane id="-3" type="shoulder" level="true">)"},
      {"lane.side", R"(<lane id="-2" type="shoulder" level="true">)",
       R"(<lane id="2" type="shoulder" level="true">)"},
      {"lane.centre", R"(<center><lane id="0")", R"(<center><lane id="5")"},
      {"lane.centre-width", R"(<lane id="0" type="none" level="false"/>)",
       R"(<lane id="0" type="none"><width sOffset="0" a="1" b="0" c="0" d="0"/></lane>)"},
      {"lane.level", "<lane id=\"-1\" type=\"driving\" level=\"false\">\n      <border",
       "<lane id=\"-1\" type=\"driving\" level=\"true\">\n      <border"},
      {"lane.level-change", R"(<lane id="-2" type="shoulder" level="true">)",
       R"(<lane id="-2" type="shoulder" level="false">)"},
      {"link.zero-width-start", R"(<width sOffset="0" a="1.50" b="0")",
       R"(<width sOffset="0" a="0" b="0.0375")"},
      {"link.zero-width-end", R"(<width sOffset="0" a="1.5" b="0")",
       R"(<width sOffset="0" a="1.5" b="-0.025")"},
      {"lane.access-mixed", "<access ", "<access sOffset=\"0\" rule=\"deny\"/><access "},
      {"lane.border-crossing", R"(<border sOffset="0" a="-5" b="0")",
       R"(<border sOffset="0" a="-5" b="0.05")"},
      {"link.road-one-sided",
       R"(<predecessor elementType="road" elementId="1" contactPoint="end"/>)", ""},
      {"link.contact-point-missing", R"(elementId="2" contactPoint="start")", R"(elementId="2")"},
      {"link.contact-point-off", R"(elementId="2" contactPoint="start")",
       R"(elementId="2" contactPoint="end")"},
      {"link.ambiguous", R"(<link><predecessor elementType="junction" elementId="10"/></link>)",
       R"(<link><predecessor elementType="road" elementId="2" contactPoint="start"/></link>)"},
      {"link.lane-one-sided", R"(<predecessor id="-2"/><successor id="-2"/>)",
       R"(<successor id="-2"/>)"},
      {"link.lane-without-road",
       R"(<link><successor elementType="road" elementId="2" contactPoint="start"/></link>)", ""},
      {"link.appearing-lane",
       R"(<predecessor id="-2"/><successor id="-2"/></link>
      <width sOffset="0" a="1.50")",
       R"(<predecessor id="-1"/><successor id="-2"/></link>
      <width sOffset="0" a="0")"},
      {"link.roads-without-lanes",
       R"(<link><predecessor id="-1"/><successor id="-1"/></link>
      <width sOffset="0" a="3.5" b="0" c="0" d="0"/>
     </lane>
    </right>)",
       R"(<width sOffset="0" a="3.5" b="0" c="0" d="0"/>
     </lane>
    </right>)"},
      {"junction.no-lane-links", R"(<laneLink from="-1" to="-1"/>)", ""},
      {"junction.incoming-elsewhere", R"(incomingRoad="2")", R"(incomingRoad="1")"},
      {"junction.connecting-comes-in", R"(incomingRoad="2")", R"(incomingRoad="3")"},
      {"junction.double-connection", "</connection>",
       R"(</connection><connection id="1" incomingRoad="2" connectingRoad="3" )"
       R"(contactPoint="start"><laneLink from="-1" to="-1"/></connection>)"},
      {"junction.contact-start", R"(incomingRoad="2")", R"(incomingRoad="4")"},
      {"junction.contact-end", R"(connectingRoad="3" contactPoint="start")",
       R"(connectingRoad="3" contactPoint="end")"},
      {"junction.outgoing-lane-link", R"(<laneLink from="-1" to="-1"/>)",
       R"(<laneLink from="1" to="-1"/>)"},
      {"junction.priority-pair", R"(<priority high="2" low="4"/>)", R"(<priority high="2"/>)"},
      {"junction.foreign-road", R"(connectingRoad="3")", R"(connectingRoad="4")"},
      {"junction.linked-road", R"(connectingRoad="3")", R"(linkedRoad="3")"},
      {"junction.connecting-road", R"(type="default")", R"(type="direct")"},
      {"junction.empty", "<controller ", R"(<junction id="11"/><controller )"},
      {"junction.unused-road", R"(connectingRoad="3")", R"(connectingRoad="4")"},
      {"junction.unknown-lane", R"(to="-1")", R"(to="-7")"},
      {"profile.redundant", R"(<width sOffset="0" a="1.50")",
       R"(<width sOffset="0" a="1.50" b="0" c="0" d="0"/><width sOffset="30" a="1.50")"},
      {"curve.redundant", R"(<arc curvature="0.0000001"/>)", "<line/>"},
      {"junction.repeated-road", "</connection>",
       R"(</connection><connection id="1" incomingRoad="4" connectingRoad="3" )"
       R"(contactPoint="end"/>)"},
      {"signal.station", R"(s="95")", R"(s="195")"},
      {"object.station", R"(s="30" t="12")", R"(s="130" t="12")"},
      {"signal.validity-unknown", R"(fromLane="-2" toLane="-1")", R"(fromLane="-9" toLane="-8")"},
      {"signal.validity-order", R"(fromLane="-2" toLane="-1")", R"(fromLane="-1" toLane="-2")"},
      {"signal.validity-orientation", R"(fromLane="-2" toLane="-1")",
       R"(fromLane="-2" toLane="1")"},
      {"signal.country", R"(country="DE")", R"(country="Atlantis")"},
      {"signal.no-type", R"( type="274")", ""},
      {"signal.board-parts", "<vmsBoard/>", ""},
      {"signal.board-dynamic", R"(dynamic="yes" country="OpenDRIVE")",
       R"(dynamic="no" country="OpenDRIVE")"},
      {"signal.multi-board-type", R"(type="multiBoard")", R"(type="205")"},
      {"signal.static-board-type", R"(type="staticBoard")", R"(type="205")"},
      {"object.orientation", R"(t="9" zOffset="0" orientation="none")", R"(t="9" zOffset="0")"},
      {"object.two-shapes", R"(radius="0.1" height="5")", R"(radius="0.1" width="1" height="5")"},
      {"object.empty-outline", "<outlines>", R"(<outlines><outline id="9"/>)"},
      {"object.one-corner-road", "<outlines>",
       R"(<outlines><outline id="9"><cornerRoad s="1" t="1" dz="0" height="0"/></outline>)"},
      {"object.one-corner-local", "<outlines>",
       R"(<outlines><outline id="9"><cornerLocal u="1" v="1" z="0" height="0"/></outline>)"},
      {"object.mixed-corners", "<outlines>",
       R"(<outlines><outline id="9"><cornerRoad s="1" t="1" dz="0" height="0"/>)"
       R"(<cornerLocal u="1" v="1" z="0" height="0"/></outline>)"},
      {"object.empty-polyline", "<skeleton>", R"(<skeleton><polyline id="9"/>)"},
      {"object.one-vertex-road", "<skeleton>",
       R"(<skeleton><polyline id="9"><vertexRoad s="1" t="1" dz="0"/></polyline>)"},
      {"object.one-vertex-local", "<skeleton>",
       R"(<skeleton><polyline id="9"><vertexLocal u="1" v="1" z="0"/></polyline>)"},
      {"object.mixed-vertices", "<skeleton>",
       R"(<skeleton><polyline id="9"><vertexRoad s="1" t="1" dz="0"/>)"
       R"(<vertexLocal u="1" v="1" z="0"/></polyline>)"},
      {"object.marking-corner", R"(<cornerReference id="0"/>)", R"(<cornerReference id="7"/>)"},
      {"object.border-complete", R"(useCompleteOutline="true"/>)",
       R"(useCompleteOutline="true"><cornerReference id="0"/></border>)"},
      {"object.border-corners", R"(<cornerReference id="4"/></border>)", "</border>"},
      {"cross-section.leaning", "<lateralProfile><crossSectionSurface>",
       R"(<lateralProfile><shape s="0" t="-9" a="0" b="0" c="0" d="0"/><crossSectionSurface>)"},
      {"cross-section.single-strip", R"(<strip id="-1">)",
       R"(<strip id="-1"><width><coefficients s="0" a="3"/></width>)"},
      {"cross-section.strip-width", "</strip></surfaceStrips>",
       R"(</strip><strip id="-2"/></surfaceStrips>)"},
      {"controller.empty", R"(<control signalId="8"/>)", ""},
      {"speed.no-unit", R"(max="50" unit="km/h")", R"(max="50")"},
      {"speed.unknown-unit", R"(unit="km/h")", R"(unit="kmh")"},
      {"speed.absurd-limit", R"(max="14")", R"(max="140")"},
  };
}

// What was not asked for up to revision 1.7.
std::string file_of_1_8() {
  return tests::with_slip(clean_file(), {"", R"(revMinor="7")", R"(revMinor="8")"});
}

std::vector<tests::Slip> slips_of_1_8() {
  return {{"object.type-parts", "<skeleton>", "<surface/><skeleton>"}};
}

std::string with(const std::string& from, const std::string& to) {
  return tests::with_slip(clean_file(), {"", from, to});
}

std::vector<Finding> of_rule(const std::string& text, const std::string& rule) {
  return tests::source_findings(text, "file.xodr", rule);
}

TEST(OpenDriveRules, FindNothingButNotesInAFaultlessFile) {
  for (const std::string& file : {clean_file(), file_of_1_8()}) {
    for (const Finding& finding : validate_bytes(file, "file.xodr").findings) {
      EXPECT_EQ(finding.severity, Severity::info) << finding.rule << ": " << finding.message;
      const bool expected = finding.rule.starts_with("link.") ||
                            finding.rule.starts_with("speed.") ||
                            finding.rule.starts_with("import.");
      EXPECT_TRUE(expected) << finding.rule << ": " << finding.message;
    }
  }
}

TEST(OpenDriveRules, FindEverySlipAndSayWhereItIs) {
  tests::expect_each_is_found(slips(), clean_file(), "file.xodr");
  tests::expect_each_is_found(slips_of_1_8(), file_of_1_8(), "file.xodr");
}

TEST(OpenDriveRules, AreAllTried) {
  std::vector<tests::Slip> all = slips();
  for (const tests::Slip& slip : slips_of_1_8()) all.push_back(slip);
  tests::expect_all_are_tried(all, opendrive::rules::source_rules());
}

TEST(OpenDriveRules, GiveTheLineOfTheElement) {
  const std::string text = with(R"(fromLane="-2" toLane="-1")", R"(fromLane="-9" toLane="-8")");
  const auto line =
      1 + std::count(text.begin(),
                     text.begin() + static_cast<std::ptrdiff_t>(text.find("<signal ")), '\n');
  EXPECT_EQ(of_rule(text, "signal.validity-unknown").at(0).line, line);
}

TEST(OpenDriveRules, FindRecordsThatOnlyGoOnWhateverTheirDegree) {
  const std::string cubic = R"(<elevation s="50" a="10.5" b="0.02" c="0" d="0"/>)";
  // 10 + 0.01 s + 1e-4 s² - 1e-6 s³ from s = 0, and the same seen from s = 50.
  const std::string before = R"(b="0.01" c="0" d="0"/>)", bent = R"(b="0.01" c="1e-4" d="-1e-6"/>)";
  const std::string same = R"(<elevation s="50" a="10.625" b="0.0125" c="-5e-5" d="-1e-6"/>)";
  const std::string other = R"(<elevation s="50" a="10.625" b="0.0125" c="-5.1e-5" d="-1e-6"/>)";
  const std::string text = tests::with_slip(clean_file(), {"", before, bent});
  EXPECT_EQ(of_rule(tests::with_slip(text, {"", cubic, same}), "profile.redundant").size(), 1u);
  EXPECT_TRUE(of_rule(tests::with_slip(text, {"", cubic, other}), "profile.redundant").empty());
}

TEST(OpenDriveRules, OnlyNoteAPieceThatRoundingLeft) {
  const auto piece = [](const char* length) {
    return fmt::format(R"(hdg="0" length="40"><line/></geometry>
   <geometry s="40" x="40" y="0" hdg="0" length="{}"><line/></geometry>
   <geometry s="40" x="40" y="0" hdg="0" length="60"><arc curvature="0.0000001"/></geometry>)",
                       length);
  };
  const std::string joint = R"(hdg="0" length="40"><line/></geometry>
   <geometry s="40" x="40" y="0" hdg="0" length="60"><arc curvature="0.0000001"/></geometry>)";
  const auto severity = [&](const char* length) {
    return of_rule(with(joint, piece(length)), "curve.zero-length").at(0).severity;
  };
  EXPECT_EQ(severity("0.000000000000001"), Severity::info);
  EXPECT_EQ(severity("0"), Severity::warning);
}

TEST(OpenDriveRules, LetOtherRevisionsLeadOverOneRoadTwice) {
  const std::string twice = tests::with_slip(
      clean_file(), {"", "</connection>",
                     R"(</connection><connection id="1" incomingRoad="4" connectingRoad="3"/>)"});
  EXPECT_EQ(of_rule(twice, "junction.repeated-road").size(), 1u);
  const std::string older = tests::with_slip(twice, {"", R"(revMinor="7")", R"(revMinor="6")"});
  EXPECT_TRUE(of_rule(older, "junction.repeated-road").empty());
}

TEST(OpenDriveRules, DescribeAFileThatIsNoXml) {
  const std::string half = clean_file().substr(0, 3000);
  const Validation validation = validate_bytes(half, "half.xodr");
  EXPECT_FALSE(validation.road_map);
  EXPECT_THAT(validation.refusal, ::testing::HasSubstr("half.xodr"));
  ASSERT_EQ(validation.findings.size(), 1u);
  EXPECT_EQ(validation.findings[0].rule, "source.not-well-formed");
  EXPECT_EQ(validation.findings[0].asam_rule, "asam.net:xodr:1.0.0:xml.valid_xml_document");
  EXPECT_GT(validation.findings[0].line, 0);
}

TEST(OpenDriveRules, GoOnWhereTheReaderRefusesTheFile) {
  const Validation validation =
      validate_bytes(with(R"(<arc curvature="0.02"/>)", R"(<arc curvature="x"/>)"), "f.xodr");
  EXPECT_FALSE(validation.road_map);
  const auto has = [&](const char* rule) {
    return std::any_of(validation.findings.begin(), validation.findings.end(),
                       [&](const Finding& finding) { return finding.rule == rule; });
  };
  EXPECT_TRUE(has("schema.not-a-number"));
  EXPECT_TRUE(has("import.refused"));
}

TEST(OpenDriveRules, CountWhatIsTooMuchToList) {
  std::string roads;
  for (int i = 0; i < 1200; ++i) roads += "<road id=\"r" + std::to_string(i) + "\"/>\n";
  std::string text = clean_file();
  text.insert(text.find("<controller "), roads);
  const auto findings = of_rule(text, "section.missing");
  ASSERT_EQ(findings.size(), 1001u);
  EXPECT_EQ(findings.back().message, "and 200 more of this kind");
}

TEST(OpenDriveRules, GiveTheSidesOfTrafficTheirAsamRule) {
  const auto findings = of_rule(with(R"(fromLane="-2" toLane="-1")", R"(fromLane="-2" toLane="1")"),
                                "signal.validity-orientation");
  EXPECT_EQ(findings.at(0).asam_rule,
            "asam.net:xodr:1.7.0:road.signal.validity.right_hand_traffic_lane_ids");
}

}  // namespace
}  // namespace roadbed::map::validation
