#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/tools/audit/audit_command_fixture.h"

namespace roadbed::tests {
namespace {

using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

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

TEST_F(AuditCommand, FindsInAFolderWhatItFindsOfEachDriveByItself) {
  // One is far from the others, so that it has surroundings of its own.
  folder_.write("drives/away.csv", "t_s,x_m,y_m,heading_rad\n0,900,0,0\n10,920,0,0\n");
  std::size_t compared = 0;
  for (const char* clearance : {"0", "0.3"}) {
    const std::vector<std::string> asked{"--clearance", clearance, "--json", "--trajectory"};
    const auto audit_of = [&](const std::string& drives) {
      std::vector<std::string> arguments = asked;
      arguments.push_back(drives);
      return Json::parse(audit(arguments).out);
    };
    const Json all = audit_of(drives_);
    for (Json one : all.at("audits")) {
      if (one.contains("fault")) continue;
      Json alone = audit_of(folder_ / "drives" / one.at("drive").get<std::string>());
      alone.erase("roadbed_audit");
      one.erase("drive");
      EXPECT_EQ(one, alone);
      ++compared;
    }
  }
  EXPECT_EQ(compared, 8u);
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

TEST_F(AuditCommand, SweepsARoute) {
  const std::string map = data_folder() / "town.xodr", town = data_folder() / "town.bt";
  const ProgramRun run =
      run_roadbed({"audit", "--occupancy", town, "--map", map, "--from", "lane:1/0/-1", "--to",
                   "lane:1/1/-1@5", "--unknown", "free", "--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NEAR(Json::parse(run.out).at("stretches").at(0).at("to_s").get<double>(),
              20.0 / (30.0 / 3.6), 0.05);
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
                                                  "m at the drive's samples"));
    EXPECT_EQ(audit_on("hit.csv", ground).status, 1);
  }
  // Certificates whose ground is not under the drive, is no ground, or is not what their files say.
  const auto of_forged = [&](const Json& forgery) {
    const ProgramRun run =
        run_roadbed({"audit", "--check", folder_.write("forged.json", forgery.dump())});
    EXPECT_EQ(run.status, run.out.empty() ? 3 : 1) << "it does not hold, or is no certificate";
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
  EXPECT_THAT(check.out, HasSubstr("0.0 % of the space that the vehicle takes, 25 % required"));
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
  EXPECT_EQ(high.status, 3);
  EXPECT_THAT(high.err, HasSubstr("lower --from-height"));
  const ProgramRun bare = audit({"--trajectory", one, "--ground", "measured"});
  EXPECT_EQ(bare.status, 3);
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
  expect(audit({}), 2, "just one of --trajectory, --log, --lane, and --from with --to");
  expect(audit({"--trajectory", one, "--lane", "lane:1"}), 2, "just one of");
  expect(audit({"--lane", "lane:1/0/-1"}), 2, "--map");
  expect(audit({"--trajectory", drives_, "--save-drive", folder_ / "x.csv"}), 3, "one drive");
  const std::string poses = folder_.write("poses.txt", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n");
  expect(audit({"--trajectory", poses}), 3, "--pose-frame");
  expect(audit({"--trajectory", poses, "--pose-frame", "rear-axle", "--certificate",
                folder_ / "c.json"}),
         3, "--save-drive beside --certificate");
  const std::string map = data_folder() / "town.xodr";
  expect(audit({"--trajectory", one, "--offset", "3"}), 2, "--offset");
  expect(audit({"--trajectory", one, "--speed", "80"}), 2, "--speed");
  expect(audit({"--trajectory", one, "--cost", "distance"}), 2, "--cost");
  expect(audit({"--trajectory", one, "--signal-cost", "3"}), 2, "--signal-cost");
  expect(audit({"--lane", "lane:1/0/-1", "--map", map, "--certificate", folder_ / "c.json"}), 2,
         "--save-drive");
  expect(audit({"--lane", "lane:1/0/-1", "--map", map, "--avoid", "lane:1/0/-1"}), 2, "--avoid");
  expect(audit({"--trajectory", drives_, "--svg", folder_ / "x.svg"}), 3, "one drive");
  std::filesystem::create_directories(folder_ / "empty");
  expect(audit({"--trajectory", folder_ / "empty"}), 3, "no drive");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "x.svg"));
}

// In cells of 0.1 m, as build does.
TEST_F(AuditCommand, TakesACloudInPlaceOfTheOctreeThatIsBuiltOfIt) {
  const std::string cloud = folder_ / "post.pcd", drive = folder_ / "drives/near.csv";
  const auto audit_over = [&](const std::string& occupancy) {
    return run_roadbed(
        {"audit", "--occupancy", occupancy, "--trajectory", drive, "--unknown", "free", "--json"});
  };
  const ProgramRun of_cloud = audit_over(cloud);
  EXPECT_EQ(of_cloud.out, audit_over(octree_).out);
  EXPECT_EQ(of_cloud.status, 0) << of_cloud.err;
  const std::string proof = folder_ / "proof.json";
  ASSERT_EQ(run_roadbed({"audit", "--occupancy", cloud, "--trajectory", drive, "--unknown", "free",
                         "--certificate", proof})
                .status,
            0);
  EXPECT_EQ(run_roadbed({"audit", "--check", proof}).status, 0);
}

// The filter of a cloud says the same here as where an octree is built.
TEST_F(AuditCommand, CountsThePointsThatAFilterLeaves) {
  std::string points = "x,y,z,class,intensity\n";
  for (double z = 0.05; z < 2.5; z += 0.05) {
    points += "10.05,1.05," + std::to_string(z) + ",7,1\n";  // noise, and faint
    points += "8.05,-4.05," + std::to_string(z) + ",6,9\n";
    points += "16.05,-4.05," + std::to_string(z) + ",6,9\n";
  }
  const std::string cloud = folder_.write("cloud.csv", points), octree = folder_ / "some.bt";
  const std::string drive = folder_ / "drives/hit.csv", log = folder_ / "filtered.json";
  const auto audit_over = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"audit", "--trajectory", drive, "--unknown", "free", "--json"});
    return run_roadbed(words);
  };
  EXPECT_EQ(audit_over({"--occupancy", cloud}).status, 1) << "the noise is in the way";
  for (const std::vector<std::string>& filter : {std::vector<std::string>{"--without-classes", "7"},
                                                 {"--intensity", "5,10"},
                                                 {"--vehicle-box", "9,0,0,11,2,3"}}) {
    std::vector<std::string> build{"occupancy", "build", cloud, "-o", octree, "-q", "--force"};
    build.insert(build.end(), filter.begin(), filter.end());
    ASSERT_EQ(run_roadbed(build).status, 0) << filter[0];
    std::vector<std::string> words{"--occupancy", cloud};
    words.insert(words.end(), filter.begin(), filter.end());
    const ProgramRun filtered = audit_over(words);
    EXPECT_EQ(filtered.status, 0) << filter[0] << ": " << filtered.err;
    EXPECT_EQ(filtered.out, audit_over({"--occupancy", octree}).out) << filter[0];
  }
  const auto refusal = [&](const std::vector<std::string>& words) { return audit_over(words).err; };
  EXPECT_THAT(refusal({"--occupancy", octree_, "--height", "0,1"}), HasSubstr("is an octree"));
  EXPECT_THAT(refusal({"--occupancy", cloud, "--height", "90,99"}), HasSubstr("no point"));
  EXPECT_THAT(refusal({"--occupancy", cloud, "--classes", "6", "--certificate", log}),
              HasSubstr("--certificate needs --save-occupancy"));
  const std::string saved = folder_ / "saved.bt";
  EXPECT_EQ(audit_over({"--occupancy", cloud, "--classes", "6", "--certificate", log,
                        "--save-occupancy", saved})
                .status,
            0);
  EXPECT_EQ(run_roadbed({"audit", "--check", log, "--occupancy", saved}).status, 0);
  EXPECT_EQ(run_roadbed({"audit", "--check", log, "--occupancy", octree_}).status, 1);
}

TEST_F(AuditCommand, TakesALogOfCloudsInPlaceOfTheOctreeThatIsBuiltOfIt) {
  const std::string log =
      (data_folder() / "../tests/fuzz/corpus/log/clouds.mcap").lexically_normal().string();
  const std::string octree = folder_ / "log.bt", drive = folder_ / "drives/near.csv";
  ASSERT_EQ(run_roadbed({"occupancy", "build", log, "-o", octree, "-q"}).status, 0);
  const auto audit_over = [&](const std::string& occupancy) {
    return run_roadbed({"audit", "--occupancy", occupancy, "--trajectory", drive, "--json"});
  };
  const ProgramRun of_log = audit_over(log);
  EXPECT_LE(of_log.status, 1) << of_log.err;
  EXPECT_EQ(of_log.out, audit_over(octree).out);
  std::filesystem::create_directories(folder_ / "bag");
  folder_.write("bag/metadata.yaml", "relative_file_paths:\n- clouds.mcap\n");
  folder_.write("bag/clouds.mcap", bytes_of(log));
  const ProgramRun of_bag = run_roadbed({"audit", "--occupancy", folder_ / "bag", "--trajectory",
                                         drive, "--report", folder_ / "bag.html"});
  EXPECT_LE(of_bag.status, 1) << of_bag.err;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "bag.html")) << of_bag.err;
}

}  // namespace
}  // namespace roadbed::tests
