#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/map/model/road_map.h"

namespace roadbed::planning::inline maneuvers {

/// Whether a lane ends beside another one of its direction that goes on and may be changed to.
bool ends_beside(const map::RoadMap& road_map, map::LaneId lane, map::LaneId other);

/// Where lanes end beside one that goes on: poses of their ends, in the map, by LaneId.
std::vector<geometry::Pose2> lane_ends(const map::RoadMap& road_map);

/// Somebody before a lane's end, in that lane or in the one that goes on.
struct ZipBody {
  std::string id;         ///< the same in each step
  double to_end_m = 0.0;  ///< of the front bumper
  double length_m = 0.0;
  double speed_mps = 0.0;
};

/// Merging in turn where a lane ends (German StVO § 7 (4)): who drives in the lane that goes on
/// lets one vehicle in from the lane that ends, immediately before its end, and not two. It follows
/// that one, braking by 2 m/s² at most for it, as SUMO's cooperative lane change asks the follower
/// to open a gap (Erdmann 2015, doi:10.1007/978-3-662-45079-6_7).
///
///     ─────────────────────────────────────────────
///       ▭▶ C2 lets W2 in   ▭▶ C1 lets W1 in    ▭▶
///     ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─╱─────
///                     ▭ W2        ▭ W1      ╱ end
///     ─────────────────────────────────────╱
class ZipMerge {
 public:
  static constexpr double kMostBraking_mps2 = 2.0;
  static constexpr double kInTurn_m = 50.0;     ///< before the end, who waits is let in
  static constexpr double kSeenFrom_m = 100.0;  ///< before the end, who drives on lets in

  /// One step of 0.1 s. The foremost who waits is let in by the nearest behind it who has let in
  /// nobody, and need not brake harder. The turn is over if it is past the other after all, and
  /// when both have stood for 8 s. Who is no more among the drivers is forgotten.
  /// @param drivers  in the lane that goes on, the foremost first.
  /// @param waiting  in the lane that ends, the foremost first.
  void update(std::size_t end, const std::vector<ZipBody>& drivers,
              const std::vector<ZipBody>& waiting);

  /// Whom a driver lets in at an end; none: nobody, or it has.
  std::optional<std::string> let_in(std::size_t end, const std::string& driver) const;

 private:
  struct Turn {
    std::string let_in;
    int stands_for = 0;    ///< steps
    bool is_over = false;  ///< it was in vain
  };
  bool is_let_in(std::size_t end, const std::string& body) const;
  void go_on(Turn& turn, const ZipBody& driver, const ZipBody& waits) const;

  std::map<std::pair<std::size_t, std::string>, Turn> turns_;  ///< by end and driver
};

}  // namespace roadbed::planning::maneuvers
