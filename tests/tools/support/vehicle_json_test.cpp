#include "roadbed/tools/support/vehicle_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roadbed/map/input_error.h"

namespace roadbed::tools {
namespace {

using geometry::VehicleShape;
using testing::HasSubstr;

std::string refusal(std::string_view text) {
  try {
    parse_vehicle_json(text, "car.json");
  } catch (const map::InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(VehicleJson, AnEmptyObjectIsTheDefaultVehicle) {
  const VehicleShape shape = parse_vehicle_json("{}", "car.json"), standard;
  EXPECT_EQ(shape.length_m, standard.length_m);
  EXPECT_EQ(shape.max_steering_rate_radps, standard.max_steering_rate_radps);
}

TEST(VehicleJson, EveryKeySetsItsOwnMeasure) {
  const VehicleShape shape = parse_vehicle_json(
      R"({"length_m":5,"width_m":2.5,"rear_overhang_m":1,"wheelbase_m":3,"height_m":1.75,
          "max_steering_rad":0.5,"max_steering_rate_radps":0.25})",
      "car.json");
  EXPECT_EQ(shape.length_m, 5.0);
  EXPECT_EQ(shape.width_m, 2.5);
  EXPECT_EQ(shape.rear_overhang_m, 1.0);
  EXPECT_EQ(shape.wheelbase_m, 3.0);
  EXPECT_EQ(shape.height_m, 1.75);
  EXPECT_EQ(shape.max_steering_rad, 0.5);
  EXPECT_EQ(shape.max_steering_rate_radps, 0.25);
}

TEST(VehicleJson, RefusesUnknownKeysWrongTypesAndMeasuresThatDoNotFit) {
  EXPECT_THAT(refusal(R"({"lenght_m":5})"), HasSubstr("key \"lenght_m\": is not known"));
  EXPECT_THAT(refusal(R"({"length_m":"5"})"), HasSubstr("is string"));
  EXPECT_THAT(refusal(R"({"length_m":-5})"), HasSubstr("is -5"));
  EXPECT_THAT(refusal(R"({"length_m":1e9})"), HasSubstr("0 to 1000"));
  EXPECT_THAT(refusal(R"({"width_m":0})"), HasSubstr("width_m must be finite and positive"));
  EXPECT_THAT(refusal(R"({"length_m":2})"), HasSubstr("front axle inside the body"));
  EXPECT_THAT(refusal("[1,2]"), HasSubstr("is array"));
  EXPECT_THAT(refusal("{\"length_m\":"), HasSubstr("car.json:byte "));
  EXPECT_THAT(refusal(""), HasSubstr("is not JSON"));
}

}  // namespace
}  // namespace roadbed::tools
