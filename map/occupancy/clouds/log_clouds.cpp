#include "roadbed/map/occupancy/clouds/log_clouds.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string_view>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/occupancy/clouds/message_points.h"
#include "roadbed/map/occupancy/clouds/point_time.h"

namespace roadbed::map::inline occupancy::inline clouds {
namespace {

// Frames that stand still [REP 105].
bool is_of_world(std::string_view frame) {
  return frame == "map" || frame == "odom" || frame == "earth" || frame == "world";
}

/// Clouds of one log, and from where each is placed.
class CloudMessages {
 public:
  CloudMessages(const std::string& file, const LogPoses& poses, const CloudFilter& filter,
                const std::function<void(PointCloud)>& use)
      : file_(file), poses_(poses), filter_(filter), use_(use) {}

  void take(const LogTopic& topic, const LogMessage& message) {
    const CloudMessage cloud = parse_cloud(topic, message, file_);
    const MessageFrames& frames = frames_of(cloud.frame);
    MessagePoints read =
        points_of_message(cloud, frames, filter_, file_, topic.name + ", " + message.place);
    if (frames.pose_at && counts_.untaken_time_field.empty()) {
      counts_.untaken_time_field = PointTime::untaken_field(cloud);
    }
    counts_.points_without_pose += read.without_pose;
    counts_.points_with_unlikely_times += read.with_unlikely_times;
    counts_.not_finite += read.cloud.dropped_not_finite;
    counts_.filtered_out += read.cloud.filtered_out;
    if (!read.cloud.points.empty()) {
      ++counts_.clouds;
      read.cloud.name = file_;
      read.cloud.stamp_ns = cloud.stamp_ns;
      read.cloud.is_around_sensor = !frames.pose_at && !is_of_world(cloud.frame);
      use_(std::move(read.cloud));
    } else {
      ++(read.without_pose > 0 ? counts_.without_pose : counts_.without_point);
    }
  }

  const LogCloudCounts& counts() const { return counts_; }

 private:
  const MessageFrames& frames_of(const std::string& frame) {
    const auto known = frames_of_.find(frame);
    if (known != frames_of_.end()) return known->second;
    MessageFrames frames{poses_.of(frame), poses_.in_vehicle(frame)};
    if (!frames.pose_at) counts_.frames_as_they_stand.push_back(frame);
    if (filter_.vehicle_box && !frames.in_vehicle && frame != "base_link") {
      counts_.frames_of_vehicle_box.push_back(frame);
    }
    return frames_of_.emplace(frame, std::move(frames)).first->second;
  }

  const std::string& file_;
  const LogPoses& poses_;
  const CloudFilter& filter_;
  const std::function<void(PointCloud)>& use_;
  std::map<std::string, MessageFrames> frames_of_;
  LogCloudCounts counts_;
};

// Streams and packed files are in memory; what is plain is read piece by piece.
GoThrough through(const std::filesystem::path& log) {
  return [log](const LogVisitor& visitor) { read_log(log, visitor); };
}

}  // namespace

LogClouds::LogClouds(const std::filesystem::path& log, LogCloudTopics topics)
    : LogClouds(through(log), input_name(log), std::move(topics)) {}

LogClouds::LogClouds(GoThrough go_through, const std::string& file, LogCloudTopics topics)
    : go_through_(std::move(go_through)), file_(file), poses_(file, topics.poses) {
  look_through(topics.clouds);
}

void LogClouds::look_through(const std::string& asked) {
  std::vector<std::string> names;
  go_through_({.wants =
                   [&](const LogTopic& topic) {
                     const bool is_cloud = is_cloud_type(topic.type) && topic.encoding == "cdr";
                     if (is_cloud && std::ranges::find(names, topic.name) == names.end()) {
                       names.push_back(topic.name);
                     }
                     return poses_.wants(topic);
                   },
               .take = [&](const LogTopic& topic,
                           const LogMessage& message) { poses_.take(topic, message); }});
  poses_.finish();
  const auto refuse = [&](const std::string& found, const std::string& remedy) {
    throw InputError({.file = file_,
                      .found = found,
                      .needed = "one topic of sensor_msgs/msg/PointCloud2",
                      .remedy = remedy});
  };
  const std::string listed = fmt::format("{}", fmt::join(names, ", "));
  if (names.empty()) refuse("holds no clouds", "name another log; drive info lists its topics");
  if (asked.empty() && names.size() > 1) {
    refuse("holds clouds of several topics: " + listed, "choose it by --topic");
  }
  topic_ = asked.empty() ? names.front() : asked;
  const auto is_there = [&] { return std::ranges::find(names, topic_) != names.end(); };
  if (!is_there()) topic_ = "/" + asked;
  if (!is_there()) {
    refuse(fmt::format("holds no clouds of topic {}, but of {}", asked, listed),
           "choose it by --topic");
  }
}

LogCloudCounts LogClouds::for_each(const std::function<void(PointCloud cloud)>& use,
                                   const CloudFilter& filter) const {
  CloudMessages messages(file_, poses_, filter, use);
  go_through_({.wants =
                   [&](const LogTopic& topic) {
                     return topic.name == topic_ && is_cloud_type(topic.type) &&
                            topic.encoding == "cdr";
                   },
               .take = [&](const LogTopic& topic,
                           const LogMessage& message) { messages.take(topic, message); }});
  const LogCloudCounts& counts = messages.counts();
  if (counts.clouds > 0) return counts;
  throw InputError({.file = file_,
                    .element = topic_,
                    .found = fmt::format("{} messages hold no point, {} lie outside of the poses",
                                         counts.without_point, counts.without_pose),
                    .needed = "at least one finite point",
                    .remedy = "check how the log was recorded"});
}

std::vector<std::string> LogClouds::notes(const LogCloudCounts& counts) const {
  std::vector<std::string> notes;
  const auto note = [&](std::size_t count, const char* text) {
    if (count > 0) notes.push_back(fmt::format("{}: {} {}", topic_, count, text));
  };
  if (!counts.frames_as_they_stand.empty()) {
    notes.push_back(fmt::format("{}: points stand as they are, the log has no poses of {}", topic_,
                                fmt::join(counts.frames_as_they_stand, ", ")));
  }
  if (!counts.frames_of_vehicle_box.empty()) {
    notes.push_back(fmt::format(
        "{}: the vehicle's box counts in {}, as the log does not say where base_link is", topic_,
        fmt::join(counts.frames_of_vehicle_box, ", ")));
  }
  if (!counts.untaken_time_field.empty()) {
    notes.push_back(fmt::format(
        "{}: times of points in a field {} are not taken, as their unit is not known: all count as "
        "measured at their message's stamp",
        topic_, counts.untaken_time_field));
  }
  note(counts.without_point, "messages hold no finite point, or none is left");
  note(counts.without_pose,
       "messages lie before the first pose, after the last or in a gap of them: left out");
  note(counts.points_without_pose,
       "points lie before the first pose, after the last or in a gap of them: left out");
  note(counts.points_with_unlikely_times,
       "points say a time more than 1 s from their message's: taken to be measured at its stamp");
  return notes;
}

}  // namespace roadbed::map::occupancy::clouds
