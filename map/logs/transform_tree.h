#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/logs/pose_messages.h"

namespace roadbed::map::inline logs {

/// Frames that stand in each other, over time:
///
///     map ──▶ odom ──▶ base_link ──▶ lidar      read from the child up
///
class TransformTree {
 public:
  /// @param is_static  holds for all times. @throws InputError if a frame gets a second parent.
  void add(const FrameTransform& transform, bool is_static, const std::string& file);

  /// Puts the poses of each frame in order of time; of several at one time the first stays.
  void sort();

  bool has(const std::string& child) const { return edges_.contains(child); }

  /// From a frame up to `map`, or to the uppermost frame: names of the children on the way.
  /// @throws InputError if frames stand in each other in a circle.
  std::vector<std::string> way_up(const std::string& child, const std::string& file) const;

  /// Where the lowest frame of a way is, in the uppermost: places linear, turns by slerp between
  /// stamps; none before the first or after the last one.
  std::optional<Eigen::Isometry3d> at(const std::vector<std::string>& way,
                                      std::int64_t stamp_ns) const;

  /// The poses of the lowest frame that moves, at its own stamps, where all others are known.
  std::vector<TimedPose> poses(const std::vector<std::string>& way) const;

  /// Whether a way leads to where points may be put together: a frame on it moves, or it ends in
  /// `map`.
  bool leads_to_world(const std::vector<std::string>& way) const;

  /// Takes the transforms that hold for all times from another one.
  void add_static_of(const TransformTree& other);

  /// @pre has(child).
  const std::string& parent_of(const std::string& child) const { return edges_.at(child).parent; }

  std::vector<std::string> children() const;

 private:
  struct Edge {
    std::string parent;
    bool is_static = false;
    std::vector<TimedPose> poses;
  };
  std::map<std::string, Edge> edges_;
};

/// The pose at a time between two of a list in order of time; none outside.
std::optional<Eigen::Isometry3d> pose_at(const std::vector<TimedPose>& poses,
                                         std::int64_t stamp_ns);

/// Puts poses in order of time; of several at one time the first stays.
void sort_by_stamp(std::vector<TimedPose>& poses);

}  // namespace roadbed::map::logs
