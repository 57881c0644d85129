#include "roadbed/tools/files/obstacles_csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "roadbed/map/files/input_error.h"

namespace roadbed::tools {
namespace {

using testing::HasSubstr;

TEST(ObstaclesCsv, GathersTheRowsOfEachIdInAnyOrderOfColumns) {
  const auto obstacles = parse_obstacles_csv(
      "id,t_s,width_m,length_m,heading_rad,y_m,x_m,colour\r\n"
      "bus,1,2.5,12,0.5,2,1,red\r\n"
      "post,0,0.2,0.2,0,9,8,\r\n"
      "\r\n"
      "bus,3,2.6,11,0.7,4,3,red\r\n",
      "boxes.csv");
  ASSERT_EQ(obstacles.size(), 2u);
  EXPECT_EQ(obstacles[0].id, "bus");
  EXPECT_EQ(obstacles[0].validity.from_s, 1.0);
  EXPECT_EQ(obstacles[0].validity.to_s, 3.0);
  EXPECT_EQ(obstacles[0].length_m, 12.0);  // the largest of each
  EXPECT_EQ(obstacles[0].width_m, 2.6);
  const auto middle = obstacles[0].motion.at(2.0);
  EXPECT_NEAR(middle.x_m, 2.0, 1e-12);
  EXPECT_NEAR(middle.y_m, 3.0, 1e-12);
  EXPECT_NEAR(middle.heading_rad, 0.6, 1e-12);
  EXPECT_EQ(obstacles[1].id, "post");
  EXPECT_TRUE(std::isinf(obstacles[1].validity.from_s) && std::isinf(obstacles[1].validity.to_s));
}

TEST(ObstaclesCsv, TurnsTheShorterWayRound) {
  const auto obstacles = parse_obstacles_csv(
      "t_s,id,x_m,y_m,heading_rad,length_m,width_m\n0,a,0,0,3.1,4,2\n1,a,0,0,-3.1,4,2\n", "b.csv");
  EXPECT_NEAR(obstacles[0].motion.at(0.5).heading_rad, M_PI, 1e-9);
}

TEST(ObstaclesCsv, AreReadAsTheyWereWritten) {
  const std::string text =
      "t_s,id,x_m,y_m,heading_rad,length_m,width_m\n"
      "1,\"bus, red\",443210.25,2,0.5,12,2.5\n"
      "3.000000001,\"bus, red\",443211,4,0.7,12,2.5\n"
      "0,post,9,8,0,0.2,0.2\n";
  const auto obstacles = parse_obstacles_csv(text, "a.csv");
  EXPECT_EQ(write_obstacles_csv(obstacles), text);
  EXPECT_EQ(obstacles_text(parse_obstacles_csv(write_obstacles_csv(obstacles), "b.csv")),
            obstacles_text(obstacles));
}

TEST(ObstaclesCsv, RefusesARowWithItsPlaceAndReason) {
  const auto expect_refused = [](const std::string& rows, const char* reason) {
    try {
      parse_obstacles_csv("t_s,id,x_m,y_m,heading_rad,length_m,width_m\n" + rows, "boxes.csv");
      FAIL() << "accepted: " << rows;
    } catch (const map::InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(reason));
    }
  };
  expect_refused("", "boxes.csv:1: row: there is none");
  expect_refused("0,a,0,0,0,4,2\n0,a,1,0,0,4,2\n", "boxes.csv:3: column t_s");
  expect_refused("0,a,0,0,0,4,2\n1e-7,a,1,0,0,4,2\n", "boxes.csv:3: column t_s");
  expect_refused("0,a,0,0,0,4,2\n9,a,3e5,0,0,4,2\n", "obstacle a: moves 300000 m");
  expect_refused("0,a,0,0,0,-4,2\n", "boxes.csv:2: column length_m");
  expect_refused("0,a,nan,0,0,4,2\n", "column x_m");
  expect_refused("0,,0,0,0,4,2\n", "column id");
  expect_refused("0,a,0,0\n", "row: has 4 fields");
  EXPECT_THROW(parse_obstacles_csv("t_s,id,x_m\n0,a,1\n", "b.csv"), map::InputError);
  EXPECT_THROW(parse_obstacles_csv("", "b.csv"), map::InputError);
}

// What a spreadsheet must not take for a formula, or a terminal for a command, is written as a text
// that may be another's id: rows of two obstacles would be those of one that moves away.
TEST(ObstaclesCsv, AreNotWrittenWhereTwoIdsWouldBeOne) {
  const std::string header = "t_s,id,x_m,y_m,heading_rad,length_m,width_m\n";
  const auto written = [&](const std::string& id, const std::string& other) {
    return write_obstacles_csv(parse_obstacles_csv(
        header + "0," + id + ",0,0,0,4,2\n1," + other + ",9,0,0,4,2\n", "b.csv"));
  };
  EXPECT_THROW(written("=x", "'=x"), map::InputError);
  EXPECT_THROW(written("\u202e", "\\u202e"), map::InputError);
  EXPECT_EQ(written("=x", "y"), header + "0,'=x,0,0,0,4,2\n1,y,9,0,0,4,2\n");
}

TEST(ObstaclesCsv, TheTextTellsAllObstaclesApart) {
  const std::string header = "t_s,id,x_m,y_m,heading_rad,length_m,width_m\n";
  const auto text = [&](const std::string& row) {
    return obstacles_text(parse_obstacles_csv(header + row, "b.csv"));
  };
  const std::string one = text("0,a,1,2,3,4,2\n");
  EXPECT_EQ(one, text("0, a,1,2,3,4,2.0\n"));
  for (const char* other :
       {"0,b,1,2,3,4,2\n", "1,a,1,2,3,4,2\n", "0,a,2,2,3,4,2\n", "0,a,1,3,3,4,2\n",
        "0,a,1,2,2,4,2\n", "0,a,1,2,3,5,2\n", "0,a,1,2,3,4,3\n"}) {
    EXPECT_NE(one, text(other));
  }
}

}  // namespace
}  // namespace roadbed::tools
