#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/geometry/polyline.h"
#include "roadbed/map/attributes.h"
#include "roadbed/map/id.h"
#include "roadbed/map/lane.h"
#include "roadbed/map/lane_graph.h"
#include "roadbed/map/lane_match.h"
#include "roadbed/map/lazy_list.h"
#include "roadbed/map/map_object.h"
#include "roadbed/map/regulation.h"
#include "roadbed/map/signal.h"

namespace roadbed::map {

/// A road of the source: the lanes of all its sections and its reference line.
struct Road {
  RoadId id;
  std::string source_id;
  std::string name;
  std::optional<JunctionId> junction;  ///< of a connecting road
  double length_m = 0.0;
  geometry::Polyline reference_in_map;     ///< sampled; `t` is measured from it
  std::vector<double> reference_road_s_m;  ///< road s, one per point of the reference line
  std::vector<LaneId> lanes;
};

/// How a junction joins roads (ASAM OpenDRIVE 1.8, section 12).
enum class JunctionKind { common, direct, virtual_, crossing };

struct Junction {
  JunctionId id;
  std::string source_id;
  std::string name;
  JunctionKind kind = JunctionKind::common;
  std::vector<RoadId> connecting_roads;
};

/// What the loader saw and did not keep, or had to mend: for `info` and `validate`.
struct ImportRemark {
  std::string rule;       ///< "import.unused-element", …
  bool is_fault = false;  ///< a fault of the file (a warning of `validate`), else a note
  std::string element;    ///< "road 12"
  long line = 0;          ///< in the source file, 0 if unknown
  std::string message;
};

/// Elements that the file holds and roadbed does not use.
struct UnusedContent {
  std::string name;  ///< of the element, as the file spells it, with its parent: "road/railroad"
  std::size_t count = 0;
};

/// How source coordinates lie in the CRS: turned about the origin, then moved (OpenDRIVE's header
/// offset). Used on the way to the CRS only.
struct CrsOffset {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0, heading_rad = 0.0;
  bool operator==(const CrsOffset&) const = default;
};

/// What a map says of itself as a whole. A new field is named in map_fields.h as well.
struct MapHead {
  std::string format;  ///< "OpenDRIVE 1.4", …
  std::string crs;     ///< as the file says, may be empty
  CrsOffset offset_in_crs;
  Eigen::Vector2d origin_in_source{0, 0};
  Attributes attributes;  ///< of the file as a whole: where the map is, who made it
};

/// Everything a map is made of, in lists of one kind. A new list is named in map_fields.h as well.
template <template <typename> typename List>
struct MapContent : MapHead {
  List<Road> roads;
  List<Junction> junctions;
  List<Signal> signals;
  List<Controller> controllers;
  List<StopLine> stop_lines;
  List<Regulation> regulations;
  List<MapObject> objects;
  List<Area> areas;
  List<Lane> lanes;
  List<LaneLinks> links;  ///< one per lane
  List<ImportRemark> remarks;
  List<UnusedContent> unused;  ///< in order of name
};

template <typename T>
using Vector = std::vector<T>;

/// What a reader of a format fills.
struct RoadMapParts : MapContent<Vector> {};

/// What a map keeps: in a compiled map things are made when they are first touched.
using LazyMapContent = MapContent<LazyList>;

struct RoadMapIndex;

/// A digital road map: what is where and how it connects, whatever the format. Immutable.
///
/// Coordinates ("in_map") are metres relative to `origin_in_source()`, so that they stay small;
/// users see the source's raw coordinates only: tools translate with `to_map` and `to_source`.
class RoadMap {
 public:
  /// @throws std::invalid_argument if ids are not in order or a link names nothing.
  explicit RoadMap(RoadMapParts parts);

  /// Of a compiled map, whose things check themselves when they are made.
  RoadMap(LazyMapContent content, RoadMapIndex index);
  ~RoadMap();
  RoadMap(RoadMap&&) noexcept;
  RoadMap& operator=(RoadMap&&) noexcept;

  const std::string& format() const { return content_.format; }
  const std::string& crs() const { return content_.crs; }
  const CrsOffset& offset_in_crs() const { return content_.offset_in_crs; }
  const Eigen::Vector2d& origin_in_source() const { return content_.origin_in_source; }
  const Attributes& attributes() const { return content_.attributes; }
  Eigen::Vector2d to_map(const Eigen::Vector2d& in_source) const;
  Eigen::Vector2d to_source(const Eigen::Vector2d& in_map) const;

  const LazyList<Lane>& lanes() const { return content_.lanes; }
  const Lane& lane(LaneId id) const { return content_.lanes.at(id.index); }
  const LazyList<Road>& roads() const { return content_.roads; }
  const Road& road(RoadId id) const { return content_.roads.at(id.index); }
  const LazyList<Junction>& junctions() const { return content_.junctions; }
  const Junction& junction(JunctionId id) const { return content_.junctions.at(id.index); }
  const LazyList<Signal>& signals() const { return content_.signals; }
  const LazyList<Controller>& controllers() const { return content_.controllers; }
  const LazyList<StopLine>& stop_lines() const { return content_.stop_lines; }
  const LazyList<Regulation>& regulations() const { return content_.regulations; }
  const LazyList<MapObject>& objects() const { return content_.objects; }
  const LazyList<Area>& areas() const { return content_.areas; }
  const LazyList<UnusedContent>& unused() const { return content_.unused; }
  const LazyList<ImportRemark>& remarks() const { return content_.remarks; }
  const LaneGraph& graph() const { return graph_; }
  const LazyMapContent& content() const { return content_; }
  const RoadMapIndex& index() const { return *index_; }

  /// A copy of everything.
  RoadMapParts parts() const;

  /// Lane by its unique name ("12/0/-1").
  std::optional<LaneId> find_lane(std::string_view name) const;

  /// Lanes within `radius_m` of the point, nearest first (inside: by |d|), ties by id.
  /// @param only_drivable  leave out sidewalks, borders and the like.
  std::vector<LaneMatch> locate(const Eigen::Vector2d& point_in_map, double radius_m,
                                bool only_drivable) const;

  /// The same for many points, at most `count` lanes each; faster than one by one.
  LaneMatches locate(std::span<const Eigen::Vector2d> points_in_map, double radius_m,
                     std::size_t count, bool only_drivable) const;

  /// Whether the point is on road surface (`is_surface` lanes), or at most `margin_m` off it.
  bool on_surface(const Eigen::Vector2d& point_in_map, double margin_m) const;

 private:
  LazyMapContent content_;
  LaneGraph graph_;
  std::unique_ptr<const RoadMapIndex> index_;
};

}  // namespace roadbed::map
