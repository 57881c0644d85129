#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/elements/lane_match.h"
#include "roadbed/map/elements/map_content.h"
#include "roadbed/map/storage/lazy_list.h"

namespace roadbed::map::inline index {
struct RoadMapIndex;
}

namespace roadbed::map::inline model {

/// What a map keeps: in a compiled map things are made when they are first touched.
using LazyMapContent = MapContent<LazyList>;

/// A digital road map: what is where and how it connects, whatever the format. Immutable.
///
/// Coordinates ("in_map") are metres relative to `origin_in_source()`, so that they stay small;
/// users see the source's raw coordinates only: tools translate with `to_map` and `to_source`.
class RoadMap {
 public:
  /// @param threads  that may be used.
  /// @throws std::invalid_argument if ids are not in order or a link names nothing.
  explicit RoadMap(RoadMapParts parts, int threads = 1);

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
  Eigen::Vector2d to_map(const Eigen::Vector2d& in_source) const;  ///< from the source's
  Eigen::Vector2d to_source(const Eigen::Vector2d& in_map) const;  ///< to the source's

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
  const LazyList<ImportDiagnostic>& import_diagnostics() const { return content_.remarks; }
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

}  // namespace roadbed::map::model
