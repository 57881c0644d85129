#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/logs/log_contents.h"
#include "roadbed/map/logs/pose_messages.h"

namespace roadbed::map::inline logs {

/// Poses, and what users may want to know of them.
struct NotedPoses {
  std::vector<TimedPose> poses = {};
  std::vector<std::string> notes = {};
};

/// "120 of 250 poses left out: no transform from map at their time"; none where none is left out.
std::vector<std::string> left_out_notes(std::size_t left_out, std::size_t all,
                                        const std::string& what_is_missing);

/// Frames that stand in each other, over time:
///
///     map ──▶ odom ──▶ base_link ──▶ lidar      read from the child up
///
class TransformTree {
 public:
  /// @param topic      that says it.
  /// @param is_static  holds for all times.
  void add(const FrameTransform& transform, const std::string& topic, bool is_static);

  /// Puts the poses of each frame in order of time; of several at one time the first stays.
  void sort();

  /// What was said only once, as topics that latch do, holds for all times from here on.
  void hold_what_was_said_once();

  /// Takes the frames from another one that it does not have.
  void merge(TransformTree other);

  /// Goes on in another tree, which is not copied, for frames that this one does not have.
  /// @param but  a frame of it that is none.
  void go_on_in(std::shared_ptr<const TransformTree> further, const std::string& but);

  bool has(const std::string& child) const { return find(child) != nullptr; }

  /// From a frame up to `top`, to `map` or to the uppermost frame: names of the children on the
  /// way.
  /// @param file    and `option`, which chooses a topic, are for messages.
  /// @throws InputError if a frame on it has two parents, they stand in each other in a circle, or
  ///         there are more than 256.
  std::vector<std::string> way_up(const std::string& child, const std::string& file,
                                  const std::string& option, const std::string& top = "map") const;

  /// Where the lowest frame of a way is, in the uppermost: places linear, turns by slerp between
  /// stamps; none before the first, after the last one, and in gaps that are longer than three
  /// median intervals and than 0.25 s.
  std::optional<Eigen::Isometry3d> at(const std::vector<std::string>& way,
                                      std::int64_t stamp_ns) const;

  /// The poses of the lowest frame that moves, at its own stamps and with its speeds, where all
  /// others are known; with a note of those left out.
  NotedPoses poses(const std::vector<std::string>& way) const;

  /// Whether a way leads to where points may be put together: a frame on it moves, or it ends in
  /// `map`.
  bool leads_to_world(const std::vector<std::string>& way) const;

  /// The topic of the lowest frame of a way that moves, else of the lowest.
  /// @pre the way is not empty.
  const std::string& topic_of(const std::vector<std::string>& way) const;

  /// @pre has(child).
  const std::string& parent_of(const std::string& child) const { return edge_of(child).parent; }

  std::vector<std::string> children() const;

 private:
  struct Edge {
    std::string topic, parent, other_parent;  ///< the last: of a frame that is said to have two
    bool is_static = false;
    bool is_held = false;  ///< not static, but said only once
    std::vector<TimedPose> poses;
    std::vector<LogGap> gaps;

    std::optional<Eigen::Isometry3d> at(std::int64_t stamp_ns) const;
  };
  std::vector<std::string>::const_iterator lowest_moving(const std::vector<std::string>& way) const;

  /// Null if there is none.
  const Edge* find(const std::string& child) const;
  /// @pre has(child).
  const Edge& edge_of(const std::string& child) const { return *find(child); }
  std::size_t size() const { return edges_.size() + (further_ ? further_->size() : 0); }

  std::map<std::string, Edge> edges_;
  std::shared_ptr<const TransformTree> further_;
  std::string not_further_;
};

/// The pose at a time between two of a list in order of time; none outside.
std::optional<Eigen::Isometry3d> pose_at(const std::vector<TimedPose>& poses,
                                         std::int64_t stamp_ns);

/// Puts poses in order of time; of several at one time the first stays.
void sort_by_stamp(std::vector<TimedPose>& poses);

}  // namespace roadbed::map::logs
