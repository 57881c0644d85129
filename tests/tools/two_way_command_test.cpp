// Lanes of both directions as a user meets them: routes, reach and batches on a map of others.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tests {
namespace {

using nlohmann::json;

std::string karlsruhe(const std::filesystem::path& real) {
  return (real / "lanelet2/fzi-forschungszentrum-informatik+Lanelet2/mapping_example.osm").string();
}

// Lane 45476 is of both directions: from its end back over lanes behind it.
const std::string kBackFrom = "lane:45476@3", kBackTo = "lane:45470@1";

TEST(TwoWayCommands, RouteAgainstALaneSaysSoInEveryFormat) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  const std::string csv = testing::TempDir() + "two_way.csv";
  const ProgramRun run = run_roadbed({"route", karlsruhe(real), "--from", kBackFrom, "--to",
                                      kBackTo, "--json", "--quiet", "--force", "-o", csv});
  ASSERT_EQ(run.status, 0) << run.err;
  const json route = json::parse(run.out);
  double length_m = 0.0, cost_s = 0.0;
  for (const json& leg : route["lanes"]) {
    EXPECT_TRUE(leg["reversed"]);
    length_m += leg["from_s_m"].get<double>() - leg["to_s_m"].get<double>();
    cost_s += leg["cost_s"].get<double>();
  }
  EXPECT_EQ(route["lanes"].front()["from_s_m"], 3.0);
  EXPECT_EQ(route["lanes"].back()["to_s_m"], 1.0);
  EXPECT_NEAR(route["length_m"], length_m, 1e-6);
  EXPECT_NEAR(route["cost_s"], cost_s, 1e-9);
  std::istringstream rows(bytes_of(csv));
  std::string row;
  std::getline(rows, row);
  EXPECT_TRUE(row.ends_with(",reversed")) << row;
  std::getline(rows, row);
  EXPECT_TRUE(row.ends_with(",1")) << row;
}

TEST(TwoWayCommands, AHeadingDecidesWhichWayALaneIsDriven) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  const std::string file = testing::TempDir() + "two_way.geojson";
  const ProgramRun way = run_roadbed({"route", karlsruhe(real), "--from", kBackFrom, "--to",
                                      kBackTo, "-o", file, "--force", "--quiet"});
  ASSERT_EQ(way.status, 0) << way.err;
  const json line = json::parse(bytes_of(file))["features"][0]["geometry"]["coordinates"];
  const double x = line[0][0], y = line[0][1];
  const double back_rad = std::atan2(line[2][1].get<double>() - y, line[2][0].get<double>() - x);
  for (const bool back : {true, false}) {
    const double heading_rad = back ? back_rad : back_rad + (back_rad > 0.0 ? -1 : 1) * 3.14159;
    const ProgramRun run = run_roadbed({"route", karlsruhe(real), "--from",
                                        fmt::format("{:.3f},{:.3f},{:.4f}", x, y, heading_rad),
                                        "--to", kBackTo, "--json", "--quiet"});
    const json answer = json::parse(run.out);
    EXPECT_EQ(answer["from"]["candidates"][0]["sense"], back ? "against" : "along");
    EXPECT_EQ(answer["from"]["lane"], "45476");
    EXPECT_EQ(answer["found"], back) << "ahead there is no place to turn round";
    EXPECT_EQ(run.status, back ? 0 : 1);
    if (!back) {
      EXPECT_EQ(answer["blocking_rules"], json::array({"one_way"}));
    }
  }
}

TEST(TwoWayCommands, BatchAndReachDriveBackToo) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  const std::string pairs = testing::TempDir() + "two_way_pairs.csv";
  std::ofstream(pairs) << "from,to\n" << kBackFrom << ',' << kBackTo << '\n';
  const ProgramRun single = run_roadbed(
      {"route", karlsruhe(real), "--from", kBackFrom, "--to", kBackTo, "--json", "--quiet"});
  const ProgramRun batch =
      run_roadbed({"route", karlsruhe(real), "--batch", pairs, "--json", "--quiet"});
  ASSERT_EQ(batch.status, 0) << batch.err;
  EXPECT_EQ(json::parse(batch.out)["answers"][0]["lanes"], json::parse(single.out)["lanes"]);
  const ProgramRun reach = run_roadbed(
      {"reach", karlsruhe(real), "--from", kBackFrom, "--within", "20m", "--json", "--quiet"});
  ASSERT_EQ(reach.status, 0) << reach.err;
  const json reached = json::parse(reach.out);
  int back = 0, ahead = 0;
  for (const json& lane : reached["lanes"]) {
    ++(lane["from_s_m"] > lane["to_s_m"] ? back : ahead);
  }
  EXPECT_GT(back, 0);
  EXPECT_GT(ahead, 0);
}

}  // namespace
}  // namespace roadbed::tests
