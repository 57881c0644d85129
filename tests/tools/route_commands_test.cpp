// `locate`, `route` and `reference` as a user runs them, on the project's own town.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/tools/csv_rows.h"
#include "roadbed/tests/tools/town.h"

namespace roadbed::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kFrom = "lane:1/0/-1@10", kTo = "lane:7/0/1@55";

TEST(RouteCommand, PrintsOneJsonDocumentWithConnectedLanes) {
  const ProgramRun run = run_roadbed({"route", kTown, "--from", kFrom, "--to", kTo, "--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  const json route = json::parse(run.out);
  EXPECT_TRUE(route["found"]);
  EXPECT_EQ(route["lanes"].front()["lane"], "1/0/-1");
  EXPECT_EQ(route["lanes"].front()["from_s_m"], 10.0);
  EXPECT_EQ(route["lanes"].back()["lane"], "7/0/1");
  EXPECT_EQ(route["lanes"].back()["to_s_m"], 55.0);
  double length_m = 0.0;
  for (const json& lane : route["lanes"]) {
    length_m += lane["to_s_m"].get<double>() - lane["from_s_m"].get<double>();
  }
  EXPECT_NEAR(route["length_m"].get<double>(), length_m, 1e-6);  // no lane change on this way
  EXPECT_EQ(route["lane_changes"], 0);
}

TEST(RouteCommand, GoesRoundAClosedLaneOrSaysWhyItCannot) {
  const auto route_with = [&](const std::string& avoid) {
    return run_roadbed({"route", kTown, "--from", kFrom, "--to", kTo, "--avoid", avoid, "--json"});
  };
  const ProgramRun free = run_roadbed({"route", kTown, "--from", kFrom, "--to", kTo, "--json"});
  const std::string closed = json::parse(free.out)["lanes"][8]["lane"];
  const ProgramRun round = route_with("lane:" + closed);
  ASSERT_EQ(round.status, 0) << round.err;
  EXPECT_EQ(round.out.find("\"" + closed + "\""), std::string::npos);
  EXPECT_GT(json::parse(round.out)["cost_s"], json::parse(free.out)["cost_s"]);

  const ProgramRun none = route_with("lane:7/0/1");
  EXPECT_EQ(none.status, 1);
  const json answer = json::parse(none.out);
  EXPECT_FALSE(answer["found"]);
  EXPECT_THAT(answer["reason"].get<std::string>(), HasSubstr("goal is on lane 7/0/1"));
  const ProgramRun start = route_with("road:1");
  EXPECT_EQ(start.status, 1);
  EXPECT_THAT(start.err, HasSubstr("start is on lane 1/0/-1, which is closed"));
  EXPECT_EQ(route_with("road:none").status, 3);
  EXPECT_EQ(route_with("polygon:1,2,3").status, 2);
  EXPECT_EQ(route_with("polygon:0,0,nan,1,2,2").status, 2);
  EXPECT_EQ(route_with("everything").status, 2);
}

TEST(RouteCommand, APolygonClosesWhatItTouchesAndOffTheMapNothing) {
  const auto route_with = [&](const std::string& polygon) {
    return run_roadbed(
        {"route", kTown, "--from", kFrom, "--to", kTo, "--json", "--avoid", "polygon:" + polygon});
  };
  const ProgramRun free = run_roadbed({"route", kTown, "--from", kFrom, "--to", kTo, "--json"});
  EXPECT_EQ(route_with("-10000,-10000,-9999,-10000,-9999,-9999").out, free.out);
  const ProgramRun start = route_with("269,202,271,202,271,204,269,204");
  EXPECT_EQ(start.status, 1);
  EXPECT_THAT(start.err, HasSubstr("start is on lane 1/0/-1, which is closed"));
}

TEST(RouteCommand, ListsTheLanesThatAPlaceMayBeOn) {
  const ProgramRun run =
      run_roadbed({"route", kTown, "--from", "270,205.2", "--to", kTo, "--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  const json from = json::parse(run.out)["from"];
  ASSERT_GE(from["candidates"].size(), 2U);
  EXPECT_EQ(from["candidates"][0]["verdict"], "chosen");
  EXPECT_EQ(from["candidates"][0]["lane"], from["lane"]);
}

TEST(RouteCommand, PassesViaPointsInOrder) {
  const ProgramRun run = run_roadbed({"route", kTown, "--from", kFrom, "--via", kTo, "--via",
                                      "lane:1/0/-1@12", "--to", kTo, "--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  const json route = json::parse(run.out);
  ASSERT_EQ(route["via"].size(), 2U);
  EXPECT_EQ(route["via"][0]["lane"], "7/0/1");
  EXPECT_EQ(route["via"][1]["s_m"], 12.0);
  double cost_s = 0.0;
  for (const json& lane : route["lanes"]) cost_s += lane["cost_s"].get<double>();
  EXPECT_NEAR(cost_s, route["cost_s"].get<double>(), 1e-6);
}

TEST(RouteCommand, GivesAlternativesWithTheirShare) {
  const ProgramRun run =
      run_roadbed({"route", kTown, "--from", kFrom, "--to", kTo, "--alternatives", "3", "--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  const json route = json::parse(run.out);
  ASSERT_GE(route["alternatives"].size(), 1U);
  for (const json& other : route["alternatives"]) {
    EXPECT_LE(other["shared_length_fraction"].get<double>(), 0.7);
    EXPECT_GE(other["cost_s"].get<double>(), route["cost_s"].get<double>());
  }
}

TEST(RouteCommand, AnswersGoodRowsOfABatchAndNamesTheBadOnes) {
  const TemporaryFolder folder;
  const std::string pairs = folder.write(
      "pairs.csv",
      "id,from,to\n1,lane:1/0/-1@10,lane:7/0/1@55\n2,\"270,203.375\",lane:7/0/1@55\n"
      "3,lane:99/0/1,lane:7/0/1@55\n4,only\n5,\"-1000,50\",lane:7/0/1\n6,,lane:7/0/1\n");
  const ProgramRun run = run_roadbed({"route", kTown, "--batch", pairs});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.err, HasSubstr("pairs.csv:4: "));
  EXPECT_THAT(run.err, HasSubstr("no lane 99/0/1"));
  EXPECT_THAT(run.err, HasSubstr("pairs.csv:5: 2 fields, the header has 3"));
  EXPECT_THAT(run.err, HasSubstr("pairs.csv:6: "));
  EXPECT_THAT(run.err, HasSubstr("pairs.csv:7: "));
  std::istringstream lines(run.out);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "row,from,to,found,cost_s,cost_m,length_m,lane_changes,lanes,reason");
  std::getline(lines, line);
  const json single =
      json::parse(run_roadbed({"route", kTown, "--from", kFrom, "--to", kTo, "--json"}).out);
  char expected[64];
  std::snprintf(expected, sizeof expected, "2,lane:1/0/-1@10,lane:7/0/1@55,1,%.4f,",
                single["cost_s"].get<double>());
  EXPECT_TRUE(line.starts_with(expected)) << line;
  const ProgramRun two = run_roadbed({"route", kTown, "--batch", pairs, "--threads", "2"});
  EXPECT_EQ(two.out, run.out);
  const std::string bad = folder.write("bad.csv", "a,b\n1,2\n");
  EXPECT_EQ(run_roadbed({"route", kTown, "--batch", bad}).status, 3);
  EXPECT_EQ(run_roadbed({"route", kTown, "--batch", folder / "none.csv"}).status, 3);
  EXPECT_EQ(run_roadbed({"route", kTown, "--batch", pairs, "--from", kFrom}).status, 2);
  EXPECT_EQ(run_roadbed({"route", kTown, "--matrix"}).status, 2);
}

TEST(RouteCommand, ABatchAsJsonExplainsRowsWithoutARouteAsSingleQuestionsDo) {
  const TemporaryFolder folder;
  const std::string pairs = folder.write("pairs.csv", std::string("from,to\n") + kFrom + "," + kTo +
                                                          "\n" + kFrom + ",lane:1/1/-1@1\n");
  const ProgramRun run =
      run_roadbed({"route", kTown, "--batch", pairs, "--avoid", "road:20", "--json"});
  EXPECT_EQ(run.status, 1);
  const json answers = json::parse(run.out)["answers"];
  ASSERT_EQ(answers.size(), 2U);
  json expected = json::parse(
      run_roadbed({"route", kTown, "--from", kFrom, "--to", kTo, "--avoid", "road:20", "--json"})
          .out);
  expected.erase("roadbed_route");  // the document of the batch says its own version
  expected.erase("from");
  expected.erase("to");
  expected["row"] = 2;
  EXPECT_EQ(answers[0], expected);
  EXPECT_EQ(answers[0]["blocking_rules"], json::parse(R"(["closed"])"));
  EXPECT_EQ(answers[1]["found"], true);
  EXPECT_EQ(run.out, run_roadbed({"route", kTown, "--batch", pairs, "--avoid", "road:20", "--json",
                                  "--threads", "2"})
                         .out);
}

TEST(RouteCommand, AMatrixHoldsEveryPairAsSingleQuestionsDo) {
  const TemporaryFolder folder;
  const std::string pairs = folder.write(
      "pairs.csv", "from,to\nlane:1/0/-1@10,lane:7/0/1@55\nlane:7/0/1@20,lane:1/0/-1@14\n");
  const ProgramRun run = run_roadbed({"route", kTown, "--batch", pairs, "--matrix", "--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  const json cells = json::parse(run.out)["answers"];
  ASSERT_EQ(cells.size(), 4U);
  const char* froms[] = {"lane:1/0/-1@10", "lane:7/0/1@20"};
  const char* tos[] = {"lane:7/0/1@55", "lane:1/0/-1@14"};
  for (std::size_t i = 0; i < 4; ++i) {
    const json single = json::parse(
        run_roadbed({"route", kTown, "--from", froms[i / 2], "--to", tos[i % 2], "--json"}).out);
    EXPECT_NEAR(cells[i]["cost_s"].get<double>(), single["cost_s"].get<double>(), 0.01);
  }
}

TEST(RouteCommand, RefusesAMatrixOfMorePairsThanItHolds) {
  const TemporaryFolder folder;
  std::string rows = "from,to\n";
  for (int i = 0; i < 900; ++i) rows += "lane:1/0/-1@10,lane:7/0/1@55\n";
  const std::string pairs = folder.write("pairs.csv", rows);
  const ProgramRun table =
      run_roadbed({"route", kTown, "--batch", pairs, "--matrix", "-o", folder / "matrix.csv"});
  EXPECT_EQ(table.status, 0) << table.err;
  const ProgramRun document = run_roadbed({"route", kTown, "--batch", pairs, "--matrix", "--json"});
  EXPECT_EQ(document.status, 3);
  EXPECT_THAT(document.err, testing::HasSubstr("900 rows, of which a matrix has 810000 pairs"));
}

TEST(RouteCommand, WritesLegsAsCsvAndAPictureOfTheWay) {
  const TemporaryFolder folder;
  const std::string csv = folder / "way.csv", svg = folder / "way.svg";
  ASSERT_EQ(run_roadbed({"route", kTown, "--from", kFrom, "--to", kTo, "-o", csv}).status, 0);
  EXPECT_THAT(bytes_of(csv), HasSubstr("\n0,0,1/0/-1,10.000,"));
  ASSERT_EQ(run_roadbed({"route", kTown, "--from", kFrom, "--to", kTo, "-o", svg}).status, 0);
  EXPECT_THAT(bytes_of(svg), HasSubstr("<svg"));
}

TEST(RouteCommands, RefuseAnOutputWhoseSuffixNamesNoFormat) {
  const TemporaryFolder folder;
  const std::string file = folder / "way.pdf";
  for (const auto& run :
       {run_roadbed({"route", kTown, "--from", kFrom, "--to", kTo, "-o", file}),
        run_roadbed({"reach", kTown, "--from", kFrom, "--within", "9s", "-o", file})}) {
    EXPECT_EQ(run.status, 3);
    EXPECT_THAT(run.err, HasSubstr("the suffix \".pdf\" names no format"));
    EXPECT_THAT(run.out, IsEmpty());
    EXPECT_FALSE(std::filesystem::exists(file));
  }
}

TEST(ReachCommand, GivesLanesAndTheirArea) {
  const TemporaryFolder folder;
  const std::string file = folder / "reach.geojson";
  const ProgramRun run =
      run_roadbed({"reach", kTown, "--from", kFrom, "--within", "150m", "--json", "-o", file});
  ASSERT_EQ(run.status, 0) << run.err;
  const json reached = json::parse(run.out);
  EXPECT_GT(reached["lanes"].size(), 1U);
  for (const json& lane : reached["lanes"]) {
    EXPECT_LE(lane["cost_m"].get<double>(), 150.0);
    EXPECT_EQ(lane["reversed"], false);
  }
  const json area = json::parse(bytes_of(file))["features"][0];
  EXPECT_EQ(area["geometry"]["type"], "MultiPolygon");
  EXPECT_EQ(run_roadbed({"reach", kTown, "--from", kFrom, "--within", "150"}).status, 2);
  EXPECT_EQ(run_roadbed({"reach", kTown, "--from", kFrom, "--within", "-5s"}).status, 2);
  EXPECT_EQ(run_roadbed({"reach", kTown, "--from", "lane:1/3/3@1", "--within", "5s"}).status, 1);
}

TEST(RouteCommand, WritesTheWayAsGeoJson) {
  const TemporaryFolder folder;
  const std::string file = folder / "way.geojson";
  ASSERT_EQ(run_roadbed({"route", kTown, "--from", kFrom, "--to", kTo, "-o", file}).status, 0);
  const json line = json::parse(bytes_of(file))["features"][0]["geometry"];
  EXPECT_EQ(line["type"], "LineString");
  EXPECT_GT(line["coordinates"].size(), 1000U);
  EXPECT_NEAR(line["coordinates"][0][0].get<double>(), 270.0, 1e-6);
}

TEST(RouteCommand, RefusesPlacesThatAreNotOnTheMap) {
  const ProgramRun off = run_roadbed({"route", kTown, "--from", "-1000,50", "--to", kTo});
  EXPECT_EQ(off.status, 3);
  EXPECT_THAT(off.err, HasSubstr("nearest drivable lane is"));
  EXPECT_THAT(off.err, HasSubstr(" m away"));
  EXPECT_EQ(run_roadbed({"route", kTown, "--from", "lane:99/0/1", "--to", kTo}).status, 3);
  EXPECT_EQ(
      run_roadbed({"route", kTown, "--from", kFrom, "--to", kTo, "--avoid", "lane:99/0/1"}).status,
      3);
  EXPECT_EQ(run_roadbed({"route", kTown, "--from", "1,2,90", "--to", kTo}).status, 2);
  EXPECT_EQ(run_roadbed({"route", kTown, "--from", kFrom}).status, 2);
}

TEST(ReferenceCommand, RowsAreOneStepApartAndDescribeOneCurve) {
  const TemporaryFolder folder;
  const std::string file = folder / "line.csv";
  const ProgramRun run =
      run_roadbed({"reference", kTown, "--from", kFrom, "--to", kTo, "-o", file});
  ASSERT_EQ(run.status, 0) << run.err;
  const std::string csv = bytes_of(file);
  EXPECT_EQ(csv.substr(0, csv.find('\n')),
            "s_m,x_m,y_m,heading_rad,curvature_per_m,curvature_rate_per_m2,left_m,right_m,"
            "speed_limit_mps");
  const auto rows = rows_of(file);
  ASSERT_GT(rows.size(), 2000U);
  for (std::size_t i = 1; i + 1 < rows.size(); ++i) {
    const auto &before = rows[i - 1], &row = rows[i];
    ASSERT_EQ(row.size(), 9U);
    const double step = row[0] - before[0];
    EXPECT_NEAR(step, 0.5, 1e-9);
    EXPECT_NEAR(std::hypot(row[1] - before[1], row[2] - before[2]), step, 1e-3);
    EXPECT_NEAR(row[3] - before[3], 0.5 * step * (row[4] + before[4]), 1e-3);
    EXPECT_NEAR(row[4] - before[4], 0.5 * step * (row[5] + before[5]), 1e-3);
    EXPECT_GE(row[6], 0.8) << "left at " << row[0] << " m";
    EXPECT_GE(row[7], 0.8) << "right at " << row[0] << " m";
    EXPECT_GT(row[8], 1.0);
    EXPECT_LE(std::abs(row[4]), 0.2);
  }
  const ProgramRun again =
      run_roadbed({"reference", kTown, "--from", kFrom, "--to", kTo, "-o", file});
  EXPECT_EQ(again.status, 3) << "an existing file is not replaced";
}

TEST(ReferenceCommand, WithoutARouteWritesNothing) {
  const TemporaryFolder folder;
  const ProgramRun run = run_roadbed(
      {"reference", kTown, "--from", kFrom, "--to", "lane:1/3/3@1", "-o", folder / "line.csv"});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.err, HasSubstr("sidewalk"));
  EXPECT_TRUE(files_below(folder.path()).empty());
}

TEST(LocateCommand, FindsTheLaneThatAReferenceLineStartsOn) {
  const ProgramRun run = run_roadbed({"locate", kTown, "--at", "270,203.375", "--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  const json lanes = json::parse(run.out)["points"][0]["lanes"];
  EXPECT_EQ(lanes[0]["lane"], "1/0/-1");
  EXPECT_EQ(lanes[0]["road"], "1");
  EXPECT_NEAR(lanes[0]["s_m"].get<double>(), 10.0, 1e-6);
  EXPECT_NEAR(lanes[0]["d_m"].get<double>(), 0.0, 1e-3);
  EXPECT_EQ(lanes[0]["distance_m"], 0.0);
  EXPECT_NEAR(std::abs(lanes[0]["heading_rad"].get<double>()), std::acos(-1.0), 1e-6);
  EXPECT_NEAR(lanes[0]["road_s_m"].get<double>(), 10.0, 1e-6);
  EXPECT_LT(lanes[0]["road_t_m"].get<double>(), -1.0);
}

TEST(LocateCommand, ReadsPointsFromACsvFile) {
  const TemporaryFolder folder;
  const std::string file = folder.write("points.csv", "id,x_m,y_m\n1,270,203.375\n2,260,203.375\n");
  const ProgramRun run = run_roadbed({"locate", kTown, "--points", file, "--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  const json points = json::parse(run.out)["points"];
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[1]["x_m"], 260.0);
  const std::string bad = folder.write("bad.csv", "x_m,y_m\n1,nan\n");
  const ProgramRun refused = run_roadbed({"locate", kTown, "--points", bad});
  EXPECT_EQ(refused.status, 3);
  EXPECT_THAT(refused.err, HasSubstr("bad.csv:2"));
  EXPECT_EQ(run_roadbed({"locate", kTown}).status, 2);
  EXPECT_EQ(run_roadbed({"locate", kTown, "--at", "1,x"}).status, 2);
}

}  // namespace
}  // namespace roadbed::tests
