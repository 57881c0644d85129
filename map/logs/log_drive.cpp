#include "roadbed/map/logs/log_drive.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/logs/foxglove_poses.h"
#include "roadbed/map/logs/foxglove_schemas.h"

namespace roadbed::map::inline logs {
namespace {

constexpr const char* kBody = "base_link";

/// The frame of the vehicle, of whose name there may be one in a namespace.
std::optional<std::string> body_of(const TransformTree& tree) {
  if (tree.has(kBody)) return kBody;
  std::vector<std::string> names = tree.children();
  std::erase_if(names, [](const auto& name) { return !name.ends_with(fmt::format("/{}", kBody)); });
  if (names.size() == 1) return names.front();
  constexpr const char* on_ground = "base_footprint";
  return tree.has(on_ground) ? std::optional<std::string>(on_ground) : std::nullopt;
}

/// "/planning/trajectory#3"
struct AskedTopic {
  std::string name;
  std::size_t number = 0;  ///< of the message, from 1; 0: the only one
};

AskedTopic asked_topic(const std::string& text) {
  const std::size_t sign = text.rfind('#');
  AskedTopic asked{text};
  if (sign == std::string::npos) return asked;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + sign + 1, end, asked.number);
  if (error == std::errc() && stop == end) asked.name = text.substr(0, sign);
  return asked;
}

/// What a topic may be a drive of.
struct Candidate {
  std::vector<TimedPose> poses;
  std::vector<geometry::TrajectoryPoint> rows;
  std::vector<std::string> notes;
  std::size_t planned = 0;   ///< trajectories, of which one is kept
  bool is_of_poses = false;  ///< one pose a message, placed once it is chosen
};

class DriveSearch {
 public:
  DriveSearch(std::string file, const std::string& topic, std::string option, DriveFrame frame)
      : file_(std::move(file)),
        option_(std::move(option)),
        asked_(asked_topic(topic)),
        frame_(frame),
        poses_(file_, asked_.name, option_) {}

  LogVisitor visitor() {
    return {
        .wants = [this](const LogTopic& topic) { return wants(topic); },
        .take = [this](const LogTopic& topic, const LogMessage& message) { take(topic, message); }};
  }

  LogDrive result() {
    poses_.finish();
    add_transforms();
    for (const std::string& name : poses_.pose_topics()) candidates_[name].is_of_poses = true;
    if (!asked_.name.empty()) keep_asked(candidates_, asked_.name);
    keep_rows();
    for (const auto& [name, candidate] : candidates_) check_number(name, candidate.planned);
    std::erase_if(candidates_, [](const auto& entry) {
      const Candidate& candidate = entry.second;
      return !candidate.is_of_poses && candidate.poses.empty() && candidate.rows.empty();
    });
    if (candidates_.empty()) {
      refuse(fmt::format("holds no drive{}: topics {}",
                         asked_.name.empty() ? "" : " of topic " + asked_.name,
                         fmt::join(topics_, ", ")),
             "poses, transforms of base_link, or a planned trajectory", "name another log");
    }
    if (candidates_.size() > 1) {
      std::vector<std::string> names;
      for (const auto& [name, candidate] : candidates_) names.push_back(name);
      refuse(fmt::format("holds several drives: {}", fmt::join(names, ", ")), "one",
             "choose it by " + option_);
    }
    auto& [name, candidate] = *candidates_.begin();
    if (asked_.number == 0) check_is_one(name, candidate.planned);
    if (candidate.is_of_poses) take_noted(poses_.drive_by(name, frame_), candidate);
    if (candidate.poses.empty() && !candidate.notes.empty()) {
      refuse(name + ": " + candidate.notes.front(), "transforms at the time of a pose",
             "name another topic");
    }
    return {name, std::move(candidate.poses), std::move(candidate.rows), std::move(candidate.notes),
            candidate.planned > 0};
  }

 private:
  [[noreturn]] void refuse(const std::string& found, const std::string& needed,
                           const std::string& remedy) const {
    throw InputError({.file = file_, .found = found, .needed = needed, .remedy = remedy});
  }

  void check_number(const std::string& topic, std::size_t planned) const {
    if (planned == 0 || asked_.number <= planned) return;
    refuse_planned(topic, planned, fmt::format("at least {}", asked_.number));
  }
  void check_is_one(const std::string& topic, std::size_t planned) const {
    if (planned > 1) refuse_planned(topic, planned, "one");
  }
  [[noreturn]] void refuse_planned(const std::string& topic, std::size_t planned,
                                   const std::string& needed) const {
    refuse(fmt::format("{} holds {} trajectories", topic, planned), needed,
           fmt::format("choose one by its number: {} {}#{}", option_, topic, planned));
  }

  bool wants(const LogTopic& topic) {
    topics_.push_back(fmt::format("{} ({})", topic.name, topic.type));
    const bool is_known = is_pose_type(topic.type) || is_transform_type(topic.type) ||
                          is_trajectory_type(topic.type) || topic.type == kDriveStateType;
    if (!is_known) return false;
    // Transforms go with the topic that is asked for.
    if (!asked_.name.empty() && !is_asked_as(topic.name, asked_.name)) {
      return is_transform_type(topic.type) && poses_.wants(topic);
    }
    const std::string needed(encoding_of(topic.type));
    if (topic.encoding == needed) return true;
    if (needed == "protobuf") return false;  // as JSON or FlatBuffers
    refuse(fmt::format("{} is encoded as {}", topic.name, topic.encoding), needed,
           "convert the log to ROS 2");
  }

  void take(const LogTopic& topic, const LogMessage& message) {
    if (is_transform_type(topic.type) || is_pose_type(topic.type)) {
      return poses_.take(topic, message);
    }
    Candidate& candidate = candidates_[topic.name];
    if (topic.type == kDriveStateType) {
      candidate.rows.push_back(parse_drive_state(topic, message, file_));
      return;
    }
    if (is_trajectory_type(topic.type)) {
      ++candidate.planned;
      const std::size_t kept = asked_.number == 0 ? 1 : asked_.number;
      if (candidate.planned == kept)
        take_noted(timed(parse_planned(message, file_).points), candidate);
    }
  }

  static void take_noted(NotedPoses found, Candidate& candidate) {
    candidate.poses = std::move(found.poses);
    candidate.notes = std::move(found.notes);
  }

  // Rows say all of the drive that other topics say in part.
  void keep_rows() {
    const auto has_rows = [](const auto& entry) { return !entry.second.rows.empty(); };
    if (!asked_.name.empty() || std::ranges::count_if(candidates_, has_rows) != 1) return;
    std::erase_if(candidates_, [&](const auto& entry) { return !has_rows(entry); });
  }

  void add_transforms() {
    if (poses_.transforms() == nullptr) return;
    for (const auto& [topic, tree] : poses_.transforms()->trees()) {
      if (const auto body = body_of(*tree)) {
        const std::vector<std::string> way = tree->way_up(*body, file_, option_);
        take_noted(tree->poses(way), candidates_[tree->topic_of(way)]);
      } else if (!asked_.name.empty()) {
        refuse(fmt::format("{} has the frames {}", topic, fmt::join(tree->children(), ", ")), kBody,
               "name a topic of poses");
      }
    }
  }

  // Planners often leave the times 0: they follow from the way and the speeds.
  NotedPoses timed(std::vector<TimedPose> points) const {
    if (points.size() < 2 || points.back().stamp_ns != points.front().stamp_ns) return {points};
    std::vector<std::string> notes;
    double t_s = 0.0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      const Eigen::Vector3d step = points[i].pose.translation() - points[i - 1].pose.translation();
      const double both_mps =
          std::abs(points[i].speed_mps.value_or(0)) + std::abs(points[i - 1].speed_mps.value_or(0));
      constexpr double stands_mps = 1e-3;
      if (!(both_mps > stands_mps)) {  // it stands from here on
        notes.push_back(fmt::format(
            "{} of {} points left out: their speeds are 0, so nothing says when it is there",
            points.size() - i, points.size()));
        points.resize(i);
        break;
      }
      t_s += 2.0 * step.norm() / both_mps;
      constexpr double longest_s = 1e9;  // 30 years
      if (t_s > longest_s)
        refuse(fmt::format("a trajectory of {:g} s", t_s), "a drive", "plan anew");
      points[i].stamp_ns = std::llround(1e9 * t_s);
    }
    sort_by_stamp(points);
    return {std::move(points), std::move(notes)};
  }

  std::string file_, option_;
  AskedTopic asked_;
  std::vector<std::string> topics_;
  std::map<std::string, Candidate> candidates_;
  DriveFrame frame_;
  LogPoses poses_;
};

}  // namespace

LogDrive drive_of_log(const GoThrough& go_through, const std::string& file,
                      const std::string& topic, const std::string& option, DriveFrame frame) {
  DriveSearch search(file, topic, option, frame);
  go_through(search.visitor());
  return search.result();
}

LogDrive drive_of_log(const std::filesystem::path& path, const std::string& topic,
                      const std::string& option, DriveFrame frame) {
  return drive_of_log([&](const LogVisitor& visitor) { read_log(path, visitor); }, input_name(path),
                      topic, option, frame);
}

}  // namespace roadbed::map::logs
