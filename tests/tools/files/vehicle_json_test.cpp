#include "roadbed/tools/files/vehicle_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "roadbed/map/files/input_error.h"
#include "roadbed/tests/support/refusal_of.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools {
namespace {

using geometry::VehicleShape;
using testing::HasSubstr;

std::string json_refusal(std::string_view text) {
  return tests::refusal_of([&] { parse_vehicle_json(text, "car.json"); });
}

TEST(VehicleJson, AnEmptyObjectIsTheDefaultVehicle) {
  const VehicleShape shape = parse_vehicle_json("{}", "car.json").shape, standard;
  EXPECT_EQ(shape.length_m, standard.length_m);
  EXPECT_EQ(shape.max_steering_rate_radps, standard.max_steering_rate_radps);
}

TEST(VehicleJson, EveryKeySetsItsOwnMeasure) {
  const VehicleShape shape =
      parse_vehicle_json(
          R"({"length_m":5,"width_m":2.5,"rear_overhang_m":1,"wheelbase_m":3,"height_m":1.75,
          "max_steering_rad":0.5,"max_steering_rate_radps":0.25})",
          "car.json")
          .shape;
  EXPECT_EQ(shape.length_m, 5.0);
  EXPECT_EQ(shape.width_m, 2.5);
  EXPECT_EQ(shape.rear_overhang_m, 1.0);
  EXPECT_EQ(shape.wheelbase_m, 3.0);
  EXPECT_EQ(shape.height_m, 1.75);
  EXPECT_EQ(shape.max_steering_rad, 0.5);
  EXPECT_EQ(shape.max_steering_rate_radps, 0.25);
}

TEST(VehicleJson, RefusesUnknownKeysWrongTypesAndMeasuresThatDoNotFit) {
  EXPECT_THAT(json_refusal(R"({"lenght_m":5})"), HasSubstr("lenght_m"));
  EXPECT_THAT(json_refusal(R"({"length_m":"5"})"), HasSubstr("length_m: is"));
  EXPECT_THAT(json_refusal(R"({"length_m":-5})"), HasSubstr("is -5"));
  EXPECT_THAT(json_refusal(R"({"length_m":1e9})"), HasSubstr("0 to 1000"));
  EXPECT_THAT(json_refusal(R"({"width_m":0})"), HasSubstr("width_m must be finite and positive"));
  EXPECT_THAT(json_refusal(R"({"length_m":2})"), HasSubstr("front axle inside the body"));
  EXPECT_THAT(json_refusal("[1,2]"), HasSubstr("array"));
  EXPECT_THAT(json_refusal("{\"length_m\":"), HasSubstr("car.json:byte "));
  EXPECT_THAT(json_refusal(""), HasSubstr("is not JSON"));
}

constexpr std::string_view kMirrors =
    R"({"width_m":1.8,"mirrors":{"beyond_m":0.2,"rear_m":1.7,"front_m":1.9,"from_height_m":0.9,)"
    R"("to_height_m":1.2}})";

TEST(VehicleJson, MirrorsStickOutOnBothSidesOfTheBody) {
  const Vehicle vehicle = parse_vehicle_json(kMirrors, "car.json");
  const auto parts = vehicle.parts(0.25);
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0].from_height_m, 0.25);
  EXPECT_EQ(parts[0].to_height_m, 1.5);
  EXPECT_EQ(parts[1].name, "left mirror");
  EXPECT_NEAR(parts[1].right_m, 0.9, 1e-12);
  EXPECT_NEAR(parts[1].left_m, 1.1, 1e-12);
  EXPECT_NEAR(parts[2].right_m, -1.1, 1e-12);
  EXPECT_NEAR(parts[2].left_m, -0.9, 1e-12);
  EXPECT_EQ(parts[2].rear_m, 1.7);
  EXPECT_EQ(parts[2].to_height_m, 1.2);
}

TEST(VehicleJson, CirclesStandInPlaceOfTheRectangleAndPartsBesideIt) {
  const Vehicle vehicle = parse_vehicle_json(
      R"({"height_m":2,"circles":[{"x_m":0,"radius_m":1.2},
          {"x_m":2,"y_m":0.1,"radius_m":1,"from_height_m":0.3,"to_height_m":1}],
          "parts":[{"name":"hook","rear_m":-1.5,"front_m":-1.1,"right_m":-0.1,"left_m":0.1,
                    "from_height_m":0.3,"to_height_m":0.5}]})",
      "car.json");
  const auto parts = vehicle.parts(0.2);
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0].radius_m, 1.2);
  EXPECT_EQ(parts[0].from_height_m, 0.2);
  EXPECT_EQ(parts[0].to_height_m, 2.0);
  EXPECT_EQ(parts[1].left_m, 0.1);
  EXPECT_EQ(parts[1].to_height_m, 1.0);
  EXPECT_EQ(parts[2].name, "hook");
  EXPECT_EQ(parts[2].rear_m, -1.5);
}

TEST(VehicleJson, RefusesPartsThatCannotBeMeant) {
  const auto part = [](const std::string& measures) {
    return json_refusal(R"({"parts":[{"name":"load",)" + measures + "}]}");
  };
  EXPECT_THAT(part(R"("rear_m":0,"front_m":1,"right_m":-1,"left_m":1,"from_height_m":2,
                      "to_height_m":2)"),
              HasSubstr("/parts/0: load: it must begin lower than it ends"));
  EXPECT_THAT(part(R"("rear_m":1,"front_m":0,"right_m":-1,"left_m":1,"from_height_m":1,
                      "to_height_m":2)"),
              HasSubstr("the rear must lie behind the front"));
  EXPECT_THAT(part(R"("rear_m":0,"front_m":1,"right_m":1,"left_m":-1,"from_height_m":1,
                      "to_height_m":2)"),
              HasSubstr("to the right of the left"));
  EXPECT_THAT(part(R"("rear_m":9,"front_m":10,"right_m":-1,"left_m":1,"from_height_m":1,
                      "to_height_m":2)"),
              HasSubstr("part \"load\" is apart from the rest"));
  EXPECT_THAT(part(R"("rear_m":0,"front_m":1)"), HasSubstr("right_m"));
  EXPECT_THAT(part(R"("rear_m":null,"front_m":1,"right_m":-1,"left_m":1,"from_height_m":1,
                      "to_height_m":2)"),
              HasSubstr("/parts/0/rear_m"));
  EXPECT_THAT(json_refusal(R"({"mirrors":{"beyond_m":-0.2,"rear_m":1,"front_m":2,"from_height_m":1,
                          "to_height_m":2}})"),
              HasSubstr("/mirrors/beyond_m: is -0.2"));
  EXPECT_THAT(json_refusal(R"({"mirrors":{"beyond_m":0,"rear_m":1,"front_m":2,"from_height_m":1,
                          "to_height_m":2}})"),
              HasSubstr("left mirror"));
  EXPECT_THAT(json_refusal(R"({"circles":[{"x_m":0,"radius_m":0}]})"),
              HasSubstr("/radius_m: is 0"));
  EXPECT_THAT(json_refusal(R"({"circles":{"x_m":0,"radius_m":1}})"), HasSubstr("/circles: is"));
  EXPECT_THAT(
      json_refusal(R"({"parts":[{"name":"body","rear_m":0,"front_m":1,"right_m":-1,"left_m":1,
                          "from_height_m":1,"to_height_m":2}]})"),
      HasSubstr("two parts of one name"));
}

TEST(VehicleJson, RefusesNamesThatCouldForgeLinesAndHeightsThatAreNone) {
  const auto named = [](const std::string& name, const std::string& top) {
    return json_refusal(R"({"parts":[{"name":")" + name +
                        R"(","rear_m":0,"front_m":1,"right_m":-1,"left_m":1,"from_height_m":1,)" +
                        R"("to_height_m":)" + top + "}]}");
  };
  EXPECT_EQ(named("load", "2"), "accepted");
  EXPECT_THAT(named(R"(load\ncertificate      holds)", "2"),
              HasSubstr("/parts/0/name: has a control character"));
  EXPECT_THAT(named(R"(load\u001b[2J)", "2"), HasSubstr("has a control character"));
  EXPECT_THAT(named("", "2"), HasSubstr("/parts/0/name: is empty"));
  EXPECT_THAT(named(std::string(61, 'x'), "2"), HasSubstr("has 61 bytes, needs at most 60"));
  EXPECT_EQ(named(std::string(60, 'x'), "1.001"), "accepted");
  EXPECT_THAT(named("load", "1.000001"), HasSubstr("is 1e-06 m high, needs at least 0.001 m"));
}

TEST(VehicleJson, WhatDrivesTakesNoPartsThatItWouldNotLookAt) {
  const auto shape_of = [](std::string_view text) {
    const nlohmann::json document = nlohmann::json::parse(text);
    return vehicle_shape_in(JsonNode(document, "car.json"));
  };
  EXPECT_THROW(shape_of(kMirrors), map::InputError);
  EXPECT_EQ(shape_of("{\"width_m\":2}").width_m, 2.0);
}

TEST(VehicleJson, ABodyThatBeginsOverItsTopIsRefused) {
  EXPECT_THROW(parse_vehicle_json("{\"height_m\":1}", "car.json").parts(1.0), map::InputError);
  EXPECT_THROW(parse_vehicle_json("{\"height_m\":1}", "car.json").parts(0.9999995),
               map::InputError);
}

}  // namespace
}  // namespace roadbed::tools
