#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/tests/support/log_bytes.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/tools/audit/audit_command_fixture.h"

namespace roadbed::tests {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

TEST_F(AuditCommand, NamesThePartOfTheVehicleAndProvesEachAtItsHeights) {
  // The post at y 1.0 to 1.1 stands 0.195 m beside the body, and in the way of a mirror of 0.25 m.
  const std::string high =
      folder_.write("high.json", R"({"mirrors":{"beyond_m":0.25,"rear_m":1.7,"front_m":1.9,)"
                                 R"("from_height_m":2.1,"to_height_m":2.3}})");
  const std::string low =
      folder_.write("low.json", R"({"mirrors":{"beyond_m":0.25,"rear_m":1.7,"front_m":1.9,)"
                                R"("from_height_m":0.9,"to_height_m":1.2}})");
  const std::string drive = folder_ / "drives/near.csv", proof = folder_ / "parts.json";
  const ProgramRun over =
      audit({"--trajectory", drive, "--vehicle", high, "--certificate", proof, "--json"});
  EXPECT_EQ(over.status, 0) << over.err;
  EXPECT_THAT(Json::parse(over.out).at("part").get<std::string>(), HasSubstr("body, "));
  const ProgramRun holds = run_roadbed({"audit", "--check", proof});
  EXPECT_EQ(holds.status, 0) << holds.out << holds.err;
  EXPECT_THAT(holds.out, HasSubstr("left mirror 0.2"));

  const ProgramRun hit =
      audit({"--trajectory", drive, "--vehicle", low, "--certificate", proof, "--json", "--force",
             "--geojson", folder_ / "parts.geojson", "--svg", folder_ / "parts.svg"});
  EXPECT_EQ(hit.status, 1);
  const Json conflict = Json::parse(hit.out).at("conflicts").at(0);
  EXPECT_THAT(conflict.at("part").get<std::string>(), HasSubstr("left mirror, front"));
  // Its front, 1.9 m ahead of the axle, meets the post at 10 m.
  EXPECT_NEAR(conflict.at("from_s").get<double>(), (10.0 - 1.9) / 2.0, 0.025);
  EXPECT_THAT(bytes_of(folder_ / "parts.geojson"), HasSubstr("MultiPolygon"));
  EXPECT_EQ(run_roadbed({"audit", "--check", proof}).status, 0);
  // A proof of another mirror proves nothing of this one.
  Json forged = Json::parse(bytes_of(proof));
  forged.at("parts").at(1).at("vehicle").at("middle_m") = 0.9;
  const ProgramRun refuted =
      run_roadbed({"audit", "--check", folder_.write("forged.json", forged.dump())});
  EXPECT_EQ(refuted.status, 1);
  EXPECT_THAT(refuted.out, HasSubstr("right mirror: "));
}

TEST_F(AuditCommand, SweepsALaneOfTheMapAtAnOffsetAndProvesIt) {
  const std::string map = data_folder() / "town.xodr", town = data_folder() / "town.bt";
  const auto sweep = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"audit", "--occupancy", town, "--map", map, "--lane", "lane:1/0/-1",
                               "--unknown", "free", "--speed", "36", "--force"});
    return run_roadbed(more);
  };
  const std::string saved = folder_ / "lane.csv", proof = folder_ / "proof.json";
  const ProgramRun centre = sweep({"--save-drive", saved, "--certificate", proof, "--json"});
  ASSERT_EQ(centre.status, 0) << centre.err;
  EXPECT_EQ(run_roadbed({"audit", "--check", proof}).status, 0);
  const ProgramRun aside = sweep({"--offset", "0.5", "--json"});
  const double least_m = Json::parse(centre.out).at("least_clearance_m").get<double>();
  // What is nearest stands to the right: half a metre to the left is half a metre more.
  EXPECT_NEAR(Json::parse(aside.out).at("least_clearance_m").get<double>(), least_m + 0.5, 0.02);
  // The lane is 15 m long: 1.5 s at 36 km/h.
  EXPECT_THAT(bytes_of(saved), HasSubstr("\n1.5,"));
}

TEST_F(AuditCommand, SeesWhatMovesBesideTheOccupancyAndProvesIt) {
  // At 2 m/s along y = -3; a box comes the other way and passes 0.195 m beside, at second 5.
  const std::string drive = folder_ / "drives/far/deeper/trajectory.csv";
  const std::string header = "t_s,id,x_m,y_m,heading_rad,length_m,width_m\n";
  const std::string beside =
      folder_.write("beside.csv", header + "0,van,20,-5,3.14159,4,2\n10,van,0,-5,3.14159,4,2\n");
  const std::string proof = folder_ / "proof.json";
  const ProgramRun clear =
      audit({"--trajectory", drive, "--obstacles", beside, "--certificate", proof, "--json"});
  ASSERT_EQ(clear.status, 0) << clear.err;
  EXPECT_NEAR(Json::parse(clear.out).at("least_clearance_m").get<double>(), 0.195, 0.02);
  EXPECT_EQ(Json::parse(clear.out).at("obstacle"), "van");
  const ProgramRun holds = run_roadbed({"audit", "--check", proof});
  EXPECT_EQ(holds.status, 0) << holds.out << holds.err;

  const std::string against =
      folder_.write("against.csv", header + "0,van,20,-3,3.14159,4,2\n10,van,0,-3,3.14159,4,2\n");
  const ProgramRun hit = audit({"--trajectory", drive, "--obstacles", against, "--json"});
  EXPECT_EQ(hit.status, 1);
  const Json conflict = Json::parse(hit.out).at("conflicts").at(0);
  EXPECT_EQ(conflict.at("obstacle"), "van");
  EXPECT_EQ(conflict.at("part"), "front");
  // Fronts 3.6767 m ahead of the axle and 2 m ahead of the van's centre close at 4 m/s.
  EXPECT_NEAR(conflict.at("from_s").get<double>(), (20.0 - 3.6767171 - 2.0) / 4.0, 0.025);
  const ProgramRun mixed = run_roadbed({"audit", "--check", proof, "--obstacles", against});
  EXPECT_EQ(mixed.status, 1);
  EXPECT_THAT(mixed.out, HasSubstr("the certificate is about one with"));
}

TEST_F(AuditCommand, ChecksNoProofAgainstObstaclesThatItIsNotAbout) {
  const std::string drive = folder_ / "drives/far/deeper/trajectory.csv";
  const std::string proof = folder_ / "proof.json";
  ASSERT_EQ(audit({"--trajectory", drive, "--certificate", proof}).status, 0);
  const ProgramRun alone = run_roadbed({"audit", "--check", proof});
  EXPECT_EQ(alone.status, 0);
  EXPECT_THAT(alone.out, HasSubstr("; no dynamic obstacles\n"));
  const std::string header = "t_s,id,x_m,y_m,heading_rad,length_m,width_m\n";
  const std::string against = folder_.write("against.csv", header + "0,van,10,-3,0,4,2\n");
  for (const std::string& obstacles : {against, std::string(folder_ / "not_there.csv")}) {
    const ProgramRun run = run_roadbed({"audit", "--check", proof, "--obstacles", obstacles});
    EXPECT_EQ(run.status, 1);
    EXPECT_THAT(run.out, HasSubstr("it is about no obstacles, and " + obstacles));
  }

  const std::string beside = folder_.write("beside.csv", header + "0,van,10,-9,0,4,2\n");
  const std::string about = folder_ / "about.json";
  ASSERT_EQ(audit({"--trajectory", drive, "--obstacles", beside, "--certificate", about}).status,
            0);
  const ProgramRun json = run_roadbed({"audit", "--check", about, "--json"});
  EXPECT_EQ(json.status, 0);
  EXPECT_THAT(Json::parse(json.out).at("question").get<std::string>(),
              HasSubstr("dynamic obstacles are those of " + beside));
}

// A car may be in box A all through steps 0 to 10, and in box B in steps 11 to 20.

TEST_F(AuditCommand, SeesEveryOccupancyOfAnObstacleAllThroughItsTime) {
  const auto shape = [](const std::string& x) {
    return "<shape><rectangle><length>4</length><width>2</width><orientation>0</orientation>"
           "<center><x>" +
           x + "</x><y>-3</y></center></rectangle></shape>";
  };
  const auto file = [&](const std::string& obstacles) {
    return folder_.write(
        "made.xml", "<commonRoad timeStepSize=\"0.5\" commonRoadVersion=\"2020a\">" + obstacles +
                        "</commonRoad>");
  };
  const auto time = [](const std::string& least, const std::string& most) {
    return "<time><intervalStart>" + least + "</intervalStart><intervalEnd>" + most +
           "</intervalEnd></time>";
  };
  const auto verdict = [&](const std::string& obstacles) {
    return Json::parse(audit({"--trajectory", folder_ / "drives/far/deeper/trajectory.csv",
                              "--obstacles", file(obstacles), "--json"})
                           .out);
  };
  const auto phantom = [&](const std::string& x_a, const std::string& x_b) {
    return "<phantomObstacle id=\"7\"><occupancySet><occupancy>" + shape(x_a) + time("0", "10") +
           "</occupancy><occupancy>" + shape(x_b) + time("11", "20") +
           "</occupancy></occupancySet></phantomObstacle>";
  };
  // The body is at 2 m/s from 0 m: its front passes 10 m near second 3.2, in A's time.
  const Json through_a = verdict(phantom("12", "300"));
  EXPECT_EQ(through_a.at("verdict"), "conflict");
  EXPECT_EQ(through_a.at("conflicts").at(0).at("obstacle"), "7.1");
  EXPECT_NEAR(through_a.at("conflicts").at(0).at("from_s").get<double>(),
              (12.0 - 2.0 - 3.6767171) / 2.0, 0.025);
  EXPECT_NEAR(through_a.at("conflicts").at(0).at("to_s").get<double>(), 5.5, 0.025);
  EXPECT_EQ(verdict(phantom("300", "12")).at("conflicts").at(0).at("obstacle"), "7.2");
  EXPECT_EQ(verdict(phantom("300", "300")).at("verdict"), "clear");
  EXPECT_EQ(verdict("<environmentObstacle id=\"8\"><type>building</type>" + shape("12") +
                    "</environmentObstacle>")
                .at("verdict"),
            "conflict");
  const ProgramRun unsaid = audit({"--trajectory", folder_ / "drives/near.csv", "--obstacles",
                                   file("<phantomObstacle id=\"9\"/>")});
  EXPECT_EQ(unsaid.status, 3);
  EXPECT_THAT(unsaid.err, HasSubstr("obstacle 9: nothing says where it is"));
}

TEST_F(AuditCommand, ACertificateAnswersItsOwnQuestionAndNamesWhereThatIsFrom) {
  const std::string proof = folder_ / "asked.json", drive = folder_ / "drives/near.csv";
  const std::string car = folder_.write("car.json", "{\"height_m\": 1.4}");
  ASSERT_EQ(audit({"--trajectory", drive, "--vehicle", car, "--certificate", proof}).status, 0);
  const auto check = [&](std::vector<std::string> demands) {
    demands.insert(demands.begin(), {"audit", "--check", proof});
    return run_roadbed(demands);
  };
  EXPECT_EQ(check({}).status, 0);
  const ProgramRun right =
      check({"--vehicle", car, "--occupancy", octree_, "--trajectory", drive, "--ground", "0",
             "--inflate", "0", "--clearance", "0", "--unknown", "free", "--from-height", "0.2",
             "--least-measured", "0"});
  EXPECT_EQ(right.status, 0) << right.out << right.err;
  const std::string other = folder_.write("other.json", "{\"height_m\": 1.5}");
  const std::string boxes = folder_.write("boxes.csv",
                                          "t_s,id,x_m,y_m,heading_rad,length_m,width_m\n"
                                          "0,a,100,100,0,1,1\n");
  for (const auto& [demand, fault] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"--ground", "1"}, "heights are above 0, not 1"},
           {{"--ground", "measured"}, "heights are above 0, not measured"},
           {{"--inflate", "0.1"}, "margin around the vehicle of 0 m, not 0.1 m"},
           {{"--clearance", "1"}, "clearance of 0 m, not 1 m"},
           {{"--unknown", "report"}, "unknown space counts as free, not report"},
           {{"--from-height", "0.3"}, "underside at 0.2 m, not 0.3 m"},
           {{"--least-measured", "0.5"}, "measured share of at least 0, not 0.5"},
           {{"--vehicle", other}, "has the hash"},
           {{"--trajectory", folder_ / "drives/hit.csv"}, "has the hash"},
           {{"--occupancy", drive}, "has the hash"},
           {{"--on", "drivable"}, "it is about no surface, and --on is given"},
           {{"--margin", "0"}, "it is about no surface, and --margin is given"},
           {{"--map", drive}, "it is about no map"},
           {{"--obstacles", boxes}, "it is about no obstacles"}}) {
    const ProgramRun run = check(demand);
    EXPECT_EQ(run.status, 1) << demand[0];
    EXPECT_THAT(run.out, HasSubstr(fault)) << demand[0];
  }
  const Json json = Json::parse(check({"--json"}).out);
  ASSERT_EQ(json.at("files").size(), 3u);
  EXPECT_EQ(json.at("files").at(1).at("role"), "trajectory");
  EXPECT_EQ(json.at("files").at(1).at("sha256").get<std::string>().size(), 64u);

  folder_.write("car.json", "{\"height_m\": 1.3}");
  const ProgramRun changed = check({});
  EXPECT_EQ(changed.status, 1);
  EXPECT_THAT(changed.out, HasSubstr("car.json has the hash"));
  std::filesystem::remove(car);
  const ProgramRun missing = check({});
  EXPECT_EQ(missing.status, 1);
  EXPECT_THAT(missing.out, HasSubstr("car.json: no such file"));
}

TEST_F(AuditCommand, ChecksNoProofAgainstAVehicleThatItIsNotAbout) {
  const std::string proof = folder_ / "mirrors.json", drive = folder_ / "drives/near.csv";
  const std::string car =
      folder_.write("car.json", R"({"mirrors":{"beyond_m":0.25,"rear_m":1.7,"front_m":1.9,)"
                                R"("from_height_m":0.9,"to_height_m":1.2}})");
  ASSERT_EQ(audit({"--trajectory", drive, "--vehicle", car, "--certificate", proof}).status, 1);
  const Json honest = Json::parse(bytes_of(proof));
  const auto faults_if = [&](const auto& forge) {
    Json forged = honest;
    forge(forged);
    const ProgramRun run =
        run_roadbed({"audit", "--check", folder_.write("forged.json", forged.dump())});
    EXPECT_EQ(run.status, 1);
    return run.out + run.err;
  };
  // The part that has the conflict, and with it the conflict.
  EXPECT_THAT(faults_if([](Json& claims) { claims.erase("parts"); }),
              HasSubstr("it is about 1 parts, and the vehicle has 3"));
  EXPECT_THAT(faults_if([](Json& claims) { claims.at("parts").erase(0); }),
              HasSubstr("it is about 2 parts, and the vehicle has 3"));
  EXPECT_THAT(faults_if([](Json& claims) { claims.at("vehicle").at("width_m") = 1.2; }),
              HasSubstr("body: it is not as long, wide or placed"));
  EXPECT_THAT(faults_if([](Json& claims) { claims.at("heights_m").at(0) = 1.4; }),
              HasSubstr("body: heights 1.4 m to 1.5 m are not those of the vehicle"));
  EXPECT_THAT(faults_if([](Json& claims) {
                claims.at("underside_m") = 1.2;
                claims.at("heights_m").at(0) = 1.2;
                claims.at("parts").at(0).at("heights_m") = {2.9, 3.2};
              }),
              HasSubstr("left mirror: heights 2.9 m to 3.2 m are not those of the vehicle"));
  EXPECT_THAT(faults_if([](Json& claims) { claims.erase("vehicle_file"); }),
              HasSubstr("it is about 3 parts, and the vehicle has 1"));
}

/// Past the post at 10 m/s, 4 m beside it, a pose every 0.1 s; without those in the middle 0.7 s.
std::string log_with_gap(bool has_gap) {
  std::vector<McapMessage> messages;
  for (int i = 0; i <= 20; ++i) {
    if (has_gap && i > 5 && i < 13) continue;
    const std::int64_t t_ns = 1'700'000'000'000'000'000 + std::int64_t{100'000'000} * i;
    messages.push_back({t_ns, odometry_message(t_ns, 1.0 * i, -3.0, 0.0, 10.0)});
  }
  return mcap_bytes("/odom", "nav_msgs/msg/Odometry", messages, "");
}

TEST_F(AuditCommand, ProvesNothingWhereTheLogSaysNoPose) {
  const std::string proof = folder_ / "proof.json";
  EXPECT_EQ(audit({"--trajectory", folder_.write("whole.mcap", log_with_gap(false))}).status, 0);
  const std::string gapped = folder_.write("gapped.mcap", log_with_gap(true));
  const ProgramRun run = audit({"--trajectory", gapped, "--save-drive", folder_ / "saved.csv",
                                "--certificate", proof, "--json"});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.err, HasSubstr("gapped.mcap: 1 gap between poses, of 0.800 s after 0.500 s"));
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["verdict"], "unknown");
  ASSERT_EQ(json["between_poses"].size(), 1u);
  ASSERT_EQ(json["stretches"].size(), 3u);
  EXPECT_EQ(json["stretches"][1]["verdict"], "unknown");
  EXPECT_NEAR(json["stretches"][1]["from_s"].get<double>(), 0.5, 1e-9);
  EXPECT_NEAR(json["stretches"][1]["to_s"].get<double>(), 1.3, 1e-9);
  EXPECT_EQ(run_roadbed({"audit", "--check", proof}).status, 0);
  EXPECT_EQ(nlohmann::json::parse(bytes_of(proof))["verdict"], "unknown");
  const ProgramRun text = audit({"--trajectory", gapped, "--quiet"});
  EXPECT_THAT(text.out, HasSubstr("0.500 s to 1.300 s: the log says no pose of the vehicle"));
  EXPECT_EQ(text.err, "");
  const std::string field = folder_.write(
      "field.geojson",
      R"({"type":"Polygon","coordinates":[[[-80,-80],[80,-80],[80,80],[-80,80],[-80,-80]]]})");
  const ProgramRun road =
      run_roadbed({"audit", "--on", "area:" + field, "--trajectory", gapped, "--save-drive",
                   folder_ / "saved.csv", "--certificate", proof, "--force"});
  EXPECT_EQ(road.status, 3);
  EXPECT_THAT(road.err, HasSubstr("no pose from 0.500 s to 1.300 s"));
}

}  // namespace
}  // namespace roadbed::tests
