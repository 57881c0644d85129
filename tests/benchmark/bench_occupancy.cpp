// Times occupancy, clearance fields and audits on a made street, beside OctoMap, PCL and FCL, as a
// Markdown table.

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <malloc.h>
#include <octomap/octomap.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "occupancy_peers.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/map/occupancy/clearance/distance_transform.h"
#include "roadbed/map/occupancy/clouds/read_point_cloud.h"
#include "roadbed/map/occupancy/octree/cloud_measurements.h"
#include "roadbed/map/occupancy/octree/occupancy_map.h"
#include "roadbed/planning/audit/certificate.h"
#include "roadbed/planning/audit/check/certificate_check.h"
#include "roadbed/planning/audit/clearance_audit.h"
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

/// A drive to and fro between parked cars, 10 km of it with a row every 0.1 m.
geometry::Trajectory along_street(double beside_m) {
  constexpr double length_m = 10'000.0, step_m = 0.1;
  std::vector<geometry::TrajectoryPoint> rows;
  const auto steps = static_cast<std::size_t>(length_m / step_m);
  for (std::size_t i = 0; i <= steps; ++i) {
    const double way_m = step_m * static_cast<double>(i),
                 x_m = 45.0 - 40.0 * std::cos(way_m / 50.0);
    rows.push_back({.t_s = way_m / 10.0,
                    .x_m = x_m,
                    .y_m = beside_m + 0.5 * std::sin(way_m / 9.0),
                    .heading_rad = 0.05 * std::cos(way_m / 9.0),
                    .speed_mps = 10.0});
  }
  return geometry::Trajectory(std::move(rows));
}

/// A drive around a square without anything in it, 5 km of it with a row every 0.05 m.
geometry::Trajectory around_square() {
  constexpr double radius_m = 30.0, step_m = 0.05;
  std::vector<geometry::TrajectoryPoint> rows;
  for (std::size_t i = 0; i <= 100'000; ++i) {
    const double way_m = step_m * static_cast<double>(i), turn = way_m / radius_m;
    rows.push_back({.t_s = way_m / 10.0,
                    .x_m = 100.0 + radius_m * std::sin(turn),
                    .y_m = 100.0 - radius_m * std::cos(turn),
                    .heading_rad = turn,
                    .speed_mps = 10.0});
  }
  return geometry::Trajectory(std::move(rows));
}

/// Poles 15 m beside the circle of `around_square`, a metre apart, and perhaps one 3.5 m beside it.
map::OccupancyMap open_road(bool has_near_pole) {
  map::PointCloud cloud;
  const auto add = [&](double turn, double radius_m) {
    cloud.points.emplace_back(static_cast<float>(100.0 + radius_m * std::cos(turn)),
                              static_cast<float>(100.0 + radius_m * std::sin(turn)), 0.75f);
  };
  for (int i = 0; i < 300; ++i) add(i / 300.0 * 2.0 * M_PI, 45.0);
  if (has_near_pole) add(1.0, 33.5);
  return map::OccupancyMap::build(std::vector{cloud}, {.resolution_m = 0.1});
}

// Every pose by itself: its sine and cosine, and the bound of the circle around the body.
double bounds_of_poses(const map::ClearanceField& field, const geometry::Trajectory& drive,
                       const geometry::VehicleShape& car) {
  const double middle_m = 0.5 * car.length_m - car.rear_overhang_m;
  double sum_m = 0.0;
  for (const auto& point : drive.points()) {
    const Eigen::Vector2d ahead(std::cos(point.heading_rad), std::sin(point.heading_rad));
    sum_m += field.distance_bound_m(point.pose().position() + middle_m * ahead);
  }
  return sum_m;
}

double exact_tests(const map::ClearanceField& field, const geometry::Trajectory& drive,
                   const geometry::VehicleShape& car, double within_m) {
  double sum_m = 0.0;
  for (const auto& point : drive.points()) {
    const auto near = field.nearest(point.pose(), car, within_m);
    sum_m += near ? near->distance_m : within_m;
  }
  return sum_m;
}

void bench_open_road(bool has_near_pole, int reps) {
  const map::OccupancyMap surroundings = open_road(has_near_pole);
  const geometry::Trajectory drive = around_square();
  const geometry::VehicleShape car;
  const planning::AuditOptions options{.clearance_m = 1.0,
                                       .unknown = planning::UnknownPolicy::free};
  const map::ClearanceField field(surroundings, map::HeightBand{0.3, 1.5},
                                  planning::audited_region(drive, car, options));
  const auto poses = static_cast<double>(drive.points().size());
  if (has_near_pole) {
    row("bounds of poses on an open road, each with its sine and cosine", poses,
        median_s(reps, [&] { bounds_of_poses(field, drive, car); }), "M poses/s");
  }
  row(has_near_pole ? "audit of an open road, rows of the drive"
                    : "audit of a bend between poles in a row, rows of the drive",
      poses, median_s(reps, [&] { planning::audit_clearance(field, drive, car, options); }),
      "M rows/s");
}

void bench_transform(int reps) {
  const std::size_t side = 2000;
  std::vector<std::uint8_t> set(side * side);
  for (std::size_t i = 0; i < set.size(); i += 997) set[i] = 1;
  row("distance transform", static_cast<double>(set.size()),
      median_s(reps, [&] { map::distances_to_set(set, side, side); }), "M cells/s");
}

// Occupied cells of the street in the band, as boxes of one cell in plan view.
std::vector<map::Box2> boxes_of(const map::OccupancyMap& street, const map::HeightBand& band,
                                double cell_m) {
  std::set<std::pair<long, long>> columns;
  for (const map::OccupancyCell& leaf : street.cells()) {
    const double low_m = leaf.centre_in_source.z() - 0.5 * leaf.size_m;
    if (leaf.state != map::CellState::occupied || !band.holds({0.0, 0.0}, low_m, leaf.size_m)) {
      continue;
    }
    const long side = std::lround(leaf.size_m / cell_m);
    const Eigen::Array2d first =
        (leaf.centre_in_source.head<2>().array() - 0.5 * leaf.size_m) / cell_m;
    for (long i = 0; i < side * side; ++i) {
      columns.emplace(std::lround(first.x()) + i % side, std::lround(first.y()) + i / side);
    }
  }
  std::vector<map::Box2> boxes;
  for (const auto& [x, y] : columns) {
    const Eigen::Array2d least(cell_m * static_cast<double>(x), cell_m * static_cast<double>(y));
    boxes.push_back({least, least + cell_m});
  }
  return boxes;
}

#ifdef ROADBED_OCCUPANCY_PEERS
void bench_peers(const PeerScene& scene, int reps) {
  const KdTreePeer kd_tree(scene);
  const FclPeer fcl(scene, 0.1);
  const std::size_t poses = 10'000;
  std::size_t clear_of_points = 0, clear_of_cells = 0;
  row("PCL KdTreeFLANN, five circles a pose", static_cast<double>(poses),
      median_s(reps, [&] { clear_of_points = kd_tree.clear_poses(poses); }), "M poses/s");
  row("FCL, box against OcTree", static_cast<double>(poses),
      median_s(reps, [&] { clear_of_cells = fcl.clear_poses(poses); }), "M poses/s");
  fmt::print("| of {} poses beside parked cars clear by PCL, by FCL | {}, {} | |\n", poses,
             clear_of_points, clear_of_cells);
}
#endif

void dump(const std::string& folder, const PeerScene& scene) {
  std::ofstream boxes(folder + "/boxes.csv"), poses(folder + "/poses.csv");
  boxes << "min_x_m,min_y_m,max_x_m,max_y_m\n";
  for (const map::Box2& box : scene.boxes) {
    fmt::print(boxes, "{},{},{},{}\n", box.min_in_source.x(), box.min_in_source.y(),
               box.max_in_source.x(), box.max_in_source.y());
  }
  poses << "x_m,y_m,heading_rad\n";
  for (const auto& row : scene.drive.points()) {
    fmt::print(poses, "{},{},{}\n", row.x_m, row.y_m, row.heading_rad);
  }
}

void bench_audit(const std::vector<map::PointCloud>& scans, int reps,
                 const std::string& dump_folder) {
  const map::OccupancyMap street = map::OccupancyMap::build(scans, {.resolution_m = 0.1});
  const geometry::Trajectory drive = along_street(0.0), beside_cars = along_street(2.5);
  const geometry::VehicleShape car;
  const planning::AuditOptions options{.unknown = planning::UnknownPolicy::free};
  map::FieldRegion region = planning::audited_region(drive, car, options);
  region.around.max_in_source.y() += 2.5;
  const map::HeightBand band{0.3, 1.5};
  const map::ClearanceField field(street, band, region);
  fmt::print("| clearance field of the street | | {:.0f} ms |\n",
             1e3 * median_s(reps, [&] { map::ClearanceField(street, band, region); }));
  bench_transform(reps);

  const auto poses = static_cast<double>(drive.points().size());
  row("bounds of poses by circles, each with its sine and cosine", poses,
      median_s(reps, [&] { bounds_of_poses(field, drive, car); }), "M poses/s");
  row("exact tests of rectangles, nothing within 0.5 m", poses,
      median_s(reps, [&] { exact_tests(field, drive, car, 0.5); }), "M poses/s");
  row("exact tests of rectangles beside parked cars, up to 0.5 m", poses,
      median_s(reps, [&] { exact_tests(field, beside_cars, car, 0.5); }), "M poses/s");
  row("exact distances of rectangles, 1.5 m to 3 m away", poses,
      median_s(reps, [&] { exact_tests(field, drive, car, 50.0); }), "M poses/s");
  planning::AuditReport report;
  row("audit of 10 km, a row every 0.1 m", poses,
      median_s(reps, [&] { report = planning::audit_clearance(field, drive, car, options); }),
      "M rows/s");
  row("and its proof", poses,
      median_s(reps, [&] { planning::certify(field, band, drive, car, options, report); }),
      "M rows/s");
  const auto proof = planning::certify(field, band, drive, car, options, report);
  const std::vector<map::OccupancyCell> cells = street.cells();
  std::size_t faults = 0;
  row("and the check of that", poses,
      median_s(reps,
               [&] { faults += planning::check_certificate(proof, cells, 0.1, drive).size(); }),
      "M rows/s");
  if (faults > 0) fmt::print("| the proof does not hold | | |\n");
  bench_open_road(true, reps);
  bench_open_road(false, reps);
  const PeerScene scene{boxes_of(street, band, 0.1), band.to_m - band.from_m, beside_cars, car};
#ifdef ROADBED_OCCUPANCY_PEERS
  bench_peers(scene, reps);
#endif
  if (!dump_folder.empty()) dump(dump_folder, scene);
  fmt::print("\nverdict {}, least clearance {:.3f} m\n", to_string(report.verdict),
             report.least_clearance_m);
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

}  // namespace
}  // namespace roadbed

int main(int argc, char** argv) {
  using namespace roadbed;
  int scans_wanted = 50, reps = 3;
  std::string dump_folder;
  CLI::App app{
      "Times occupancy, clearance fields and audits on a made street, beside OctoMap, PCL and FCL; "
      "prints a Markdown table. CPU time of one thread, medians."};
  app.add_option("--scans", scans_wanted, "of 64 by 1800 beams")
      ->capture_default_str()
      ->check(CLI::Range(1, 10'000));
  app.add_option("--reps", reps, "of each row")->capture_default_str()->check(CLI::Range(1, 1000));
  app.add_option("--dump", dump_folder, "where boxes.csv and poses.csv go, for other checkers");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  const auto scans = street_scans(scans_wanted);
  fmt::print("{} scans, {:.2f} M points\n\n| what | rate | CPU time |\n|---|---|---|\n",
             scans.size(), points_in(scans) / 1e6);
  bench_reading(scans, reps);
  bench_building(scans, reps);
  bench_audit(scans, reps, dump_folder);
}
