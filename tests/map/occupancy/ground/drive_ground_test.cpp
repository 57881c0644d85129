#include "roadbed/map/occupancy/ground/drive_ground.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/planning/audit/check/certificate_check.h"
#include "roadbed/planning/audit/vehicle_audit.h"

namespace roadbed::planning {
namespace {

using geometry::Trajectory;
using map::OccupancyMap;
using testing::IsEmpty;
using testing::Not;

constexpr map::BodyReach kReach{.rear_m = -1.1, .front_m = 3.4};

/// Height of a hilly road at s: up 10 m over the first 200 m and down again, without a kink.
double hill_m(double s_m) { return 5.0 - 5.0 * std::cos(M_PI * s_m / 200.0); }

/// A straight road of 400 m along x with the hill's elevation, a record every 2 m, tilted by 3 %
/// across, and a bridge over it at 200 m, 6 m higher, along y.
std::string hilly_xodr() {
  std::string elevation;
  for (double s = 0.0; s < 400.0; s += 2.0) {
    const double slope = M_PI / 200.0 * 5.0 * std::sin(M_PI * s / 200.0);
    const double next = M_PI / 200.0 * 5.0 * std::sin(M_PI * (s + 2.0) / 200.0);
    const double rise = hill_m(s + 2.0) - hill_m(s);  // cubic of both ends' heights and slopes
    const double c = (3.0 * rise - 2.0 * (2.0 * slope + next)) / 4.0;
    const double d = (2.0 * (slope + next) - 2.0 * rise) / 8.0;
    elevation += "<elevation s=\"" + std::to_string(s) + "\" a=\"" + std::to_string(hill_m(s)) +
                 "\" b=\"" + std::to_string(slope) + "\" c=\"" + std::to_string(c) + "\" d=\"" +
                 std::to_string(d) + "\"/>";
  }
  const auto road = [](const std::string& id, const std::string& at, const std::string& length,
                       const std::string& profile) {
    return "<road name=\"\" length=\"" + length + "\" id=\"" + id +
           "\" junction=\"-1\"><planView>"
           "<geometry s=\"0\" " +
           at + " length=\"" + length + "\"><line/></geometry></planView>" + profile +
           "<lanes><laneSection s=\"0\"><left><lane id=\"1\" type=\"driving\"><width sOffset=\"0\" "
           "a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/></lane></left><center><lane id=\"0\" type=\"none\"/>"
           "</center><right><lane id=\"-1\" type=\"driving\"><width sOffset=\"0\" a=\"3.5\" "
           "b=\"0\" "
           "c=\"0\" d=\"0\"/></lane></right></laneSection></lanes></road>";
  };
  return "<?xml version=\"1.0\"?><OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/>" +
         road("1", "x=\"0\" y=\"0\" hdg=\"0\"", "400",
              "<elevationProfile>" + elevation +
                  "</elevationProfile><lateralProfile><superelevation s=\"0\" a=\"0.03\" b=\"0\" "
                  "c=\"0\" d=\"0\"/></lateralProfile>") +
         road("2", "x=\"200\" y=\"-50\" hdg=\"1.5707963267948966\"", "100",
              "<elevationProfile><elevation s=\"0\" a=\"16\" b=\"0\" c=\"0\" d=\"0\"/>"
              "</elevationProfile>") +
         "</OpenDRIVE>";
}

map::RoadMap hilly_map() { return map::parse_map(hilly_xodr(), "hills.xodr"); }

/// What a scanner would see: both surfaces with 1 cm of noise, and a box on the road.
OccupancyMap hilly_cloud(std::optional<Eigen::Vector2d> box_at) {
  std::mt19937 random(12);
  std::normal_distribution<double> noise(0.0, 0.01);
  map::PointCloud cloud;
  const auto add = [&](double x, double y, double z) {
    cloud.points.emplace_back(static_cast<float>(x), static_cast<float>(y),
                              static_cast<float>(z + noise(random)));
  };
  for (double x = 100.0; x < 300.0; x += 0.09) {
    for (double y = -3.5; y < 3.5; y += 0.09) add(x, y, hill_m(x) + 0.03 * y);
  }
  for (double x = 196.5; x < 203.5; x += 0.09) {
    for (double y = -10.0; y < 10.0; y += 0.09) add(x, y, 16.0);
  }
  for (double up = 0.0; box_at && up < 0.4; up += 0.05) {
    for (double off = -0.2; off < 0.2; off += 0.05) {
      const double x = box_at->x() + off, y = box_at->y();
      add(x, y, hill_m(x) + 0.03 * y + up);
    }
  }
  // Posts beside the road: what lies above it was looked at.
  for (double x = 100.0; x < 300.0; x += 5.0) add(x, 4.5, hill_m(x) + 0.03 * 4.5 + 0.8);
  return OccupancyMap::build(std::vector{cloud}, {.resolution_m = 0.1});
}

Trajectory along_the_road(double from_m, double to_m, double y_m) {
  return Trajectory({{.t_s = 0, .x_m = from_m, .y_m = y_m}, {.t_s = 10, .x_m = to_m, .y_m = y_m}});
}

TEST(DriveGround, OfAMapIsTheRoadsSurface) {
  const map::RoadMap road_map = hilly_map();
  const map::Ground ground = map::road_under(road_map, along_the_road(20.0, 380.0, -1.75));
  for (double x = 22.0; x < 378.0; x += 0.37) {
    for (const double y : {-3.0, -1.75, 0.0, 2.0}) {
      EXPECT_NEAR(ground.height_m({x, y}), hill_m(x) + 0.03 * y, 0.012) << x << ", " << y;
    }
  }
}

TEST(DriveGround, MeasuredIsTheRoadsSurfaceToHalfACellWithABoxOnItOrABridgeAboveIt) {
  const OccupancyMap cloud = hilly_cloud(Eigen::Vector2d(150.0, -1.75));
  const map::Ground ground =
      map::measured_under(cloud, along_the_road(110.0, 290.0, -1.75), kReach);
  for (double x = 110.0; x < 293.0; x += 0.37) {
    EXPECT_NEAR(ground.height_m({x, -1.75}), hill_m(x) - 0.03 * 1.75, 0.06) << x;
  }
}

TEST(DriveGround, OnTheBridgeIsThatOfTheBridge) {
  const map::RoadMap road_map = hilly_map();
  const Trajectory over({{.t_s = 0, .x_m = 201.75, .y_m = -40, .heading_rad = M_PI_2},
                         {.t_s = 10, .x_m = 201.75, .y_m = 40, .heading_rad = M_PI_2}});
  EXPECT_NEAR(map::road_under(road_map, over).height_m({201.0, 0.0}), 16.0, 1e-6);
}

struct HillAudit {
  Verdict verdict;
  std::vector<Conflict> conflicts;
  std::vector<std::string> faults;
};

HillAudit hill_audit(const OccupancyMap& occupancy, const map::Ground& ground,
                     const Trajectory& drive, const std::vector<geometry::BodyPart>& parts) {
  const AuditOptions options{.clearance_m = 0.1, .unknown = UnknownPolicy::free};
  const GroundUnder under{.surface = std::make_shared<const map::Ground>(ground.places())};
  const VehicleSurroundings around(occupancy, under, parts, audited_region(drive, parts, options));
  const VehicleAudit audit = audit_vehicle(around, drive, options);
  HillAudit result{audit.whole.verdict, audit.whole.conflicts, {}};
  for (const auto& certificate : certify_vehicle(around, drive, options, audit)) {
    for (const std::string& fault : check_certificate(certificate, occupancy.cells(), 0.1, drive)) {
      result.faults.push_back(fault);
    }
  }
  return result;
}

TEST(DriveGround, ABoxOnTheHillIsFoundAndNeitherTheRoadNorTheBridgeIsAConflict) {
  const map::RoadMap road_map = hilly_map();
  const std::vector<geometry::BodyPart> car{geometry::body_of({}, 0.25)};
  const Trajectory drive = along_the_road(110.0, 285.0, -1.75);
  const OccupancyMap free_road = hilly_cloud(std::nullopt);
  for (const map::Ground& ground :
       {map::road_under(road_map, drive), map::measured_under(free_road, drive, kReach)}) {
    const HillAudit free = hill_audit(free_road, ground, drive, car);
    EXPECT_EQ(free.verdict, Verdict::clear);
    EXPECT_THAT(free.faults, IsEmpty());
  }
  for (const double box_m : {150.0, 200.0, 250.0}) {
    const OccupancyMap blocked = hilly_cloud(Eigen::Vector2d(box_m, -1.6));
    for (const map::Ground& ground :
         {map::road_under(road_map, drive), map::measured_under(blocked, drive, kReach)}) {
      const HillAudit hit = hill_audit(blocked, ground, drive, car);
      ASSERT_EQ(hit.verdict, Verdict::conflict);
      EXPECT_NEAR(hit.conflicts.front().witness.min_in_source.x(), box_m, 0.3);
      EXPECT_THAT(hit.faults, IsEmpty());
    }
  }
  // What the ground is for: on one level, half-way up, the road itself is in the way.
  const AuditOptions options{.unknown = UnknownPolicy::free};
  const VehicleSurroundings flat(free_road, GroundUnder{.level_m = hill_m(150.0)}, car,
                                 audited_region(drive, car, options));
  EXPECT_EQ(audit_vehicle(flat, drive, options).whole.verdict, Verdict::conflict);
}

TEST(DriveGround, ACertificateOverAGroundFallsWithTheGround) {
  const map::RoadMap road_map = hilly_map();
  const std::vector<geometry::BodyPart> car{geometry::body_of({}, 0.25)};
  const Trajectory drive = along_the_road(110.0, 190.0, -1.75);
  const OccupancyMap cloud = hilly_cloud(std::nullopt);
  const AuditOptions options{.unknown = UnknownPolicy::free};
  const auto ground = std::make_shared<const map::Ground>(map::road_under(road_map, drive));
  const VehicleSurroundings around(cloud, GroundUnder{.surface = ground}, car,
                                   audited_region(drive, car, options));
  const VehicleAudit audit = audit_vehicle(around, drive, options);
  AuditCertificate certificate = certify_vehicle(around, drive, options, audit).front();
  EXPECT_THAT(check_certificate(certificate, cloud.cells(), 0.1, drive), IsEmpty());
  std::vector<map::GroundPlace> lower = ground->places();
  for (map::GroundPlace& place : lower) place.z_m -= 0.5;
  const map::Ground sunk(lower);
  certificate.band.ground = &sunk;
  EXPECT_THAT(check_certificate(certificate, cloud.cells(), 0.1, drive), Not(IsEmpty()));
}

TEST(DriveGround, ACheckRefusesACellThatWouldBeBillionsOfColumns) {
  const std::vector<map::OccupancyCell> cells{{{0.0, 0.0, 0.0}, 6553.6, map::CellState::occupied}};
  const map::Ground ground({{{0.0, 0.0}, 0.0, {0.01, 0.0}}});
  AuditCertificate certificate;
  certificate.band = {0.2, 1.5, &ground};
  EXPECT_THROW(check_certificate(certificate, cells, 0.1, along_the_road(0.0, 1.0, 0.0)),
               std::length_error);
}

TEST(DriveGround, AClaimedGroundMustBeUnderTheDrive) {
  const Trajectory drive = along_the_road(0.0, 10.0, 0.0);
  const auto faults = [&](const std::vector<double>& x_m, double z_m, double slope) {
    std::vector<map::GroundPlace> places;
    for (const double x : x_m) places.push_back({{x, 0.0}, 0.0, {0.0, 0.0}});
    places.back().z_m = z_m;
    places.back().slope.x() = slope;
    return map::ground_faults(map::Ground(places), drive, 4.0);
  };
  EXPECT_THAT(faults({0.0, 2.0, 4.0, 6.0, 8.0, 10.0}, 0.1, 0.1), IsEmpty());
  EXPECT_THAT(faults({0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 15.9}, 0.1, 0.1), IsEmpty());
  using testing::ElementsAre;
  using testing::HasSubstr;
  EXPECT_THAT(faults({0.0, 2.0, 4.0, 10.0}, 0.0, 0.0), ElementsAre(HasSubstr("within 2 m")));
  EXPECT_THAT(faults({0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 16.1}, 0.0, 0.0),
              ElementsAre(HasSubstr("away from the drive")));
  EXPECT_THAT(faults({0.0, 2.0, 4.0, 6.0, 8.0, 10.0}, 0.5, 0.51),
              ElementsAre(HasSubstr("slope is 0.51")));
  EXPECT_THAT(faults({0.0, 2.0, 4.0, 6.0, 8.0, 10.0}, 0.6, 0.0),
              ElementsAre(HasSubstr("steps by 0.60 m")));
}

TEST(DriveGround, SaysWhereItCannotBeTold) {
  const map::RoadMap road_map = hilly_map();
  EXPECT_THROW(map::road_under(road_map, along_the_road(-100.0, 50.0, 0.0)), map::InputError);
  const OccupancyMap cloud = hilly_cloud(std::nullopt);
  EXPECT_THROW(map::measured_under(cloud, along_the_road(110.0, 390.0, 0.0), kReach),
               map::InputError);
  // Under the bridge, onto it, and back across the road below.
  const Trajectory across({{.t_s = 0, .x_m = 200, .y_m = -45, .heading_rad = M_PI_2},
                           {.t_s = 1, .x_m = 200, .y_m = 45, .heading_rad = M_PI_2},
                           {.t_s = 2, .x_m = 390, .y_m = 0, .heading_rad = M_PI},
                           {.t_s = 3, .x_m = 10, .y_m = 0, .heading_rad = M_PI}});
  EXPECT_THROW(map::road_under(road_map, across), map::InputError);
}

}  // namespace
}  // namespace roadbed::planning
