// Times occupancy, clearance fields and audits on a made street, beside OctoMap's own insertion;
// prints a Markdown table. CPU time of one thread, medians.
//
//   bench_occupancy [--scans N] [--reps R]
#include <fmt/format.h>
#include <malloc.h>
#include <octomap/octomap.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "roadbed/map/occupancy/clearance_field.h"
#include "roadbed/map/occupancy/cloud_measurements.h"
#include "roadbed/map/occupancy/distance_transform.h"
#include "roadbed/map/occupancy/occupancy_map.h"
#include "roadbed/planning/audit.h"
#include "roadbed/planning/audit_certificate.h"
#include "street_scene.h"

namespace roadbed {
namespace {

double cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median_s(int reps, const std::function<void()>& work) {
  std::vector<double> times;
  for (int i = 0; i < reps; ++i) {
    const double start = cpu_s();
    work();
    times.push_back(cpu_s() - start);
  }
  std::ranges::sort(times);
  return times[times.size() / 2];
}

double heap_bytes() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

void row(const std::string& what, double count, double seconds, const std::string& unit) {
  fmt::print("| {} | {:.2f} {} | {:.0f} ms |\n", what, count / seconds / 1e6, unit, 1e3 * seconds);
  std::fflush(stdout);
}

double points_in(const std::vector<map::PointCloud>& scans) {
  double points = 0.0;
  for (const map::PointCloud& scan : scans) points += static_cast<double>(scan.points.size());
  return points;
}

void insert_with_octomap(const std::vector<map::PointCloud>& scans, double resolution_m) {
  octomap::OcTree tree(resolution_m);
  for (const map::PointCloud& scan : scans) {
    octomap::Pointcloud points;
    for (const Eigen::Vector3f& p : scan.points) points.push_back(p.x(), p.y(), p.z());
    const Eigen::Vector3f sensor = scan.sensor_in_source->cast<float>();
    tree.insertPointCloud(points, {sensor.x(), sensor.y(), sensor.z()}, -1.0, true, true);
  }
  tree.updateInnerOccupancy();
}

void report_memory(const std::vector<map::PointCloud>& scans, double resolution_m) {
  const map::OccupancyOptions options{.resolution_m = resolution_m};
  const double before = heap_bytes();
  map::CloudMeasurements cells(Eigen::Vector3d::Zero(), options, {},
                               static_cast<std::size_t>(points_in(scans)));
  for (const map::PointCloud& scan : scans) cells.add(scan);
  const double used = heap_bytes() - before;
  double known = 0.0;
  for (const map::OccupancyCell& cell : map::OccupancyMap::build(scans, options).cells()) {
    known += std::pow(std::round(cell.size_m / resolution_m), 3.0);
  }
  fmt::print("| memory while building at {} m | {:.1f} bytes a known cell | {:.1f} M cells |\n",
             resolution_m, used / known, known / 1e6);
}

void bench_building(const std::vector<map::PointCloud>& scans, int reps) {
  for (const double resolution_m : {0.2, 0.1}) {
    const map::OccupancyOptions options{.resolution_m = resolution_m};
    const std::string at = fmt::format(" at {} m", resolution_m);
    const double points = points_in(scans);
    row("clouds to a .bt" + at, points,
        median_s(reps, [&] { map::OccupancyMap::build_bt(scans, options); }), "M points/s");
    row("clouds to an OcTree" + at, points,
        median_s(reps, [&] { map::OccupancyMap::build(scans, options); }), "M points/s");
    const std::vector<map::PointCloud> few(scans.begin(),
                                           scans.begin() + std::min<long>(3, std::ssize(scans)));
    row("OctoMap's insertPointCloud, lazy, discretised" + at, points_in(few),
        median_s(1, [&] { insert_with_octomap(few, resolution_m); }), "M points/s");
    report_memory(scans, resolution_m);
  }
}

geometry::Trajectory along_street(double length_m, double step_m) {
  std::vector<geometry::TrajectoryPoint> rows;
  const auto steps = static_cast<std::size_t>(length_m / step_m);
  for (std::size_t i = 0; i <= steps; ++i) {
    const double way_m = step_m * static_cast<double>(i),
                 x_m = 45.0 - 40.0 * std::cos(way_m / 50.0);
    rows.push_back({.t_s = way_m / 10.0,
                    .x_m = x_m,
                    .y_m = 0.5 * std::sin(way_m / 9.0),
                    .heading_rad = 0.05 * std::cos(way_m / 9.0),
                    .speed_mps = 10.0});
  }
  return geometry::Trajectory(std::move(rows));
}

void bench_audit(const std::vector<map::PointCloud>& scans, int reps) {
  const map::OccupancyMap street = map::OccupancyMap::build(scans, {.resolution_m = 0.1});
  const geometry::Trajectory drive = along_street(10'000.0, 0.1);
  const geometry::VehicleShape car;
  const planning::AuditOptions options{.unknown = planning::UnknownPolicy::free};
  const map::FieldRegion region = planning::audited_region(drive, car, options);
  const map::HeightBand band{0.3, 1.5};
  const map::ClearanceField field(street, band, region);
  fmt::print("| clearance field of the street | | {:.0f} ms |\n",
             1e3 * median_s(reps, [&] { map::ClearanceField(street, band, region); }));
  const std::size_t side = 2000;
  std::vector<std::uint8_t> set(side * side);
  for (std::size_t i = 0; i < set.size(); i += 997) set[i] = 1;
  row("distance transform", static_cast<double>(set.size()),
      median_s(reps, [&] { map::distances_to_set(set, side, side); }), "M cells/s");

  const auto poses = static_cast<double>(drive.points().size());
  double sum_m = 0.0;
  row("bounds of poses by circles", poses,
      median_s(reps,
               [&] {
                 for (const auto& point : drive.points()) {
                   sum_m += field.distance_bound_m(point.pose().position());
                 }
               }),
      "M lookups/s");
  row("exact tests of rectangles", poses,
      median_s(reps,
               [&] {
                 for (const auto& point : drive.points()) {
                   const auto near = field.nearest(point.pose(), car, 0.5);
                   sum_m += near ? near->distance_m : 0.5;
                 }
               }),
      "M poses/s");
  planning::AuditReport report;
  row("audit of 10 km, a row every 0.1 m", poses,
      median_s(reps, [&] { report = planning::audit(field, drive, car, options); }), "M poses/s");
  row("and its proof", poses,
      median_s(reps, [&] { planning::certify(field, band, drive, car, options, report); }),
      "M poses/s");
  fmt::print("\nverdict {}, least clearance {:.3f} m, checksum {:.0f}\n", name(report.verdict),
             report.least_clearance_m, sum_m);
}

void bench_reading(const std::vector<map::PointCloud>& scans, int reps) {
  std::string body;
  for (const map::PointCloud& scan : scans) {
    body.append(reinterpret_cast<const char*>(scan.points.data()), 12 * scan.points.size());
  }
  const std::size_t points = body.size() / 12;
  const std::string pcd = fmt::format(
      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {0}\nHEIGHT 1\n"
      "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA binary\n{1}",
      points, body);
  row("points from a binary .pcd in memory", static_cast<double>(points),
      median_s(reps, [&] { map::parse_point_cloud(pcd, "street.pcd"); }), "M points/s");
}

int number_of(int argc, char** argv, const char* option, int otherwise) {
  for (int i = 1; i + 1 < argc; ++i) {
    if (std::strcmp(argv[i], option) != 0) continue;
    std::from_chars(argv[i + 1], argv[i + 1] + std::strlen(argv[i + 1]), otherwise);
  }
  return std::max(1, otherwise);
}

}  // namespace
}  // namespace roadbed

int main(int argc, char** argv) {
  using namespace roadbed;
  const auto scans = street_scans(number_of(argc, argv, "--scans", 50));
  const int reps = number_of(argc, argv, "--reps", 3);
  fmt::print("{} scans, {:.2f} M points\n\n| what | rate | CPU time |\n|---|---|---|\n",
             scans.size(), points_in(scans) / 1e6);
  bench_reading(scans, reps);
  bench_building(scans, reps);
  bench_audit(scans, reps);
}
