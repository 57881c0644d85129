// Places and answers in longitude and latitude, at the command line.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/tools/town.h"

namespace roadbed::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

json answer_of(std::vector<std::string> words) {
  words.emplace_back("--json");
  const ProgramRun run = run_roadbed(words);
  EXPECT_EQ(run.status, 0) << run.err;
  return json::parse(run.out);
}

/// "lonlat:…" of a point, as `locate` says it.
std::string lon_lat_of(const std::string& map, const std::string& at) {
  const json point = answer_of({"locate", map, "--at", at, "--lonlat"}).at("points").at(0);
  return "lonlat:" + point.at("lon_deg").dump() + "," + point.at("lat_deg").dump();
}

TEST(LonLatPlaces, AreThePointsThatLocateSays) {
  const std::string crossing = data_folder() / "crossing.osm";
  for (const auto& [map, at] : std::vector<std::pair<std::string, std::string>>{
           {kTown, "150,198"}, {crossing, "700.25,300.5"}}) {
    SCOPED_TRACE(map);
    const json there = answer_of({"locate", map, "--at", at}).at("points").at(0);
    const json back = answer_of({"locate", map, "--at", lon_lat_of(map, at)}).at("points").at(0);
    EXPECT_NEAR(back.at("x_m").get<double>(), there.at("x_m").get<double>(), 1e-6);
    EXPECT_NEAR(back.at("y_m").get<double>(), there.at("y_m").get<double>(), 1e-6);
    EXPECT_EQ(back.at("lanes").size(), there.at("lanes").size());
  }
}

TEST(LonLatPlaces, AreTakenWhereverAPlaceIs) {
  const TemporaryFolder folder;
  const std::string at = lon_lat_of(kTown, "150,198");
  const auto cost = [](const json& route) { return route.at("cost_s").get<double>(); };
  const double expected = cost(answer_of({"route", kTown, "--from", "150,198", "--to", kGoal}));
  EXPECT_NEAR(cost(answer_of({"route", kTown, "--from", at, "--to", kGoal})), expected, 1e-5);
  EXPECT_NEAR(cost(answer_of({"route", kTown, "--from", at + ",0deg", "--via", at, "--to", kGoal})),
              expected, 1e-5);
  const std::string pairs = folder.write("pairs.csv", "from,to\n\"" + at + "\"," + kGoal + "\n");
  const json batch = answer_of({"route", kTown, "--batch", pairs});
  EXPECT_THAT(batch.dump(), HasSubstr("\"found\":true"));
  EXPECT_EQ(answer_of({"reach", kTown, "--from", at, "--within", "60s"}).at("lanes").size(),
            answer_of({"reach", kTown, "--from", "150,198", "--within", "60s"}).at("lanes").size());
  const std::string lon_lat = at.substr(7);
  const std::string points =
      folder.write("points.csv", "lat_deg,lon_deg\n" + lon_lat.substr(lon_lat.find(',') + 1) + "," +
                                     lon_lat.substr(0, lon_lat.find(',')) + "\n");
  const json located = answer_of({"locate", kTown, "--points", points}).at("points").at(0);
  EXPECT_NEAR(located.at("x_m").get<double>(), 150.0, 1e-6);
}

TEST(LonLatPlaces, AreTakenByScenarios) {
  const TemporaryFolder folder;
  const std::string text = bytes_of(data_folder() / "scenarios" / "way_points.json");
  json scenario = json::parse(text);
  const std::string map = data_folder() / "country.xodr";
  scenario["map"] = map;
  const std::string plain = folder.write("plain.json", scenario.dump());
  for (json& point : scenario["way_points"]) {
    const std::string place = point.get<std::string>();
    if (place.rfind("lane:", 0) != 0) point = lon_lat_of(map, place);
  }
  const std::string named = folder.write("named.json", scenario.dump());
  const json there = answer_of({"simulate", plain, "-o", folder / "plain", "--quiet"});
  const json here = answer_of({"simulate", named, "-o", folder / "named", "--quiet"});
  EXPECT_EQ(here.at("outcome"), there.at("outcome"));
}

std::vector<std::vector<std::string>> cells_of(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
  }
  return rows;
}

TEST(LonLatAnswers, OfAReferenceLineAreThatOfItsPoints) {
  const TemporaryFolder folder;
  const std::string out = folder / "line.csv";
  ASSERT_EQ(run_roadbed({"reference", kTown, "--from", "150,198", "--to", kGoal, "-o", out,
                         "--step", "20", "--lonlat", "--quiet"})
                .status,
            0);
  const auto rows = cells_of(bytes_of(out));
  ASSERT_GT(rows.size(), 5U);
  EXPECT_EQ(rows[0][3] + " " + rows[0][4], "lon_deg lat_deg");
  const json points = answer_of({"locate", kTown, "--points", out, "--lonlat"}).at("points");
  for (std::size_t i = 1; i < rows.size(); ++i) {
    EXPECT_NEAR(std::stod(rows[i][3]), points[i - 1].at("lon_deg").get<double>(), 1e-13);
    EXPECT_NEAR(std::stod(rows[i][4]), points[i - 1].at("lat_deg").get<double>(), 1e-13);
  }
}

TEST(LonLatAnswers, OfARouteBeginAndEndWhereItDoes) {
  const TemporaryFolder folder;
  const json route =
      answer_of({"route", kTown, "--from", "lane:1/0/-1@10", "--to", kGoal, "--lonlat"});
  const json& first = route.at("lanes").at(0);
  const std::string place =
      "lonlat:" + first.at("from_lon_deg").dump() + "," + first.at("from_lat_deg").dump();
  const json there = answer_of({"locate", kTown, "--at", place, "--drivable"});
  const json& lane = there.at("points").at(0).at("lanes").at(0);
  EXPECT_EQ(lane.at("lane"), "1/0/-1");
  EXPECT_NEAR(lane.at("s_m").get<double>(), 10.0, 1e-3);
  EXPECT_NEAR(lane.at("d_m").get<double>(), 0.0, 1e-3);

  const std::string out = folder / "way.geojson";
  ASSERT_EQ(run_roadbed({"route", kTown, "--from", "lane:1/0/-1@10", "--to", kGoal, "--lonlat",
                         "-o", out, "--quiet"})
                .status,
            0);
  const json way = json::parse(bytes_of(out));
  EXPECT_FALSE(way.contains("crs"));
  const json& at = way.at("features").at(0).at("geometry").at("coordinates").at(0);
  EXPECT_NEAR(at.at(0).get<double>(), first.at("from_lon_deg").get<double>(), 1e-9);
  EXPECT_NEAR(at.at(1).get<double>(), first.at("from_lat_deg").get<double>(), 1e-9);

  const std::string reach = folder / "reach.csv";
  ASSERT_EQ(run_roadbed({"reach", kTown, "--from", "lane:1/0/-1@10", "--within", "60s", "--lonlat",
                         "-o", reach})
                .status,
            0);
  EXPECT_EQ(cells_of(bytes_of(reach))[0].back(), "to_lat_deg");
  EXPECT_EQ(cells_of(bytes_of(reach))[1].size(), cells_of(bytes_of(reach))[0].size());
}

TEST(LonLatAnswers, AreRefusedWithAReasonWhereTheSystemIsUnknown) {
  const std::string map = data_folder() / "junction.xml";
  const std::string reason = "the map names no coordinate system";
  EXPECT_THAT(run_roadbed({"locate", map, "--at", "lonlat:8,49"}).err, HasSubstr(reason));
  EXPECT_THAT(run_roadbed({"locate", map, "--at", "0,0", "--lonlat"}).err, HasSubstr(reason));
  const ProgramRun run =
      run_roadbed({"route", map, "--from", "lonlat:8,49", "--to", "lonlat:8,49"});
  EXPECT_THAT(run.err, HasSubstr("place \"lonlat:8,49\""));
  EXPECT_EQ(run.out, "");
}

// Modules are looked for beside the program: a link to it that stands alone finds none.
TEST(LonLatAnswers, AreRefusedWithAReasonWhereProjIsNotInstalled) {
  const TemporaryFolder folder(program_file().parent_path());
  const std::filesystem::path program = folder / "bin/roadbed";
  std::filesystem::create_directory(folder / "bin");
  std::filesystem::create_hard_link(program_file(), program);
  const ProgramRun run = run_program(program, {"locate", kTown, "--at", "lonlat:9,48.5"});
  EXPECT_NE(run.status, 0);
  EXPECT_THAT(run.err, HasSubstr("libroadbed_proj.so is not installed"));
  EXPECT_EQ(run.out, "");
}

}  // namespace
}  // namespace roadbed::tests
