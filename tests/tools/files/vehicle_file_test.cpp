#include "roadbed/tools/files/vehicle_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::tools {
namespace {

using geometry::VehicleShape;
using testing::HasSubstr;

const std::string kVan =
    "# a van\n"
    "/**:\n"
    "  ros__parameters:\n"
    "    wheel_radius: 0.35 # of the tyre [m]\n"
    "    wheel_base: 3.1\n"
    "    wheel_tread: 1.7\n"
    "    front_overhang: 0.9\n"
    "    rear_overhang: 1.2\n"
    "    left_overhang: 0.15\n"
    "    right_overhang: 0.15\n"
    "    vehicle_height: 2.4\n"
    "    max_steer_angle: 0.62  # [rad]\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string yaml_refusal(const std::string& text) {
  return tests::refusal_of([&] { parse_vehicle(text, "car.yaml"); });
}

// Bodies of boxes: Autoware's corners are at front_overhang before the front axle, rear_overhang
// behind the rear one, and left_overhang beside the left wheel.
TEST(AutowareVehicle, HasItsCornersWhereAutowareHasThem) {
  const VehicleShape shape = parse_vehicle(kVan, "van.yaml").shape;
  const auto corners = shape.corners_in_vehicle();  // rear right, front right, front left, …
  EXPECT_NEAR(corners[0].x(), -1.2, 1e-12);
  EXPECT_NEAR(corners[0].y(), -(1.7 / 2 + 0.15), 1e-12);
  EXPECT_NEAR(corners[2].x(), 3.1 + 0.9, 1e-12);
  EXPECT_NEAR(corners[2].y(), 1.7 / 2 + 0.15, 1e-12);
  EXPECT_EQ(shape.wheelbase_m, 3.1);
  EXPECT_EQ(shape.height_m, 2.4);
  EXPECT_EQ(shape.max_steering_rad, 0.62);
  EXPECT_EQ(shape.max_steering_rate_radps, VehicleShape{}.max_steering_rate_radps);
}

TEST(AutowareVehicle, IsTakenHoweverYamlMayWriteIt) {
  const std::string measures = measures_text(parse_vehicle(kVan, "van.yaml").shape);
  for (const std::string& same : {
           "---\n" + kVan,
           replaced(kVan, "/**:", "\"/**\":"),
           replaced(kVan, "/**:", "'/**' :   # all nodes"),
           replaced(kVan, "wheel_base: 3.1", "wheel_base:   31e-1\r"),
           replaced(kVan, "    wheel_radius: 0.35 # of the tyre [m]\n",
                    "    cargo:\n      wheel_base: 9\n    name: \"a: b\"\n\n"),
       }) {
    EXPECT_EQ(measures_text(parse_vehicle(same, "van.yaml").shape), measures) << same;
  }
}

TEST(AutowareVehicle, RefusesWithItsLineWhatItCannotUse) {
  const auto with = [](const std::string& from, const std::string& to) {
    return yaml_refusal(replaced(kVan, from, to));
  };
  EXPECT_EQ(with("wheel_base: 3.1", "wheel_base: far"),
            "car.yaml:5: wheel_base: is \"far\", needs a number from 0 to 1000; mend it");
  EXPECT_THAT(with("wheel_base: 3.1", "wheel_base: -1"), HasSubstr("car.yaml:5: wheel_base"));
  EXPECT_THAT(with("wheel_base: 3.1", "wheel_base: nan"), HasSubstr("car.yaml:5: wheel_base"));
  EXPECT_THAT(with("wheel_base: 3.1", "wheel_base:"), HasSubstr("car.yaml:5: wheel_base: is \"\""));
  EXPECT_THAT(with("    wheel_base: 3.1\n", ""), HasSubstr("wheel_base: is missing"));
  EXPECT_THAT(with("wheel_tread: 1.7", "wheel_base: 3"), HasSubstr("car.yaml:6: wheel_base: stands "
                                                                   "twice"));
  EXPECT_EQ(with("right_overhang: 0.15", "right_overhang: 0.2"),
            "car.yaml:10: right_overhang: is 0.2, left_overhang 0.15, needs equal ones; give the "
            "larger one for both");
  EXPECT_THAT(with("wheel_base: 3.1", "wheel_base 3.1"), HasSubstr("is no \"key: value\""));
  EXPECT_THAT(with("    wheel_base", "\twheel_base"), HasSubstr("is indented by a tab"));
  EXPECT_THAT(with("    wheel_base", "   wheel_base"), HasSubstr("is indented otherwise"));
  EXPECT_THAT(with("    wheel_base", "wheel_base"), HasSubstr("stands beside ros__parameters"));
  EXPECT_THAT(with("ros__parameters:", "parameters:"), HasSubstr("needs ros__parameters"));
  EXPECT_THAT(with("vehicle_height: 2.4", "vehicle_height: 0"), HasSubstr("height_m"));
  EXPECT_THAT(yaml_refusal("# nothing\n"), HasSubstr("has no /**"));
  EXPECT_THAT(yaml_refusal("/**: &a\n"), HasSubstr("car.yaml:1"));
}

// Of CommonRoad's package: the centre of mass, which its states are of, is the body's centre.
TEST(CommonRoadVehicle, TwoIsTheDefault) {
  EXPECT_EQ(measures_text(named_vehicle("commonroad:2")->shape), measures_text({}));
  EXPECT_FALSE(named_vehicle("car.json"));
  for (const char* no : {"commonroad:", "commonroad:0", "commonroad:5", "commonroad:11"}) {
    EXPECT_THROW(named_vehicle(no), map::InputError) << no;
  }
}

// The numbers are those of commonroad-vehicle-models 3.0.2: l, w, l/2 - b, a + b, steering limits.
TEST(CommonRoadVehicle, HasTheMeasuresOfThePackage) {
  const auto expect = [](const char* name, double length_m, double width_m, double overhang_m,
                         double wheelbase_m, double steering_rad, double rate_radps) {
    const VehicleShape shape = named_vehicle(name)->shape;
    EXPECT_NEAR(shape.length_m, length_m, 1e-9) << name;
    EXPECT_NEAR(shape.width_m, width_m, 1e-9) << name;
    EXPECT_NEAR(shape.rear_overhang_m, overhang_m, 1e-7) << name;
    EXPECT_NEAR(shape.wheelbase_m, wheelbase_m, 1e-9) << name;
    EXPECT_NEAR(shape.max_steering_rad, steering_rad, 1e-9) << name;
    EXPECT_NEAR(shape.max_steering_rate_radps, rate_radps, 1e-9) << name;
  };
  expect("commonroad:1", 4.298, 1.674, 0.64024, 2.39268, 0.91, 0.4);
  expect("commonroad:2", 4.508, 1.61, 0.8312829064, 2.5789128, 1.066, 0.4);
  expect("commonroad:3", 4.569, 1.844, 0.9633636024, 2.471928, 1.023, 0.4);
  expect("commonroad:4", 5.1, 2.55, 0.75, 3.6, 0.55, 0.7103);
}

TEST(CommonRoadVehicle, HasItsAxlesInsideTheBody) {
  for (const char* name : {"commonroad:1", "commonroad:2", "commonroad:3", "commonroad:4"}) {
    const VehicleShape shape = read_vehicle_shape(name);
    EXPECT_NO_THROW(shape.check()) << name;
    EXPECT_GE(shape.height_m, 1.5) << name;
  }
}

TEST(VehicleFile, IsToldByContent) {
  const tests::TemporaryFolder folder;
  EXPECT_EQ(read_vehicle(folder.write("a", kVan)).shape.wheelbase_m, 3.1);
  EXPECT_EQ(read_vehicle(folder.write("b", "\n {\"wheelbase_m\": 3}")).shape.wheelbase_m, 3.0);
  EXPECT_THAT(yaml_refusal("wheel_base: 3"), HasSubstr("is not JSON"));
}

std::string scenario_with(const std::string& vehicle) {
  const std::string text = tests::bytes_of(tests::data_folder() / "scenarios" / "parked_car.json");
  return replaced(replaced(text, "../town.xodr", tests::data_folder() / "town.xodr"), "\"goal\"",
                  "\"vehicle\": \"" + vehicle + "\", \"goal\"");
}

TEST(VehicleFile, OfAScenarioIsThatOfTheOptionAndIsReplayed) {
  const tests::TemporaryFolder folder;
  folder.write("van.yaml", replaced(kVan, "rear_overhang: 1.2", "rear_overhang: 1.1"));
  for (const std::string vehicle : {"van.yaml", "commonroad:1"}) {
    SCOPED_TRACE(vehicle);
    const std::string scenario = folder.write("named.json", scenario_with(vehicle));
    const std::string out = folder / ("out_" + vehicle), option = folder / ("option_" + vehicle);
    EXPECT_EQ(tests::run_roadbed({"simulate", scenario, "-o", out}).status, 0);
    const std::string default_vehicle = folder.write("two.json", scenario_with("commonroad:2"));
    const std::string file = vehicle == "van.yaml" ? (folder / vehicle).string() : vehicle;
    EXPECT_EQ(
        tests::run_roadbed({"simulate", default_vehicle, "--vehicle", file, "-o", option}).status,
        0);
    EXPECT_TRUE(tests::bytes_of(out + "/trajectory.csv") ==
                tests::bytes_of(option + "/trajectory.csv"));
    for (const std::string& drive : {out, option}) {
      const auto run = tests::run_roadbed({"plan", drive + "@1", "-o", drive + "_plan"});
      EXPECT_EQ(run.status, 0) << run.err;
    }
  }
}

TEST(VehicleFile, ThatIsANameIsWhatACertificateIsAbout) {
  const tests::TemporaryFolder folder;
  const std::string proof = folder / "proof.json", walls = tests::data_folder() / "town.bt";
  const std::string drive =
      folder.write("drive.csv", "t_s,x_m,y_m,heading_rad\n0,150,198,0\n1,155,198,0\n");
  tests::run_roadbed({"audit", "--occupancy", walls, "--trajectory", drive, "--vehicle",
                      "commonroad:3", "--certificate", proof});
  EXPECT_EQ(tests::run_roadbed({"audit", "--check", proof}).status, 0);
  const auto other = tests::run_roadbed({"audit", "--check", proof, "--vehicle", "commonroad:1"});
  EXPECT_NE(other.status, 0);
  EXPECT_THAT(other.out, HasSubstr("the certificate is about one with"));
}

}  // namespace
}  // namespace roadbed::tools
