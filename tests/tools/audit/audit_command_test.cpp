#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tests {
namespace {

using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

/// A post at (10.05, 1.05), one cell of 0.1 m wide, from the ground to 2 m; farther off two from
/// there to 2.5 m, so that those heights were looked at.
std::string post_pcd() {
  std::string points;
  int count = 0;
  for (double z = 0.05; z < 2.0; z += 0.05, ++count) {
    points += "10.05 1.05 " + std::to_string(z) + "\n";
  }
  for (double z = 2.05; z < 2.5; z += 0.05, count += 2) {
    points += "8.05 4.05 " + std::to_string(z) + "\n16.05 4.05 " + std::to_string(z) + "\n";
  }
  const std::string number = std::to_string(count);
  return "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + number +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + number + "\nDATA ascii\n" + points;
}

std::string along_x_csv(double y) {
  return "t_s,x_m,y_m,heading_rad\n0,0," + std::to_string(y) + ",0\n10,20," + std::to_string(y) +
         ",0\n";
}

class AuditCommand : public testing::Test {
 protected:
  void SetUp() override {
    const std::string cloud = folder_.write("post.pcd", post_pcd());
    ASSERT_EQ(run_roadbed({"occupancy", "build", cloud, "-o", octree_, "--quiet"}).status, 0);
    std::filesystem::create_directories(folder_ / "drives/far/deeper");
    folder_.write("drives/hit.csv", along_x_csv(1.0));
    folder_.write("drives/near.csv", along_x_csv(0.0));
    folder_.write("drives/far/deeper/trajectory.csv", along_x_csv(-3.0));
    folder_.write("drives/far/deeper/other.csv", "not a drive");
    folder_.write("drives/broken.csv", "t_s,x_m\n0,1\n");
  }

  ProgramRun audit(std::vector<std::string> more) const {
    more.insert(more.begin(), {"audit", "--occupancy", octree_, "--unknown", "free"});
    return run_roadbed(more);
  }

  TemporaryFolder folder_;
  std::string octree_ = folder_ / "post.bt", drives_ = folder_ / "drives";
};

TEST_F(AuditCommand, OfAFolderListsEveryDriveAndOneBrokenFileDoesNotStopTheRest) {
  const ProgramRun run = audit({"--trajectory", drives_, "--json"});
  EXPECT_EQ(run.status, 1);
  const Json json = Json::parse(run.out);
  EXPECT_EQ(json.at("verdict"), "unusable");
  EXPECT_EQ(json.at("counts").at("clear"), 2);
  ASSERT_EQ(json.at("audits").size(), 4u);
  const auto audit_of = [&](std::size_t i, const char* drive) {
    EXPECT_EQ(json.at("audits").at(i).at("drive"), drive);
    return json.at("audits").at(i);
  };
  EXPECT_THAT(audit_of(0, "broken.csv").at("fault").get<std::string>(), HasSubstr("y_m"));
  EXPECT_NEAR(audit_of(1, "far/deeper/trajectory.csv").at("least_clearance_m").get<double>(),
              4.0 - 0.805, 0.02);
  EXPECT_EQ(audit_of(2, "hit.csv").at("verdict"), "conflict");
  EXPECT_NEAR(audit_of(3, "near.csv").at("least_clearance_m").get<double>(), 1.0 - 0.805, 0.02);
  const ProgramRun table = audit({"--trajectory", drives_});
  EXPECT_THAT(table.out, HasSubstr("\n4 drives: 2 clear, 1 conflict, 0 unknown, 0 undecided, "
                                   "1 unusable\n"));
}

TEST_F(AuditCommand, SaysTheSameForAnyNumberOfThreads) {
  for (const std::vector<std::string>& form : {std::vector<std::string>{}, {"--json"}}) {
    std::vector<std::string> one{"--trajectory", drives_, "--threads", "1"}, many = one;
    many.back() = "3";
    one.insert(one.end(), form.begin(), form.end());
    many.insert(many.end(), form.begin(), form.end());
    EXPECT_EQ(audit(one).out, audit(many).out);
  }
}

TEST_F(AuditCommand, NamesTimePlaceAndPartOfTheFirstConflictAndTheVerdictOfEachStretch) {
  const Json json = Json::parse(audit({"--trajectory", folder_ / "drives/hit.csv", "--json"}).out);
  const Json& conflict = json.at("conflicts").at(0);
  // At 2 m/s the front, 3.6767 m ahead of the axle, meets the post at 10 m.
  const double meets_s = (10.0 - 3.6767171) / 2.0;
  EXPECT_NEAR(conflict.at("from_s").get<double>(), meets_s, 0.025);
  EXPECT_NEAR(conflict.at("from").at("x_m").get<double>(), 2.0 * meets_s, 0.05);
  EXPECT_EQ(conflict.at("part"), "front");
  ASSERT_EQ(json.at("stretches").size(), 3u);
  EXPECT_EQ(json.at("stretches").at(0).at("verdict"), "clear");
  EXPECT_EQ(json.at("stretches").at(1).at("verdict"), "conflict");
  EXPECT_EQ(json.at("stretches").at(1).at("from_s"), conflict.at("from_s"));
  EXPECT_EQ(json.at("stretches").at(2).at("to_s"), 10.0);
  const Json near = Json::parse(audit({"--trajectory", folder_ / "drives/near.csv", "--json"}).out);
  EXPECT_THAT(near.at("part").get<std::string>(), HasSubstr("left"));
}

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

TEST_F(AuditCommand, WritesATestCasePerDrive) {
  const std::string junit = folder_ / "audit.xml";
  EXPECT_EQ(audit({"--trajectory", drives_, "--junit", junit}).status, 1);
  const std::string xml = bytes_of(junit);
  EXPECT_THAT(xml, HasSubstr("tests=\"4\" failures=\"1\" errors=\"1\""));
  EXPECT_THAT(xml, HasSubstr("name=\"hit.csv\">\n      <failure message=\"conflict\">"));
  EXPECT_THAT(xml, HasSubstr("name=\"broken.csv\">\n      <error message="));
}

TEST_F(AuditCommand, WritesStretchesConflictsAndWitnessesAsGeoJson) {
  const std::string file = folder_ / "audit.geojson";
  EXPECT_EQ(audit({"--trajectory", folder_ / "drives/hit.csv", "--geojson", file}).status, 1);
  const Json json = Json::parse(bytes_of(file));
  EXPECT_EQ(json.at("type"), "FeatureCollection");
  std::vector<std::string> kinds;
  for (const Json& feature : json.at("features")) {
    kinds.push_back(feature.at("properties").at("kind"));
    if (kinds.back() != "witness") continue;
    const Json& ring = feature.at("geometry").at("coordinates").at(0);
    EXPECT_EQ(ring.at(0), ring.at(4));
    EXPECT_NEAR(ring.at(0).at(0).get<double>(), 10.0, 1e-6);
    EXPECT_NEAR(ring.at(0).at(1).get<double>(), 1.0, 1e-6);
  }
  EXPECT_THAT(kinds, testing::ElementsAre("stretch", "stretch", "stretch", "conflict", "witness"));
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

TEST_F(AuditCommand, SweepsARoute) {
  const std::string map = data_folder() / "town.xodr", town = data_folder() / "town.bt";
  const ProgramRun run =
      run_roadbed({"audit", "--occupancy", town, "--map", map, "--from", "lane:1/0/-1", "--to",
                   "lane:1/1/-1@5", "--unknown", "free", "--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NEAR(Json::parse(run.out).at("stretches").at(0).at("to_s").get<double>(),
              20.0 / (30.0 / 3.6), 0.05);
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
  EXPECT_THAT(alone.out, HasSubstr("; nothing moves\n"));
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
              HasSubstr("what moves is that of " + beside));
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
  EXPECT_EQ(unsaid.status, 1);
  EXPECT_THAT(unsaid.err, HasSubstr("obstacle 9: nothing says where it is"));
}

TEST_F(AuditCommand, WritesAPageThatPlaysTheAudit) {
  const std::string page = folder_ / "audit.html";
  EXPECT_EQ(audit({"--trajectory", folder_ / "drives/hit.csv", "--report", page}).status, 1);
  const std::string html = bytes_of(page);
  EXPECT_THAT(html, HasSubstr("conflict: least clearance 0.00 m"));
  EXPECT_THAT(html, HasSubstr("conflict begins: occupied space, front"));
  EXPECT_THAT(html, HasSubstr("proven clearance"));
}

TEST_F(AuditCommand, DrawsACloseUpOfEachConflictWithALinkToItsTime) {
  const std::string page = folder_ / "near.html";
  const std::string drive = folder_ / "drives/near.csv";
  EXPECT_EQ(audit({"--trajectory", drive, "--report", page, "--clearance", "0.5"}).status, 1);
  const std::string html = bytes_of(page);
  EXPECT_THAT(html, HasSubstr("<h2>Close-ups</h2>"));
  EXPECT_THAT(html, HasSubstr("class=\"up-witness\""));
  EXPECT_THAT(html, HasSubstr("class=\"up-arrow\""));
  EXPECT_THAT(html, HasSubstr("0.195 m from occupied space"));
  EXPECT_THAT(html, testing::ContainsRegex("<figcaption><a href=\"#t=[0-9.]+\""));
}

TEST_F(AuditCommand, ListsTheDrivesOfAFolderOnOnePage) {
  const std::string page = folder_ / "all.html";
  EXPECT_EQ(audit({"--trajectory", drives_, "--report", page}).status, 1);
  const std::string html = bytes_of(page);
  EXPECT_THAT(html, HasSubstr("<h1>Audit of 4 drives</h1>"));
  EXPECT_THAT(html, HasSubstr("1 unusable, 2 clear, 1 conflict"));
  EXPECT_THAT(html, HasSubstr("<a href=\"#drive-3\">hit.csv</a></td><td class=\"bad\">conflict"));
  EXPECT_THAT(html, HasSubstr("class=\"up-witness\""));
  EXPECT_THAT(html, Not(HasSubstr("<script")));
}

/// The post again, on a road that climbs by 10 % along x, 3 m high at x = 10 m.
TEST_F(AuditCommand, FollowsTheGroundOfAMapOrOfTheMeasuredRoad) {
  std::string points;
  for (double x = -2.0; x < 26.0; x += 0.09) {
    for (double y = -4.0; y < 4.0; y += 0.09) {
      points +=
          std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(2.0 + 0.1 * x) + "\n";
    }
  }
  for (double z = 3.0; z < 4.0; z += 0.05) points += "10.05 1.05 " + std::to_string(z) + "\n";
  const std::string cloud = folder_.write("slope.xyz", points), octree = folder_ / "slope.bt";
  ASSERT_EQ(run_roadbed({"occupancy", "build", cloud, "-o", octree, "--quiet"}).status, 0);
  const std::string map = folder_.write(
      "slope.xodr",
      "<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/><road name=\"\" length=\"40\" id=\"1\" "
      "junction=\"-1\"><planView><geometry s=\"0\" x=\"-10\" y=\"4\" hdg=\"0\" length=\"40\">"
      "<line/></geometry></planView><elevationProfile><elevation s=\"0\" a=\"1\" b=\"0.1\" "
      "c=\"0\" d=\"0\"/></elevationProfile><lanes><laneSection s=\"0\"><center><lane id=\"0\" "
      "type=\"none\"/></center><right><lane id=\"-1\" type=\"driving\"><width sOffset=\"0\" "
      "a=\"8\" b=\"0\" c=\"0\" d=\"0\"/></lane></right></laneSection></lanes></road></OpenDRIVE>");
  const auto audit_on = [&](const char* drive, std::vector<std::string> more) {
    more.insert(more.begin(),
                {"audit", "--occupancy", octree, "--trajectory", folder_ / "drives" / drive,
                 "--unknown", "free", "--from-height", "0.25", "--json", "--force"});
    return run_roadbed(more);
  };
  const std::string proof = folder_ / "slope.json";
  for (const std::vector<std::string>& ground :
       {std::vector<std::string>{"--map", map}, {"--ground", "measured"}}) {
    std::vector<std::string> with_proof = ground;
    with_proof.insert(with_proof.end(), {"--certificate", proof});
    const ProgramRun near = audit_on("near.csv", with_proof);
    ASSERT_EQ(near.status, 0) << near.out << near.err;
    EXPECT_THAT(near.err, HasSubstr("note: heights are above the"));
    EXPECT_NEAR(Json::parse(near.out).at("least_clearance_m").get<double>(), 1.0 - 0.805, 0.02);
    const ProgramRun holds = run_roadbed({"audit", "--check", proof});
    EXPECT_EQ(holds.status, 0) << holds.out << holds.err;
    EXPECT_THAT(holds.out, testing::ContainsRegex("above ground at z (1.9|2.0)[0-9] m to [0-9.]+ "
                                                  "m at the drive's rows"));
    EXPECT_EQ(audit_on("hit.csv", ground).status, 1);
  }
  // Certificates whose ground is not under the drive, is no ground, or is not what their files say.
  const auto of_forged = [&](const Json& forgery) {
    const ProgramRun run =
        run_roadbed({"audit", "--check", folder_.write("forged.json", forgery.dump())});
    EXPECT_EQ(run.status, 1);
    return run.out + run.err;
  };
  ASSERT_EQ(audit_on("near.csv", {"--map", map, "--certificate", proof}).status, 0);
  const Json of_map = Json::parse(bytes_of(proof));
  ASSERT_EQ(audit_on("near.csv", {"--ground", "measured", "--certificate", proof}).status, 0);
  const Json of_cells = Json::parse(bytes_of(proof));
  for (const Json& honest : {of_map, of_cells}) {
    const auto forged = [&](const auto& forge) {
      Json forgery = honest;
      forge(forgery.at("heights_above").at("places"));
      return of_forged(forgery);
    };
    EXPECT_THAT(forged([](Json& places) {
                  places = Json::array({{-90, 0, 100, 0, 0}});
                }),
                HasSubstr("nothing is said within 2 m"));
    EXPECT_THAT(forged([](Json& places) {
                  places = Json::array({{-90, 0, 100, 1, 0}});
                }),
                HasSubstr("-0.5 to 0.5"));
    EXPECT_THAT(forged([](Json& places) {
                  Json place = places.at(4);
                  place.at(0) = place.at(0).get<double>() + 0.3;
                  place.at(2) = place.at(2).get<double>() + 5.0;
                  places.push_back(place);
                }),
                HasSubstr("it steps by"));
    for (const double raised_m : {0.03, 3.6, 30.0}) {
      EXPECT_THAT(forged([&](Json& places) {
                    for (Json& place : places) place.at(2) = place.at(2).get<double>() + raised_m;
                  }),
                  HasSubstr("fault            ground: at"))
          << raised_m;
    }
    Json level = honest;
    level.at("heights_above") = {{"ground", "level"}, {"margin_m", 0}, {"level_m", 30.0}};
    EXPECT_THAT(of_forged(level), HasSubstr("above the ground"));
  }
  Json without_map = of_map;
  without_map.erase("map");
  EXPECT_THAT(of_forged(without_map), HasSubstr("that of a map, and none is named"));
  // On the level of its start the road itself is in the way, further up.
  const ProgramRun level = audit_on("near.csv", {"--ground", "2"});
  EXPECT_EQ(level.status, 1);
  EXPECT_EQ(Json::parse(level.out).at("verdict"), "conflict");
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

TEST_F(AuditCommand, IsNotClearWithoutHavingLooked) {
  const std::string high = folder_.write("high.xyz", "10 1 412.5\n11 1 412.9\n");
  const std::string octree = folder_ / "high.bt", proof = folder_ / "high.json";
  ASSERT_EQ(run_roadbed({"occupancy", "build", high, "-o", octree, "--quiet"}).status, 0);
  for (const char* policy : {"free", "report", "occupied"}) {
    const ProgramRun run = run_roadbed(
        {"audit", "--occupancy", octree, "--trajectory", folder_ / "drives/near.csv", "--unknown",
         policy, "--certificate", proof, "--junit", folder_ / "high.xml", "--json", "--force"});
    EXPECT_EQ(run.status, 1);
    const Json json = Json::parse(run.out);
    EXPECT_NE(json.at("verdict"), "clear");
    EXPECT_EQ(json.at("unobserved").at(0).at("from_s"), 0.0);
    EXPECT_EQ(json.at("unobserved").at(0).at("to_s"), 10.0);
    EXPECT_THAT(json.at("unobserved").at(0).at("reason").get<std::string>(),
                HasSubstr("the body takes z 0.20 m to 1.50 m"));
    EXPECT_THAT(bytes_of(folder_ / "high.xml"), HasSubstr("failures=\"1\""));
    const ProgramRun check = run_roadbed({"audit", "--check", proof});
    EXPECT_EQ(check.status, 0) << check.out;
    EXPECT_THAT(check.out, Not(HasSubstr("certified")));
  }
}

TEST_F(AuditCommand, AsksForAMeasuredShareAndPrintsIt) {
  const std::string drive = folder_ / "drives/near.csv", proof = folder_ / "share.json";
  const ProgramRun none =
      audit({"--trajectory", drive, "--least-measured", "0.25", "--certificate", proof});
  EXPECT_EQ(none.status, 1);
  EXPECT_THAT(none.out, HasSubstr("verdict          unknown"));
  EXPECT_THAT(none.out,
              HasSubstr("100.0 % of the space that the vehicle takes, but at least 25 %"));
  const ProgramRun check = run_roadbed({"audit", "--check", proof});
  EXPECT_EQ(check.status, 0) << check.out;
  EXPECT_THAT(check.out, HasSubstr("0.0 % of the space that the vehicle takes, 25 % asked for"));
  Json forged = Json::parse(bytes_of(proof));
  forged.at("measured_share") = 0.3;
  const ProgramRun refuted =
      run_roadbed({"audit", "--check", folder_.write("forged.json", forged.dump())});
  EXPECT_EQ(refuted.status, 1);
  EXPECT_THAT(refuted.out, HasSubstr("measured_share: 0.0000"));
}

TEST_F(AuditCommand, SaysHowDeepAConflictIs) {
  const ProgramRun run = audit({"--trajectory", folder_ / "drives/hit.csv"});
  EXPECT_THAT(run.out, HasSubstr("front overlaps the cell at (10.05, 1.05)"));
  // The drive at y 1 passes over all of a cell from y 1.0 to 1.1: out by its left side it is
  // nearer.
  EXPECT_THAT(run.out, HasSubstr("0.805 m deep, 0.010 m²"));
}

TEST_F(AuditCommand, NotesBendsThatTheVehicleCannotDrive) {
  std::string drive = "t_s,x_m,y_m,heading_rad\n";
  for (int i = 0; i <= 40; ++i) {
    drive += fmt::format("{},{},{},{}\n", 0.1 * i, 8.0 + std::sin(0.1 * i),
                         -1.0 - std::cos(0.1 * i), 0.1 * i);
  }
  const ProgramRun run = audit({"--trajectory", folder_.write("bend.csv", drive)});
  EXPECT_THAT(run.err, HasSubstr("the drive bends by 1 1/m, and the vehicle by 0.702 1/m at most"));
}

TEST_F(AuditCommand, RefusesHeightsThatAreNone) {
  const std::string one = folder_ / "drives/near.csv";
  for (const char* ground : {"nan", "inf", "1e9", "up", "3m", ""}) {
    EXPECT_EQ(audit({"--trajectory", one, "--ground", ground}).status, 2) << ground;
  }
  EXPECT_EQ(audit({"--trajectory", one, "--ground", "map"}).status, 2);
  EXPECT_EQ(audit({"--trajectory", one, "--from-height", "nan"}).status, 2);
  EXPECT_EQ(audit({"--trajectory", one, "--clearance", "nan"}).status, 2);
  EXPECT_EQ(audit({"--trajectory", one, "--inflate", "nan"}).status, 2);
  const ProgramRun high = audit({"--trajectory", one, "--from-height", "5"});
  EXPECT_EQ(high.status, 1);
  EXPECT_THAT(high.err, HasSubstr("lower --from-height"));
  const ProgramRun bare = audit({"--trajectory", one, "--ground", "measured"});
  EXPECT_EQ(bare.status, 1);
  EXPECT_THAT(bare.err, HasSubstr("no surface was measured there"));
}

TEST_F(AuditCommand, TakesWhatMovesFromScenarios) {
  const std::string drive = folder_ / "drives/near.csv";
  for (const char* scenario : {"scenarios/pass_lorry.json", "scenarios/slower_lead.json"}) {
    const ProgramRun run =
        audit({"--trajectory", drive, "--obstacles", data_folder() / scenario, "--json"});
    EXPECT_TRUE(Json::parse(run.out).contains("verdict")) << run.err;
  }
}

TEST_F(AuditCommand, RefusesWhatCannotBeAudited) {
  const auto expect = [](const ProgramRun& run, int status, const char* reason) {
    EXPECT_EQ(run.status, status);
    EXPECT_THAT(run.out + run.err, HasSubstr(reason));
  };
  const std::string one = folder_ / "drives/near.csv";
  expect(audit({}), 2, "just one of --trajectory, --lane, and --from with --to");
  expect(audit({"--trajectory", one, "--lane", "lane:1"}), 2, "just one of");
  expect(audit({"--lane", "lane:1/0/-1"}), 2, "--map");
  expect(audit({"--trajectory", one, "--save-drive", folder_ / "x.csv"}), 2, "--save-drive");
  const std::string map = data_folder() / "town.xodr";
  expect(audit({"--trajectory", one, "--offset", "3"}), 2, "--offset");
  expect(audit({"--trajectory", one, "--speed", "80"}), 2, "--speed");
  expect(audit({"--trajectory", one, "--cost", "distance"}), 2, "--cost");
  expect(audit({"--trajectory", one, "--signal-cost", "3"}), 2, "--signal-cost");
  expect(audit({"--lane", "lane:1/0/-1", "--map", map, "--certificate", folder_ / "c.json"}), 2,
         "--save-drive");
  expect(audit({"--lane", "lane:1/0/-1", "--map", map, "--avoid", "lane:1/0/-1"}), 2, "--avoid");
  expect(audit({"--trajectory", drives_, "--svg", folder_ / "x.svg"}), 1, "one drive");
  std::filesystem::create_directories(folder_ / "empty");
  expect(audit({"--trajectory", folder_ / "empty"}), 1, "no drive");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "x.svg"));
}

}  // namespace
}  // namespace roadbed::tests
