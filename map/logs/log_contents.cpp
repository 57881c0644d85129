#include "roadbed/map/logs/log_contents.h"

#include <algorithm>
#include <map>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/logs/pose_messages.h"

namespace roadbed::map::inline logs {
namespace {

using Times = std::vector<std::int64_t>;

/// What was seen of a topic: when messages came, and with them which frames in which.
struct Seen {
  LogTopic topic;
  Times times_ns = {};
  std::map<std::pair<std::string, std::string>, Times> frames = {};

  void take(const LogMessage& message);
};

void Seen::take(const LogMessage& message) {
  times_ns.push_back(message.received_ns);
  if (!is_transform_type(topic.type) || topic.encoding != encoding_of(topic.type)) return;
  try {
    for (const FrameTransform& transform : parse_transforms(topic, message, "")) {
      frames[{transform.parent, transform.child}].push_back(message.received_ns);
    }
  } catch (const InputError&) {  // of what else the log holds all is said
  }
}

double rate_of(std::int64_t median_ns) {
  return median_ns > 0 ? 1e9 / static_cast<double>(median_ns) : 0.0;
}

std::vector<FrameContents> frames_of(Seen& seen) {
  std::vector<FrameContents> frames;
  for (auto& [names, times_ns] : seen.frames) {
    std::ranges::sort(times_ns);
    std::int64_t median_ns = 0;
    std::vector<LogGap> gaps = gaps_in(times_ns, median_ns);
    frames.push_back(
        {names.first, names.second, times_ns.size(), rate_of(median_ns), std::move(gaps)});
  }
  return frames;
}

TopicContents contents_of(Seen seen) {
  Times& times_ns = seen.times_ns;
  TopicContents contents{.topic = seen.topic, .messages = times_ns.size(), .gaps = {}};
  for (std::size_t i = 1; i < times_ns.size(); ++i) {
    if (times_ns[i] < times_ns[i - 1]) ++contents.backwards;
  }
  if (times_ns.empty()) return contents;
  std::ranges::sort(times_ns);
  contents.first_ns = times_ns.front();
  contents.last_ns = times_ns.back();
  contents.frames = frames_of(seen);
  if (contents.frames.size() > 1) return contents;
  std::int64_t median_ns = 0;
  contents.gaps = gaps_in(times_ns, median_ns);
  contents.rate_hz = rate_of(median_ns);
  return contents;
}

}  // namespace

std::vector<TopicContents> contents_of_log(const std::filesystem::path& path) {
  return contents_of_log([&](const LogVisitor& visitor) { read_log(path, visitor); });
}

std::vector<TopicContents> contents_of_log(const GoThrough& go_through) {
  std::map<std::pair<std::string, std::string>, Seen> seen;
  const auto of = [&](const LogTopic& topic) -> Seen& {
    return seen.try_emplace({topic.name, topic.type}, Seen{.topic = topic}).first->second;
  };
  go_through(
      {.wants =
           [&](const LogTopic& topic) {
             of(topic);
             return true;
           },
       .take = [&](const LogTopic& topic, const LogMessage& message) { of(topic).take(message); }});
  std::vector<TopicContents> contents;
  for (auto& [name, topic] : seen) contents.push_back(contents_of(std::move(topic)));
  return contents;
}

std::vector<LogGap> gaps_in(const std::vector<std::int64_t>& times_ns, std::int64_t& median_ns) {
  median_ns = 0;
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < times_ns.size(); ++i) steps.push_back(times_ns[i] - times_ns[i - 1]);
  if (steps.empty()) return {};
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  median_ns = *middle;
  std::vector<LogGap> gaps;
  for (std::size_t i = 1; i < times_ns.size(); ++i) {
    if ((times_ns[i] - times_ns[i - 1]) / 3 > median_ns) {
      gaps.push_back({times_ns[i - 1], times_ns[i]});
    }
  }
  return gaps;
}

}  // namespace roadbed::map::logs
