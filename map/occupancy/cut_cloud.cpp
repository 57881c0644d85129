#include "roadbed/map/occupancy/cut_cloud.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "roadbed/map/occupancy/cell_range.h"

namespace roadbed::map {
namespace {

/// Points in a row that were measured from one place.
struct Scan {
  std::size_t first, last;  // without the last one
  std::optional<Eigen::Vector3d> sensor_in_source;
};

std::vector<Scan> scans_of(const PointCloud& cloud) {
  if (cloud.scans.empty()) return {{0, cloud.points.size(), cloud.sensor_in_source}};
  std::vector<Scan> scans;
  for (const ScanStart& start : cloud.scans) {
    if (!scans.empty()) scans.back().last = start.first;
    scans.push_back({start.first, cloud.points.size(), start.sensor_in_source});
  }
  return scans;
}

PointCloud without_points(const PointCloud& cloud) {
  return {.name = cloud.name,
          .origin_in_source = cloud.origin_in_source,
          .points = {},
          .format = cloud.format,
          .crs = cloud.crs,
          .unit = cloud.unit,
          .sensor_in_source = {},
          .scans = {},
          .notes = {}};
}

Box3 box_around(const PointCloud& cloud, const Scan& scan) {
  Box3 box{cloud.in_source(scan.first), cloud.in_source(scan.first)};
  const auto add = [&box](const Eigen::Vector3d& point) {
    box.min_in_source = box.min_in_source.cwiseMin(point);
    box.max_in_source = box.max_in_source.cwiseMax(point);
  };
  for (std::size_t i = scan.first + 1; i < scan.last; ++i) add(cloud.in_source(i));
  if (scan.sensor_in_source) add(*scan.sensor_in_source);
  return box;
}

Box3 joined(const Box3& a, const Box3& b) {
  return {a.min_in_source.cwiseMin(b.min_in_source), a.max_in_source.cwiseMax(b.max_in_source)};
}

class Cutter {
 public:
  Cutter(const PointCloud& cloud, const Eigen::Vector3d& origin_in_source, double side_m)
      : cloud_(cloud), origin_in_source_(origin_in_source), side_m_(side_m) {}

  std::vector<PointCloud> cut() {
    for (const Scan& scan : scans_of(cloud_)) {
      if (scan.first == scan.last) continue;
      scan.sensor_in_source ? add_to_run(scan) : add_to_cubes(scan);
    }
    end_run();
    for (auto& [place, piece] : cubes_) pieces_.push_back(std::move(piece));
    return std::move(pieces_);
  }

 private:
  void add_to_cubes(const Scan& scan) {
    for (std::size_t i = scan.first; i < scan.last; ++i) {
      const Eigen::Vector3d cubes = (cloud_.in_source(i) - origin_in_source_) / side_m_;
      const std::array<std::int64_t, 3> place{whole_below(cubes.x()), whole_below(cubes.y()),
                                              whole_below(cubes.z())};
      cubes_.try_emplace(place, without_points(cloud_))
          .first->second.points.push_back(cloud_.points[i]);
    }
  }

  void add_to_run(const Scan& scan) {
    const Box3 alone = box_around(cloud_, scan);
    const Box3 with = run_.points.empty() ? alone : joined(run_box_, alone);
    const bool fits = (with.max_in_source - with.min_in_source).maxCoeff() <= side_m_;
    if (!fits) end_run();
    run_box_ = fits ? with : alone;
    if (run_.points.empty()) run_ = without_points(cloud_);
    run_.scans.push_back({run_.points.size(), scan.sensor_in_source});
    run_.points.insert(run_.points.end(),
                       cloud_.points.begin() + static_cast<std::ptrdiff_t>(scan.first),
                       cloud_.points.begin() + static_cast<std::ptrdiff_t>(scan.last));
  }

  void end_run() {
    if (!run_.points.empty()) pieces_.push_back(std::exchange(run_, {}));
  }

  const PointCloud& cloud_;
  Eigen::Vector3d origin_in_source_;
  double side_m_;
  std::map<std::array<std::int64_t, 3>, PointCloud> cubes_;
  PointCloud run_;
  Box3 run_box_;
  std::vector<PointCloud> pieces_;
};

}  // namespace

std::vector<PointCloud> cut_cloud(const PointCloud& cloud, const Eigen::Vector3d& origin_in_source,
                                  double side_m) {
  return Cutter(cloud, origin_in_source, side_m).cut();
}

}  // namespace roadbed::map
