#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/files/transverse_mercator.h"
#include "roadbed/map/lanelet2/document.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::map::lanelet2 {

/// A point of an OpenStreetMap file while it is made. Where it is, it says itself; `tags` are
/// others.
struct OsmNode {
  std::int64_t id = 0;
  Eigen::Vector3d in_map{0, 0, 0};
  Attributes tags;
};

struct OsmWay {
  std::int64_t id = 0;
  std::vector<std::uint32_t> nodes;  ///< places in OsmMap::nodes
  Attributes tags;
};

struct OsmMember {
  MemberKind kind = MemberKind::way;
  std::uint32_t index = 0;  ///< in the list of that kind
  std::string role;
};

struct OsmRelation {
  std::int64_t id = 0;
  std::vector<OsmMember> members;
  Attributes tags;
};

/// Ids that a map may bring along; of fresh ones there are 2·10¹⁶ beyond.
inline constexpr std::int64_t kLargestKeptId = 9'200'000'000'000'000'000;

/// An OpenStreetMap file while it is made: its elements, which name each other by their places in
/// these lists, and ids that no other element has.
class OsmMap {
 public:
  /// @param first_fresh_id  larger than every id that may be kept.
  explicit OsmMap(std::int64_t first_fresh_id) : next_(first_fresh_id) {}

  std::vector<OsmNode> nodes;
  std::vector<OsmWay> ways;
  std::vector<OsmRelation> relations;

  /// What the source called a thing if it is a number that is still free, else a fresh id.
  std::int64_t keep(const std::string& source_id);
  std::int64_t fresh() { return next_++; }

  /// A new element, with a fresh id if none is given; its place in its list.
  std::uint32_t add_node(const Eigen::Vector3d& in_map, Attributes tags = {});
  std::uint32_t add_way(std::vector<std::uint32_t> of_nodes, Attributes tags, std::int64_t id);
  std::uint32_t add_way(std::vector<std::uint32_t> of_nodes, Attributes tags) {
    return add_way(std::move(of_nodes), std::move(tags), fresh());
  }
  std::uint32_t add_relation(std::vector<OsmMember> members, Attributes tags, std::int64_t id);
  std::uint32_t add_relation(std::vector<OsmMember> members, Attributes tags) {
    return add_relation(std::move(members), std::move(tags), fresh());
  }

  /// Points of a way, in map [m].
  std::vector<Eigen::Vector3d> points(std::uint32_t way) const;

 private:
  std::int64_t next_;
  std::set<std::int64_t> taken_;
};

/// The number after the largest by which a map's things are named.
std::int64_t id_beyond_all(const RoadMap& road_map);

/// The value of a tag; empty without it.
std::string_view tag_of(const Attributes& tags, std::string_view key);
/// Puts a tag in place of that of its key, or behind the others.
void set_tag(Attributes& tags, std::string_view key, std::string_view value);
void remove_tag(Attributes& tags, std::string_view key);

/// Where a node is.
struct OsmPlace {
  GeographicPoint on_earth;         ///< zeros where that is unknown
  Eigen::Vector2d local{0, 0};      ///< as local_x and local_y say it
  std::string_view mgrs_code = {};  ///< or empty
};

/// What a file says of itself.
struct OsmFrame {
  double z_offset_m = 0.0;     ///< from in_map to `ele`
  std::string crs;             ///< of the local coordinates; empty: not said
  bool with_versions = false;  ///< Autoware's MetaInfo
};

/// The whole file: nodes with lat, lon, local_x, local_y and ele, then ways, then relations. Its
/// root says that it is not to be uploaded to OpenStreetMap.
/// @param place_of  of a node, by its place in OsmMap::nodes; asked once for each.
std::string osm_text(const OsmMap& osm, const OsmFrame& frame,
                     const std::function<OsmPlace(std::size_t)>& place_of);

}  // namespace roadbed::map::lanelet2
