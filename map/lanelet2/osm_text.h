#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/files/transverse_mercator.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::map::lanelet2 {

/// An OpenStreetMap file while it is written: hands out ids that no other element has, and gathers
/// nodes, ways and relations, which follow each other in that order.
class OsmText {
 public:
  /// @param offset  of the map's raw coordinates in the CRS.
  /// @param grid    the CRS, from latitude and longitude.
  OsmText(const RoadMap& road_map, std::string crs, const CrsOffset& offset,
          const TransverseMercator& grid);

  /// What the source called a thing if it is a number that is still free, else a fresh id.
  std::int64_t keep(const std::string& source_id);
  std::int64_t fresh() { return next_++; }

  /// A node with its own id, lat/lon, local_x, local_y and ele.
  std::int64_t add_node(const Eigen::Vector3d& in_map);

  void add_way(std::int64_t id, const std::vector<std::int64_t>& nodes, const Attributes& tags);

  /// @param members  lines that `member` made.
  void add_relation(std::int64_t id, const std::string& members, const Attributes& tags);

  static std::string member(const char* kind, std::int64_t id, std::string_view role);

  /// The whole file; the CRS is an attribute of its root if local_x and local_y are in it.
  std::string file() const;

 private:
  const RoadMap& road_map_;
  const std::string crs_;
  const CrsOffset offset_;
  const TransverseMercator grid_;
  std::int64_t next_;
  std::set<std::int64_t> taken_;
  std::string nodes_, ways_, relations_;
};

}  // namespace roadbed::map::lanelet2
