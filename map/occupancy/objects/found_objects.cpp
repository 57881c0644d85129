#include "roadbed/map/occupancy/objects/found_objects.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

#include "roadbed/map/occupancy/clouds/pcl_function.h"
#include "roadbed/map/occupancy/objects/fitted_rectangle.h"
#include "roadbed/map/occupancy/objects/pcl_objects.h"

namespace roadbed::map::inline occupancy::inline objects {
namespace {

using Indices = std::vector<std::size_t>;  // of points of the cloud, increasing

/// Clusters that are too large are taken apart with a tolerance that shrinks so far.
constexpr double kShrink = 0.7, kLeastTolerance_m = 0.15, kLeastKept = 0.9;

class ObjectSearch {
 public:
  ObjectSearch(const PointCloud& cloud, const ObjectOptions& options)
      : cloud_(cloud), options_(options) {}

  std::vector<FoundObject> run() {
    for (const Indices& cluster : clusters(above_ground(), options_.tolerance_m)) {
      take(cluster, options_.tolerance_m);
    }
    std::ranges::stable_sort(found_, {}, &Found::first);
    std::vector<FoundObject> objects;
    for (const Found& found : found_) objects.push_back(found.object);
    return objects;
  }

 private:
  struct Found {
    std::size_t first;
    FoundObject object;
  };

  Indices above_ground() const {
    const GroundSegmentation ground = segment_ground(cloud_, options_.ground);
    Indices above;
    for (std::size_t i = 0; i < cloud_.points.size(); ++i) {
      const float height_m = ground.heights_m[i];
      if (!ground.is_ground[i] && height_m >= 0.0f && height_m <= options_.tallest_m) {
        above.push_back(i);
      }
    }
    return above;
  }

  std::vector<Indices> clusters(const Indices& of, double tolerance_m) const {
    static auto& cluster = pcl_function_as<RoadbedPclClusters>("roadbed_pcl_clusters");
    if (of.empty()) return {};
    std::vector<Eigen::Vector3f> points;
    for (const std::size_t i : of) points.push_back(cloud_.points[i]);
    std::vector<std::int32_t> numbers(points.size());
    cluster(points.front().data(), points.size(), tolerance_m, options_.least_points,
            numbers.data());
    std::vector<Indices> found(static_cast<std::size_t>(1 + *std::ranges::max_element(numbers)));
    for (std::size_t i = 0; i < of.size(); ++i) {
      if (numbers[i] >= 0) found[static_cast<std::size_t>(numbers[i])].push_back(of[i]);
    }
    return found;
  }

  void take(const Indices& cluster, double tolerance_m) {
    const geometry::Rectangle box = fitted_rectangle(in_plan(cluster));
    if (2.0 * box.half_length_m <= options_.longest_m &&
        2.0 * box.half_width_m <= options_.widest_m) {
      found_.push_back({cluster.front(), object(cluster, box)});
    } else if (const auto parts = nearer_parts(cluster, tolerance_m); !parts.empty()) {
      for (const Indices& part : parts) take(part, kShrink * tolerance_m);
    } else {
      cut(cluster);
    }
  }

  // None where points are too far apart to tell bodies from gaps: most have to stay together.
  std::vector<Indices> nearer_parts(const Indices& cluster, double tolerance_m) const {
    if (kShrink * tolerance_m < kLeastTolerance_m) return {};
    std::vector<Indices> parts = clusters(cluster, kShrink * tolerance_m);
    std::size_t kept = 0;
    for (const Indices& part : parts) kept += part.size();
    const bool is_dust =
        static_cast<double>(kept) < kLeastKept * static_cast<double>(cluster.size());
    return is_dust ? std::vector<Indices>() : parts;
  }

  // Where the squares of the source lie, so that the pieces of a wall are the same in the next
  // cloud, whatever of it that shows.
  void cut(const Indices& cluster) {
    std::map<std::pair<long, long>, Indices> pieces;
    for (const std::size_t i : cluster) {
      const Eigen::Vector3d place = cloud_.in_source(i) / options_.widest_m;
      pieces[{std::lround(place.x()), std::lround(place.y())}].push_back(i);
    }
    for (const auto& [square, piece] : pieces) {
      found_.push_back({piece.front(), object(piece, fitted_rectangle(in_plan(piece)))});
    }
  }

  // Relative to the cloud's origin.
  std::vector<Eigen::Vector2d> in_plan(const Indices& cluster) const {
    std::vector<Eigen::Vector2d> points;
    points.reserve(cluster.size());
    for (const std::size_t i : cluster) {
      points.emplace_back(cloud_.points[i].head<2>().cast<double>());
    }
    return points;
  }

  FoundObject object(const Indices& cluster, geometry::Rectangle box) const {
    box.centre += cloud_.origin_in_source.head<2>();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    FoundObject object{box, infinity, -infinity, cluster.size()};
    for (const std::size_t i : cluster) {
      const double z_m = cloud_.in_source(i).z();
      object.bottom_m = std::min(object.bottom_m, z_m);
      object.top_m = std::max(object.top_m, z_m);
    }
    return object;
  }

  const PointCloud& cloud_;
  const ObjectOptions& options_;
  std::vector<Found> found_;
};

}  // namespace

std::vector<FoundObject> find_objects(const PointCloud& cloud, const ObjectOptions& options) {
  return ObjectSearch(cloud, options).run();
}

}  // namespace roadbed::map::occupancy::objects
