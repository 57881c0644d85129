#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "roadbed/map/files/read_file.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tests {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Drives in a square field of 40 m, and on the town's first road.
class RoadAuditCommand : public testing::Test {
 protected:
  std::string drive(const std::string& name, double from_x, double from_y, double to_x,
                    double to_y) const {
    return folder_.write(name + ".csv", "t_s,x_m,y_m,heading_rad\n0," + std::to_string(from_x) +
                                            "," + std::to_string(from_y) + ",0\n10," +
                                            std::to_string(to_x) + "," + std::to_string(to_y) +
                                            ",0\n");
  }

  std::string path(const char* name) const { return (folder_ / name).string(); }

  static ProgramRun audit(std::vector<std::string> more) {
    more.insert(more.begin(), "audit");
    return run_roadbed(more);
  }

  static void refused(const std::vector<std::string>& words, int status, const std::string& says) {
    const ProgramRun run = audit(words);
    EXPECT_EQ(run.status, status) << run.err;
    EXPECT_THAT(run.err, HasSubstr(says));
    EXPECT_EQ(run.out, "");
  }

  static nlohmann::json json_of(const ProgramRun& run) { return nlohmann::json::parse(run.out); }

  TemporaryFolder folder_;
  std::string town_ = (data_folder() / "town.xodr").string();
  std::string field_ = folder_.write("field.geojson", R"({"type":"FeatureCollection","features":[
    {"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":
    [[[0,0],[40,0],[40,40],[0,40],[0,0]]]}}]})");
  std::string in_field_ = drive("in", 5, 20, 30, 20), out_ = drive("out", 5, 20, 38, 20);
};

TEST_F(RoadAuditCommand, NeedsNoOccupancyAndSaysClearWithStatus0) {
  const ProgramRun run = audit({"--on", "area:" + field_, "--trajectory", in_field_, "--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto json = json_of(run);
  EXPECT_EQ(json["verdict"], "clear");
  EXPECT_EQ(json["surface"]["verdict"], "clear");
  EXPECT_EQ(json["surface"]["margin_m"], 0.0);
  EXPECT_FALSE(json.contains("least_clearance_m"));
  // The rear at the start, the front at the end: 4.1687171 m and 40 m − 30 m − 3.6767171 m.
  EXPECT_NEAR(json["surface"]["least_margin_m"].get<double>(), 4.1687171, 0.02);
  EXPECT_LE(json["surface"]["proven_margin_m"].get<double>(), 4.1687171);
}

// Vehicle 3 is 1.844 m wide and vehicle 2 is 1.61 m, in a lane of 1.76 m.

TEST_F(RoadAuditCommand, AuditsTheVehicleThatASolutionNames) {
  const std::string lane = folder_.write("lane.geojson", R"({"type":"FeatureCollection",
    "features":[{"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":
    [[[0,-0.88],[40,-0.88],[40,0.88],[0,0.88],[0,-0.88]]]}}]})");
  const auto solution = [&](const std::string& model) {
    const auto state = [](int step, int x_m) {
      return "<ksState><x>" + std::to_string(x_m) +
             "</x><y>0</y><steeringAngle>0</steeringAngle><velocity>10</velocity>"
             "<orientation>0</orientation><time>" +
             std::to_string(step) + "</time></ksState>";
    };
    return folder_.write(model + ".xml", "<CommonRoadSolution benchmark_id=\"" + model +
                                             ":SM1:X:2020a\"><ksTrajectory planningProblem=\"1\">" +
                                             state(0, 10) + state(10, 20) +
                                             "</ksTrajectory></CommonRoadSolution>");
  };
  const auto on_lane = [&](const std::string& drive, std::vector<std::string> more) {
    more.insert(more.begin(), {"--on", "area:" + lane, "--trajectory", drive, "--rate", "10"});
    return audit(more);
  };
  const ProgramRun wide = on_lane(solution("KS3"), {});
  EXPECT_EQ(wide.status, 1) << wide.err;
  EXPECT_THAT(wide.out, HasSubstr("vehicle          commonroad:3, which the solution names\n"));
  EXPECT_EQ(json_of(on_lane(solution("KS3"), {"--json"}))["vehicle"], "commonroad:3");

  const ProgramRun given = on_lane(solution("KS3"), {"--vehicle", "commonroad:2"});
  EXPECT_EQ(given.status, 0);
  EXPECT_THAT(given.out, Not(HasSubstr("vehicle")));
  EXPECT_THAT(given.err, HasSubstr("note: the solution is of commonroad:3, 4.569 m by 1.844 m; "
                                   "audited is --vehicle commonroad:2, 4.508 m by 1.610 m"));
  const ProgramRun same = on_lane(solution("KS3"), {"--vehicle", "commonroad:3"});
  EXPECT_EQ(same.status, 1);
  EXPECT_THAT(same.err, Not(HasSubstr("solution")));
  EXPECT_EQ(on_lane(solution("KS2"), {}).status, 0);
}

TEST_F(RoadAuditCommand, SaysWhereADriveLeavesAndHowFar) {
  const ProgramRun run = audit({"--on", "area:" + field_, "--trajectory", out_, "--json"});
  EXPECT_EQ(run.status, 1);
  const auto json = json_of(run);
  EXPECT_EQ(json["verdict"], "conflict");
  ASSERT_EQ(json["surface"]["excursions"].size(), 1u);
  const auto& out = json["surface"]["excursions"][0];
  EXPECT_NEAR(out["depth_m"].get<double>(), 38.0 + 3.6767171 - 40.0, 1e-9);
  EXPECT_NEAR(out["from_s"].get<double>(), (40.0 - 3.6767171 - 5.0) / 3.3, 0.01);
  EXPECT_EQ(out["to_s"], 10.0);
  EXPECT_THAT(out["part"].get<std::string>(), HasSubstr("front"));
  EXPECT_EQ(out["onto"]["kind"], "unmapped");
  const ProgramRun margin =
      audit({"--on", "area:" + field_, "--trajectory", in_field_, "--margin", "4.5", "--json"});
  EXPECT_EQ(margin.status, 1);
  EXPECT_EQ(json_of(margin)["surface"]["excursions"][0]["depth_m"], 0.0);
}

TEST_F(RoadAuditCommand, OfALaneIsClearAndOfALaneShiftedOverTheEdgeIsNot) {
  const ProgramRun lane =
      audit({"--on", "drivable", "--map", town_, "--lane", "lane:1/0/-1@10", "--json"});
  EXPECT_EQ(lane.status, 0) << lane.err << lane.out;
  const auto rules = json_of(lane)["rules"];
  for (const char* rule : {"markings", "direction", "speed", "lights"}) {
    EXPECT_TRUE(rules[rule].contains("verdict")) << rule;
  }
  EXPECT_EQ(rules["direction"]["verdict"], "clear");
  const ProgramRun shifted = audit(
      {"--on", "drivable", "--map", town_, "--lane", "lane:1/0/-1@10", "--offset", "-3", "--json"});
  EXPECT_EQ(shifted.status, 1);
  EXPECT_GT(json_of(shifted)["surface"]["excursions"][0]["depth_m"].get<double>(), 0.5);
}

TEST_F(RoadAuditCommand, CountsRulesOnlyWhereTheyAreAskedFor) {
  const std::vector<std::string> fast{"--on",           "drivable", "--map", town_,   "--lane",
                                      "lane:1/0/-1@10", "--speed",  "200",   "--json"};
  const ProgramRun run = audit(fast);
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(json_of(run)["rules"]["speed"]["verdict"], "conflict");
  auto asked = fast;
  asked.insert(asked.end(), {"--rules", "speed"});
  const ProgramRun counted = audit(asked);
  EXPECT_EQ(counted.status, 1);
  EXPECT_EQ(json_of(counted)["verdict"], "conflict");
}

TEST_F(RoadAuditCommand, GivesEachVerdictATestCaseOfItsOwn) {
  const std::string junit = path("audit.xml");
  EXPECT_EQ(audit({"--on", "drivable", "--map", town_, "--lane", "lane:1/0/-1@10", "--speed", "200",
                   "--junit", junit})
                .status,
            0);
  const std::string text = map::read_file(junit);
  EXPECT_THAT(text, HasSubstr("tests=\"6\" failures=\"1\""));
  EXPECT_THAT(text, HasSubstr(": on drivable\">\n      <system-out>"));
  EXPECT_THAT(text, HasSubstr(": speed\">\n      <failure message=\"conflict\">"));
}

TEST_F(RoadAuditCommand, WritesACertificateThatHoldsUntilItIsChanged) {
  const std::string proof = path("proof.json");
  ASSERT_EQ(audit({"--on", "area:" + field_, "--trajectory", in_field_, "--margin", "1",
                   "--certificate", proof})
                .status,
            0);
  const ProgramRun check = audit({"--check", proof, "--margin", "1", "--json"});
  EXPECT_EQ(check.status, 0) << check.out;
  EXPECT_GT(json_of(check)["certified_margin_m"].get<double>(), 3.0);
  EXPECT_EQ(audit({"--check", proof, "--margin", "2"}).status, 1);
  std::string forged = map::read_file(proof);
  const auto at = forged.find("\"margin_m\":1.0");
  ASSERT_NE(at, std::string::npos);
  forged.replace(at, 14, "\"margin_m\":9.0");
  EXPECT_EQ(audit({"--check", folder_.write("forged.json", forged)}).status, 1);
  // Another area under the same name.
  folder_.write("field.geojson", R"({"type":"Polygon","coordinates":[[[0,0],[9,0],[9,9],[0,0]]]})");
  EXPECT_EQ(audit({"--check", proof}).status, 1);
}

TEST_F(RoadAuditCommand, ChecksNoCertificateForWhatItSaysNothingOf) {
  const std::string proof = path("proof.json"), on = "area:" + field_;
  ASSERT_EQ(audit({"--on", on, "--trajectory", in_field_, "--certificate", proof}).status, 0);
  const auto check = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"--check", proof});
    return audit(words);
  };
  EXPECT_EQ(check({"--on", on, "--margin", "0", "--seam", "0.01"}).status, 0);
  for (const std::vector<std::string>& words : {std::vector<std::string>{"--rules", "all"},
                                                {"--lane", "lane:1/0/-1"},
                                                {"--boxes", "found"},
                                                {"--from", "lane:1/0/-1"},
                                                {"--rate", "10"},
                                                {"--pose-frame", "rear-axle"}}) {
    const ProgramRun run = check(words);
    EXPECT_EQ(run.status, 2) << words[0];
    EXPECT_THAT(run.err, AllOf(HasSubstr(words[0]), HasSubstr("--check"))) << words[0];
    EXPECT_THAT(run.out, testing::IsEmpty()) << words[0];
  }
  for (const auto& [option, value, fault] :
       {std::array{"--seam", "0.02", "it is about closed seams of 0.01 m, not 0.02 m"},
        {"--clearance", "1", "it is about no occupied space, and --clearance is given"},
        {"--unknown", "free", "it is about no occupied space, and --unknown is given"},
        {"--ground", "0", "it is about no occupied space, and --ground is given"},
        {"--least-measured", "1",
         "it is about no occupied space, and --least-measured is given"}}) {
    const ProgramRun run = check({option, value});
    EXPECT_EQ(run.status, 1) << option;
    EXPECT_THAT(run.out, HasSubstr(fault)) << option;
  }
}

TEST_F(RoadAuditCommand, KeepsToARouteAsAFileHasIt) {
  const std::string route = path("route.json");
  const ProgramRun found =
      run_roadbed({"route", town_, "--from", "lane:1/0/-1@5", "--to", "lane:7/0/1@55", "--json"});
  ASSERT_EQ(found.status, 0) << found.err;
  folder_.write("route.json", found.out);
  const auto on_route = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"--on", "route:" + route, "--map", town_});
    return audit(words).status;
  };
  EXPECT_EQ(on_route({"--from", "lane:1/0/-1@5", "--to", "lane:7/0/1@40"}), 0);
  EXPECT_EQ(on_route({"--lane", "lane:1/0/1@1"}), 1);
}

TEST_F(RoadAuditCommand, DrawsWhereADriveLeaves) {
  const std::string svg = path("out.svg"), page = path("out.html"), places = path("out.geojson");
  EXPECT_EQ(audit({"--on", "area:" + field_, "--trajectory", out_, "--svg", svg, "--report", page,
                   "--geojson", places})
                .status,
            1);
  EXPECT_THAT(map::read_file(svg), HasSubstr("<svg"));
  EXPECT_THAT(map::read_file(page), HasSubstr("conflict"));
  EXPECT_THAT(map::read_file(places), HasSubstr("\"excursion point\""));
}

TEST_F(RoadAuditCommand, RefusesWhatItCannotAnswerInOneLine) {
  refused({"--on", "roads", "--map", town_, "--trajectory", in_field_}, 2, "none of drivable");
  refused({"--on", "drivable", "--trajectory", in_field_}, 2, "needs --map");
  refused({"--trajectory", in_field_}, 2, "--occupancy or --on is required");
  refused({"--trajectory", in_field_, "--occupancy", "x.bt", "--margin", "1"}, 2, "need --on");
  refused({"--on", "area:" + path("none.geojson"), "--trajectory", in_field_}, 3, "none.geojson");
  refused(
      {"--on",
       "area:" + folder_.write("empty.geojson", R"({"type":"FeatureCollection","features":[]})"),
       "--trajectory", in_field_},
      3, "no polygon");
  refused({"--on",
           "area:" + folder_.write(
                         "bow.geojson",
                         R"({"type":"Polygon","coordinates":[[[0,0],[4,4],[4,0],[0,4],[0,0]]]})"),
           "--trajectory", in_field_},
          3, "bow.geojson");
  refused({"--on", "route:" + folder_.write("none.json", R"({"found":false,"reason":"none"})"),
           "--map", town_, "--trajectory", in_field_},
          3, "no route was found");
  refused({"--on",
           "route:" + folder_.write("far.json", R"({"found":true,"lanes":[{"lane":"99/9/9"}]})"),
           "--map", town_, "--trajectory", in_field_},
          3, "99/9/9");
  refused({"--on", "area:" + field_, "--trajectory", in_field_, "--rules", "manners"}, 2,
          "--rules");
}

/// What only an occupancy is asked for must not look as if it had been.
TEST_F(RoadAuditCommand, RefusesWhatItWouldNotLookAt) {
  const std::string wall = folder_.write(
      "wall.csv", "t_s,id,x_m,y_m,heading_rad,length_m,width_m\n0,wall,15,20,0,1,5\n");
  const std::vector<std::string> asked{"--on", "area:" + field_, "--trajectory", in_field_};
  for (const std::vector<std::string>& more : {std::vector<std::string>{"--obstacles", wall},
                                               {"--clearance", "1"},
                                               {"--unknown", "occupied"},
                                               {"--least-measured", "1"},
                                               {"--from-height", "1"}}) {
    auto words = asked;
    words.insert(words.end(), more.begin(), more.end());
    refused(words, 2, more.front() + " needs --occupancy");
  }
}

TEST_F(RoadAuditCommand, CertifiesNothingOfRules) {
  refused({"--on", "drivable", "--map", town_, "--trajectory", in_field_, "--rules", "all",
           "--certificate", path("proof.json")},
          2, "--certificate excludes --rules");
}

}  // namespace
}  // namespace roadbed::tests
