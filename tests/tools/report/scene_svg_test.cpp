#include "roadbed/tools/report/report.h"

#include <gtest/gtest.h>

#include <pugixml.hpp>
#include <string>
#include <vector>

#include "roadbed/tests/support/sample_report.h"

namespace roadbed::tools {
namespace {

pugi::xml_document parsed(const std::string& svg) {
  pugi::xml_document document;
  const auto result = document.load_string(svg.c_str());
  EXPECT_TRUE(result) << result.description();
  return document;
}

std::vector<pugi::xml_node> with_class(const pugi::xml_document& document,
                                       const std::string& css_class) {
  std::vector<pugi::xml_node> nodes;
  for (const auto& found : document.select_nodes(("//*[@class='" + css_class + "']").c_str())) {
    nodes.push_back(found.node());
  }
  return nodes;
}

// First point of path data, "M12.3 45.6…".
Eigen::Vector2d first_point(const pugi::xml_node& path) {
  const std::string data = path.attribute("d").value();
  const std::size_t space = data.find(' ');
  return {std::stod(data.substr(1, space - 1)), std::stod(data.substr(space + 1))};
}

ReportInput straight_drive(double heading_rad) {
  ReportInput input;
  const Eigen::Vector2d along(std::cos(heading_rad), std::sin(heading_rad));
  std::vector<geometry::TrajectoryPoint> points;
  for (int i = 0; i <= 20; ++i) {
    const Eigen::Vector2d place = 5.0 * i * along;
    points.push_back({.t_s = 0.5 * i, .x_m = place.x(), .y_m = place.y(), .speed_mps = 10.0});
  }
  input.drive.trajectory = geometry::Trajectory(points);
  input.scene.goal = 100.0 * along;
  return input;
}

TEST(SceneSvg, IsWellFormedAndShowsEveryLayer) {
  const auto document = parsed(drive_scene_svg(tests::sample_report()));
  for (const char* layer : {"drive", "shoulder", "walk", "border", "route", "occupied", "casing",
                            "speed", "ego", "moving", "standing", "pin start", "pin goal"}) {
    EXPECT_FALSE(with_class(document, layer).empty()) << layer;
  }
  EXPECT_STREQ(document.child("svg").attribute("width").value(), "900");
}

TEST(SceneSvg, HasNorthUpAndEastRight) {
  const auto north = parsed(drive_scene_svg(straight_drive(0.5 * M_PI)));
  EXPECT_LT(first_point(with_class(north, "pin goal")[0]).y(),
            first_point(with_class(north, "pin start")[0]).y() - 100.0);
  const auto east = parsed(drive_scene_svg(straight_drive(0.0)));
  EXPECT_GT(first_point(with_class(east, "pin goal")[0]).x(),
            first_point(with_class(east, "pin start")[0]).x() + 100.0);
}

TEST(SceneSvg, KeepsStartAndGoalInsideThePicture) {
  for (double heading_rad = 0.0; heading_rad < 6.2; heading_rad += 0.3) {
    const auto document = parsed(drive_scene_svg(straight_drive(heading_rad)));
    const double height_px = document.child("svg").attribute("height").as_double();
    for (const char* pin : {"pin start", "pin goal"}) {
      const Eigen::Vector2d at_px = first_point(with_class(document, pin)[0]);
      EXPECT_GT(at_px.minCoeff(), 20.0);
      EXPECT_LT(at_px.x(), 880.0);
      EXPECT_LT(at_px.y(), height_px - 46.0);
    }
  }
}

TEST(SceneSvg, HasOneColourForOneSpeed) {
  EXPECT_EQ(with_class(parsed(drive_scene_svg(straight_drive(0.3))), "speed").size(), 1U);
}

TEST(SceneSvg, HoldsNamesAsText) {
  ReportInput input = tests::sample_report();
  input.title = "</title><script>alert(1)</script>";
  const auto document = parsed(drive_scene_svg(input));
  EXPECT_EQ(document.select_nodes("//script").size(), 0U);
  EXPECT_EQ(document.child("svg").child("title").text().get(), input.title);
}

TEST(SceneSvg, IsTheSameBytesTwice) {
  EXPECT_EQ(drive_scene_svg(tests::sample_report()), drive_scene_svg(tests::sample_report()));
}

TEST(SceneSvg, OfNothingIsAPictureToo) { parsed(drive_scene_svg({})); }

}  // namespace
}  // namespace roadbed::tools
