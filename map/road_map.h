#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/geometry/polyline.h"
#include "roadbed/map/id.h"
#include "roadbed/map/lane.h"
#include "roadbed/map/lane_graph.h"
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

/// Everything a RoadMap is made of, filled by a reader of a format.
struct RoadMapParts {
  std::string format;  ///< "OpenDRIVE 1.4", …
  std::string crs;     ///< as the file says, may be empty
  CrsOffset offset_in_crs;
  Eigen::Vector2d origin_in_source{0, 0};
  std::vector<Road> roads;
  std::vector<Junction> junctions;
  std::vector<Signal> signals;
  std::vector<Controller> controllers;
  std::vector<StopLine> stop_lines;
  std::vector<Regulation> regulations;
  std::vector<MapObject> objects;
  std::vector<Area> areas;
  std::vector<Lane> lanes;
  std::vector<LaneLinks> links;  ///< one per lane
  std::vector<ImportRemark> remarks;
  std::vector<UnusedContent> unused;  ///< in order of name
};

/// A lane near a point. `distance_m` is 0 inside the lane's polygon.
struct LaneMatch {
  LanePlace place;
  double distance_m = 0.0;
  double heading_rad = 0.0;  ///< of the lane there
};

/// A digital road map: what is where and how it connects, whatever the format. Immutable.
///
/// Coordinates ("in_map") are metres relative to `origin_in_source()`, so that they stay small;
/// users see the source's raw coordinates only: tools translate with `to_map` and `to_source`.
class RoadMap {
 public:
  /// @throws std::invalid_argument if ids are not in order or a link names nothing.
  explicit RoadMap(RoadMapParts parts);
  ~RoadMap();
  RoadMap(RoadMap&&) noexcept;
  RoadMap& operator=(RoadMap&&) noexcept;

  const std::string& format() const { return parts_.format; }
  const std::string& crs() const { return parts_.crs; }
  const CrsOffset& offset_in_crs() const { return parts_.offset_in_crs; }
  const Eigen::Vector2d& origin_in_source() const { return parts_.origin_in_source; }
  Eigen::Vector2d to_map(const Eigen::Vector2d& in_source) const;
  Eigen::Vector2d to_source(const Eigen::Vector2d& in_map) const;

  const std::vector<Lane>& lanes() const { return parts_.lanes; }
  const Lane& lane(LaneId id) const { return parts_.lanes.at(id.index); }
  const std::vector<Road>& roads() const { return parts_.roads; }
  const Road& road(RoadId id) const { return parts_.roads.at(id.index); }
  const std::vector<Junction>& junctions() const { return parts_.junctions; }
  const Junction& junction(JunctionId id) const { return parts_.junctions.at(id.index); }
  const std::vector<Signal>& signals() const { return parts_.signals; }
  const std::vector<Controller>& controllers() const { return parts_.controllers; }
  const std::vector<StopLine>& stop_lines() const { return parts_.stop_lines; }
  const std::vector<Regulation>& regulations() const { return parts_.regulations; }
  const std::vector<MapObject>& objects() const { return parts_.objects; }
  const std::vector<Area>& areas() const { return parts_.areas; }
  const std::vector<UnusedContent>& unused() const { return parts_.unused; }
  const std::vector<ImportRemark>& remarks() const { return parts_.remarks; }
  const LaneGraph& graph() const { return graph_; }
  const RoadMapParts& parts() const { return parts_; }

  /// Lane by its unique name ("12/0/-1").
  std::optional<LaneId> find_lane(std::string_view name) const;

  /// Lanes within `radius_m` of the point, nearest first (inside: by |d|), ties by id.
  /// @param only_drivable  leave out sidewalks, borders and the like.
  std::vector<LaneMatch> locate(const Eigen::Vector2d& point_in_map, double radius_m,
                                bool only_drivable) const;

  /// Whether the point is on road surface (`is_surface` lanes), or at most `margin_m` off it.
  bool on_surface(const Eigen::Vector2d& point_in_map, double margin_m) const;

 private:
  struct Index;
  RoadMapParts parts_;
  LaneGraph graph_;
  std::unique_ptr<const Index> index_;
};

}  // namespace roadbed::map
