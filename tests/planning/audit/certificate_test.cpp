#include "roadbed/planning/audit/certificate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/planning/audit/check/certificate_check.h"
#include "roadbed/planning/audit/clearance_audit.h"
#include "roadbed/tests/support/random_drive.h"

namespace roadbed::planning {
namespace {

using geometry::Trajectory;
using geometry::VehicleShape;
using map::ClearanceField;
using map::OccupancyMap;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr map::HeightBand kLowBand{0.2, 1.5};

constexpr double kSide_m = 0.2;

/// Poles at random places, in 20 m by 20 m that rays along y have measured over the whole band.
OccupancyMap measured_world(std::mt19937& random, int poles) {
  std::uniform_real_distribution<double> place(-9.0, 9.0);
  std::vector<map::PointCloud> clouds;
  map::PointCloud hits;
  for (int i = 0; i < poles; ++i) {
    hits.points.emplace_back(static_cast<float>(place(random)), static_cast<float>(place(random)),
                             0.9f);
  }
  if (poles > 0) clouds.push_back(hits);
  for (double x_m = -9.9; x_m < 10.0; x_m += kSide_m) {
    for (double z_m = 0.1; z_m < 1.7; z_m += kSide_m) {
      map::PointCloud ray;
      ray.points.emplace_back(static_cast<float>(x_m), 10.1f, static_cast<float>(z_m));
      ray.sensor_in_source = Eigen::Vector3d(x_m, -10.1, z_m);
      clouds.push_back(ray);
    }
  }
  return OccupancyMap::build(clouds, {.resolution_m = kSide_m});
}

Trajectory any_drive(std::mt19937& random) {
  const auto first = tests::random_start(random, {0.0, 0.0}, 9.0, 3.6);
  return tests::random_drive(random, first,
                             {.rows = random() % 4, .step_s = 0.7, .way_m = 3.0, .turn_rad = 1.2});
}

struct Audited {
  OccupancyMap occupancy;
  Trajectory drive;
  AuditReport report;
  AuditCertificate certificate;

  std::vector<std::string> faults(const AuditCertificate& of) const {
    return check_certificate(of, occupancy.cells(), occupancy.resolution_m(), drive);
  }
};

Audited audited(std::mt19937& random, int poles, const AuditOptions& options) {
  OccupancyMap occupancy = measured_world(random, poles);
  const ClearanceField field(occupancy, kLowBand);
  Trajectory drive = any_drive(random);
  AuditReport report = audit_clearance(field, drive, VehicleShape{}, options);
  AuditCertificate certificate = certify(field, kLowBand, drive, VehicleShape{}, options, report);
  return {std::move(occupancy), std::move(drive), std::move(report), std::move(certificate)};
}

AuditOptions any_options(std::mt19937& random) {
  std::uniform_real_distribution<double> margin(0.0, 0.5);
  constexpr std::array policies{UnknownPolicy::free, UnknownPolicy::occupied,
                                UnknownPolicy::report};
  return {.clearance_m = random() % 2 == 0 ? 0.0 : margin(random),
          .inflate_m = random() % 2 == 0 ? 0.0 : margin(random),
          .unknown = policies[random() % 3]};
}

TEST(AuditCertificate, HoldsForEveryAuditAndSaysTheSameVerdict) {
  std::mt19937 random(7);
  std::array<int, 4> verdicts{};  // clear, conflict, unknown, undecided
  for (int round = 0; round < 120; ++round) {
    const Audited made = audited(random, static_cast<int>(random() % 4), any_options(random));
    EXPECT_THAT(made.faults(made.certificate), IsEmpty()) << "round " << round;
    EXPECT_EQ(made.certificate.verdict, made.report.verdict) << "round " << round;
    if (made.report.verdict == Verdict::clear && !made.report.beyond_horizon) {
      EXPECT_LE(made.certificate.certified_clearance_m, made.report.least_clearance_m + 1e-9);
      EXPECT_GE(made.certificate.certified_clearance_m,
                std::min(4.99, made.report.least_clearance_m - 0.05));
    }
    ++verdicts[static_cast<std::size_t>(made.report.verdict)];
  }
  EXPECT_GT(verdicts[0], 10);
  EXPECT_GT(verdicts[1], 10);
  EXPECT_GT(verdicts[2], 5);
}

// A search that bounds what the body sweeps over could tell; spans by motion would be millions.
TEST(AuditCertificate, OfAClearanceMetToAHairIsShortAndSaysTheSameVerdict) {
  map::PointCloud pole;
  pole.points.emplace_back(20.0f, 2.1f, 0.9f);
  const OccupancyMap occupancy = OccupancyMap::build(std::vector{pole}, {.resolution_m = kSide_m});
  const ClearanceField field(occupancy, kLowBand);
  const Trajectory drive({{.t_s = 0.0, .x_m = 12.0}, {.t_s = 1.0, .x_m = 28.0}});
  const double free_m = 2.0 - 0.5 * VehicleShape{}.width_m;
  for (const double short_of_m : {1e-7, 1e-6, 1e-5, 1e-4, 1e-3}) {
    const AuditOptions options{.clearance_m = free_m - short_of_m, .unknown = UnknownPolicy::free};
    const AuditReport report = audit_clearance(field, drive, VehicleShape{}, options);
    const auto certificate = certify(field, kLowBand, drive, VehicleShape{}, options, report);
    EXPECT_EQ(report.verdict, short_of_m < 1e-3 ? Verdict::undecided : Verdict::clear);
    EXPECT_EQ(certificate.verdict, report.verdict) << short_of_m;
    EXPECT_LT(certificate.from_occupied.size(), 20'000u) << short_of_m;
    EXPECT_THAT(check_certificate(certificate, occupancy.cells(), kSide_m, drive), IsEmpty());
  }
}

TEST(AuditCertificate, IsRefutedIfAnySpanIsMissing) {
  std::mt19937 random(11);
  int refuted = 0;
  while (refuted < 10) {
    const Audited made = audited(random, 3, {.unknown = UnknownPolicy::free});
    AuditCertificate cut = made.certificate;
    if (cut.from_occupied.empty()) continue;
    cut.from_occupied.erase(cut.from_occupied.begin() +
                            static_cast<std::ptrdiff_t>(random() % cut.from_occupied.size()));
    if (made.drive.points().size() == 1) continue;
    EXPECT_THAT(made.faults(cut), Contains(HasSubstr("nothing is said of")));
    ++refuted;
  }
}

TEST(AuditCertificate, IsRefutedIfASpanPromisesMoreThanThereIs) {
  std::mt19937 random(13);
  int refuted = 0;
  while (refuted < 10) {
    const Audited made = audited(random, 3, {.unknown = UnknownPolicy::free});
    if (made.report.beyond_horizon || made.certificate.from_occupied.empty()) continue;
    AuditCertificate bold = made.certificate;
    for (ProvenSpan& span : bold.from_occupied) span.at_least_m = made.report.least_clearance_m;
    if (made.report.verdict != Verdict::clear || made.drive.points().size() == 1) continue;
    for (ProvenSpan& span : bold.from_occupied) span.at_least_m += 0.01;
    EXPECT_THAT(made.faults(bold), Contains(HasSubstr("that is no")));
    ++refuted;
  }
}

TEST(AuditCertificate, IsRefutedByAnObstacleThatTheAuditDidNotSee) {
  std::mt19937 random(17);
  int refuted = 0;
  while (refuted < 10) {
    const Audited made = audited(random, 3, {.unknown = UnknownPolicy::free});
    if (made.report.verdict != Verdict::clear) continue;
    std::uniform_real_distribution<double> fraction(0.0, 1.0);
    const double span_s = made.drive.end_s() - made.drive.start_s();
    const geometry::Pose2 pose =
        made.drive.at(made.drive.start_s() + fraction(random) * span_s).pose();
    const Eigen::Vector2d beside = pose * Eigen::Vector2d(3.0, 0.84);
    auto cells = made.occupancy.cells();
    cells.push_back({{beside.x(), beside.y(), 1.0}, kSide_m, map::CellState::occupied});
    EXPECT_THAT(check_certificate(made.certificate, cells, kSide_m, made.drive),
                Contains(HasSubstr("that is no")));
    ++refuted;
  }
}

TEST(AuditCertificate, IsRefutedIfMeasuredSpaceIsTakenAway) {
  std::mt19937 random(19);
  int refuted = 0;
  while (refuted < 10) {
    const Audited made = audited(random, 1, {.unknown = UnknownPolicy::report});
    if (made.certificate.from_unknown.empty()) continue;
    auto cells = made.occupancy.cells();
    std::erase_if(
        cells, [](const map::OccupancyCell& cell) { return cell.state == map::CellState::free; });
    EXPECT_THAT(check_certificate(made.certificate, cells, kSide_m, made.drive),
                Contains(HasSubstr("from_unknown: at")));
    ++refuted;
  }
}

TEST(AuditCertificate, IsRefutedIfItsVerdictOrAConflictIsAnother) {
  std::mt19937 random(23);
  int conflicts = 0;
  while (conflicts < 8) {
    const Audited made = audited(random, 8, {.unknown = UnknownPolicy::free});
    AuditCertificate other = made.certificate;
    other.verdict = other.verdict == Verdict::clear ? Verdict::conflict : Verdict::clear;
    EXPECT_THAT(made.faults(other), Contains(HasSubstr("the verdict is")));
    if (made.report.verdict != Verdict::conflict) continue;

    other = made.certificate;
    other.conflicts.front().least_clearance_m += 0.01;
    EXPECT_THAT(made.faults(other), Contains(HasSubstr("the clearance is")));
    other = made.certificate;
    other.conflicts.front().witness.min_in_source.array() += 50.0;
    other.conflicts.front().witness.max_in_source.array() += 50.0;
    EXPECT_THAT(made.faults(other), Contains(HasSubstr("the witness is not")));
    other = made.certificate;
    other.conflicts.clear();
    other.verdict = Verdict::clear;
    EXPECT_THAT(made.faults(other), Contains(HasSubstr("nothing is said of")));
    ++conflicts;
  }
}

TEST(AuditCertificate, ClaimsNoMoreThanItsSpans) {
  std::mt19937 random(29);
  Audited made = audited(random, 3, {.unknown = UnknownPolicy::free});
  while (made.report.verdict != Verdict::clear) {
    made = audited(random, 3, {.unknown = UnknownPolicy::free});
  }
  made.certificate.certified_clearance_m += 1e-3;
  EXPECT_THAT(made.faults(made.certificate), Contains(HasSubstr("the spans certify")));
}

TEST(AuditCertificate, HoldsInLargeFreeSpaceToo) {
  // One leaf of 409.6 m on each side of the origin: far more columns than the drive comes near.
  std::vector<map::OccupancyCell> cells;
  for (const double x_m : {-204.8, 204.8}) {
    for (const double y_m : {-204.8, 204.8}) {
      cells.push_back({{x_m, y_m, 0.0}, 409.6, map::CellState::free});
    }
  }
  const Trajectory drive({{.t_s = 0, .x_m = -20, .y_m = -30}, {.t_s = 9, .x_m = 20, .y_m = 30}});
  AuditCertificate certificate{.part = geometry::body_of({}),
                               .band = kLowBand,
                               .verdict = Verdict::clear,
                               .from_occupied = {{0, 0.0, 1.0, 5.0}},
                               .from_unknown = {{0, 0.0, 1.0, 5.0}},
                               .conflicts = {},
                               .unknown = {},
                               .undecided = {}};
  for (double t_s = 0.0; t_s < 9.0; t_s += 1.0) {
    certificate.observed.push_back({t_s, t_s + 1.0, drive.at(t_s).pose().position()});
  }
  EXPECT_THAT(check_certificate(certificate, cells, kSide_m, drive), IsEmpty());
  cells.pop_back();
  EXPECT_THAT(check_certificate(certificate, cells, kSide_m, drive),
              Contains(HasSubstr("from_unknown: at")));
}

TEST(AuditCertificate, CertifiesNoClearanceWhereATimeIsLeftOutNorSpeaksOfOtherTimes) {
  std::mt19937 random(31);
  Audited made = audited(random, 3, {.unknown = UnknownPolicy::free});
  while (made.report.verdict != Verdict::clear) {
    made = audited(random, 3, {.unknown = UnknownPolicy::free});
  }
  AuditCertificate& bold = made.certificate;
  bold.undecided.push_back({made.drive.start_s(), made.drive.end_s()});
  bold.verdict = Verdict::undecided;
  bold.certified_clearance_m = 199.0;
  EXPECT_THAT(made.faults(bold), Contains(HasSubstr("the spans certify 0.000000 m")));
  bold.certified_clearance_m = 0.0;
  EXPECT_THAT(made.faults(bold), IsEmpty());
  bold.undecided.push_back({made.drive.end_s() + 10.0, made.drive.end_s() + 11.0});
  EXPECT_THAT(made.faults(bold), Contains(HasSubstr("is not in the drive")));
}

}  // namespace
}  // namespace roadbed::planning
