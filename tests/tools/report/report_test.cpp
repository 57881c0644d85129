#include "roadbed/tools/report/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "roadbed/tests/support/holds.h"
#include "roadbed/tests/support/sample_report.h"

namespace roadbed::tools {
namespace {

using nlohmann::json;
using tests::holds;

std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t start = text.find(from) + from.size();
  return text.substr(start, text.find(to, start) - start);
}

json data_of(const std::string& html) {
  return json::parse(between(html, "<script type=\"application/json\" id=\"data\">", "</script>"));
}

// What page/decode.js does, written again.
std::vector<double> values_of(const json& coded) {
  std::vector<double> values;
  long long sum = 0;
  for (const json& step : coded.at("v")) {
    if (!step.is_null()) sum += step.get<long long>();
    values.push_back(step.is_null() ? std::numeric_limits<double>::quiet_NaN()
                                    : static_cast<double>(sum) * coded.at("scale").get<double>());
  }
  return values;
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(Report, HoldsTheDriveWithinHalfAMillimetre) {
  const ReportInput input = tests::sample_report();
  const json data = data_of(drive_report_html(input));
  const auto x = values_of(data["drive"]["x"]), y = values_of(data["drive"]["y"]);
  const auto& points = input.drive.trajectory.points();
  ASSERT_EQ(x.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(data["origin"][0].get<double>() + x[i], points[i].x_m, 5.1e-4);
    EXPECT_NEAR(data["origin"][1].get<double>() + y[i], points[i].y_m, 5.1e-4);
  }
}

TEST(Report, HoldsPlottedValuesToFourDigitsAndTheirGaps) {
  const ReportInput input = tests::sample_report();
  const json data = data_of(drive_report_html(input));
  for (std::size_t p = 0; p < input.plots.size(); ++p) {
    for (std::size_t s = 0; s < input.plots[p].series.size(); ++s) {
      const auto found = values_of(data["plots"][p]["series"][s]);
      const auto& given = input.plots[p].series[s].values;
      ASSERT_EQ(found.size(), given.size());
      double largest = 0.0;
      for (const double value : given) largest = std::fmax(largest, std::abs(value));
      for (std::size_t i = 0; i < given.size(); ++i) {
        ASSERT_EQ(std::isfinite(found[i]), std::isfinite(given[i]));
        if (!std::isfinite(given[i])) continue;
        EXPECT_NEAR(found[i], given[i], 3e-4 * largest);
      }
    }
  }
}

TEST(Report, IsTheSameBytesTwice) {
  EXPECT_EQ(drive_report_html(tests::sample_report()), drive_report_html(tests::sample_report()));
}

TEST(Report, AsksForNothingOutsideItself) {
  const std::string html = drive_report_html(tests::sample_report());
  EXPECT_TRUE(holds(html, "content=\"default-src 'none'; script-src 'unsafe-inline'"));
  for (const char* way : {"<link", "<iframe", "<img", "<script src", "@import", "url(", "fetch(",
                          "sourceMappingURL", "href=\"http"}) {
    EXPECT_FALSE(holds(html, way)) << way;
  }
}

TEST(Report, HasNoElementOutOfATextOfItsInput) {
  const ReportInput plain = tests::sample_report();
  ReportInput input = plain;
  const std::string attack = "\"'></script></style><script>alert(1)</script><b>{{data}}";
  input.title = input.scenario = input.origin.command = input.origin.version = input.origin.crs =
      attack;
  input.verdict.text = input.audit->text = attack;
  map::RoadMapParts road = tests::sample_road();
  road.lanes[0].name = attack;
  input.scene.road_map = std::make_shared<const map::RoadMap>(std::move(road));
  input.scene.obstacles[0].id = input.scene.obstacles[0].kind = attack;
  input.drive.cycles[0].chosen.reset();
  input.drive.cycles[0].plan_reason = input.decisions[0].state = input.decisions[0].reason = attack;
  input.drive.events[0].text = input.plots[0].title = input.plots[0].unit = attack;
  input.plots[0].series[0].name = attack;
  input.checks[0].name = input.checks[0].unit = input.checks[0].bound = attack;
  input.origin.sources[0] = {attack, attack, attack};
  const std::string before = drive_report_html(plain), after = drive_report_html(input);
  for (const char* part : {"<script", "</script", "</style", "<b>", "application/json"}) {
    EXPECT_EQ(count_of(after, part), count_of(before, part)) << part;
  }
  EXPECT_EQ(data_of(after)["obstacles"][0]["id"], attack);
}

TEST(Report, TakesNamesThatAreNoUtf8) {
  ReportInput input = tests::sample_report();
  input.title = input.scene.obstacles[0].id = "caf\xE9";
  const std::string html = drive_report_html(input);
  EXPECT_TRUE(holds(html, "<h1>caf\xEF\xBF\xBD</h1>"));
  EXPECT_EQ(data_of(html)["obstacles"][0]["id"], "caf\xEF\xBF\xBD");
}

TEST(Report, SaysInWordsAndShapesWhatPassed) {
  const std::string html = drive_report_html(tests::sample_report());
  EXPECT_TRUE(holds(html,
                    "<td>largest jerk</td><td class=\"number\">9.1 m/s³</td>"
                    "<td class=\"number\">≤ 8.37</td><td>comfort, nuPlan</td>"));
  EXPECT_EQ(count_of(html, "✔ passed"), 4U);
  EXPECT_EQ(count_of(html, "✖ failed"), 1U);
  EXPECT_TRUE(holds(html, "<dd>4 of 5</dd>"));
}

TEST(Report, NamesItsInputsAndHowToMakeItAgain) {
  const std::string html = drive_report_html(tests::sample_report());
  EXPECT_TRUE(holds(html, "<code>roadbed simulate data/scenarios/parked_car.json -o out</code>"));
  EXPECT_TRUE(holds(html, "<code>9f1c2ab0d4e5f607</code>"));
  EXPECT_TRUE(holds(html, "Permission is hereby granted"));  // the plots' licence
}

TEST(Report, FoldsAwayALongListOfInputsOfOneKind) {
  ReportInput input = tests::sample_report();
  input.origin.sources = {{"map", "town.xodr", "1"}};
  for (int i = 0; i < 28; ++i) input.origin.sources.push_back({"cloud", "scan.pcd", "2"});
  const std::string html = drive_report_html(input);
  EXPECT_TRUE(holds(html, "<dt>map</dt><dd><code>town.xodr</code>"));
  EXPECT_TRUE(holds(html, "<dt>cloud</dt><dd><details><summary>28 files</summary>"));
  EXPECT_EQ(count_of(html, "<code>scan.pcd</code>"), 28U);
}

TEST(Report, OfNothingIsAPageToo) {
  const json data = data_of(drive_report_html({}));
  EXPECT_TRUE(data["drive"]["t"]["v"].empty());
  EXPECT_TRUE(data["goal"].is_null());
}

TEST(Report, RefusesASeriesThatDoesNotFitItsTimes) {
  ReportInput input = tests::sample_report();
  input.plots[0].series[0].values.pop_back();
  EXPECT_THROW(drive_report_html(input), std::invalid_argument);
}

// Rows every 10 ms for a minute, seven plots of three restless series, a plan of 31 points ten
// times a second.
ReportInput restless_minute() {
  ReportInput input = tests::sample_report();
  std::vector<geometry::TrajectoryPoint> points;
  for (int i = 0; i <= 6000; ++i) {
    const double t_s = 0.01 * i;
    points.push_back({t_s, 12.0 * t_s, 3.0 * std::sin(t_s), 0.25 * std::cos(t_s),
                      12.0 + std::sin(3.1 * t_s), std::cos(7.7 * t_s), 0.1 * std::sin(9.0 * t_s),
                      0.0});
  }
  input.drive.trajectory = geometry::Trajectory(points);
  ReportPlot plot{
      .title = "restless", .unit = "m/s", .t_s = {}, .series = {}, .lower = {}, .upper = {}};
  plot.series.resize(3);
  for (const auto& point : points) {
    plot.t_s.push_back(point.t_s);
    for (auto& series : plot.series) series.values.push_back(std::sin(1e4 * point.t_s));
  }
  input.plots.assign(7, plot);
  input.drive.cycles.clear();
  for (int cycle = 0; cycle < 600; ++cycle) {
    DriveCycle planned{.t_s = 0.1 * cycle, .reason = "car p1 is 22.4 m ahead"};
    planned.chosen = planning::Candidate{.end_d_m = 0.2, .end_l_m = 24.0};
    for (int i = 0; i < 31; ++i) planned.path.emplace_back(1.2 * cycle + i, std::sin(i));
    input.drive.cycles.push_back(planned);
  }
  return input;
}

TEST(Report, OfAMinuteHasAtMostThreeMegabytes) {
  EXPECT_LE(drive_report_html(restless_minute()).size(), 3'000'000U);
}

}  // namespace
}  // namespace roadbed::tools
