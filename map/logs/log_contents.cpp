#include "roadbed/map/logs/log_contents.h"

#include <algorithm>
#include <map>
#include <utility>

namespace roadbed::map::inline logs {
namespace {

TopicContents contents_of(const LogTopic& topic, std::vector<std::int64_t> times_ns) {
  TopicContents contents{.topic = topic, .messages = times_ns.size(), .gaps = {}};
  for (std::size_t i = 1; i < times_ns.size(); ++i) {
    if (times_ns[i] < times_ns[i - 1]) ++contents.backwards;
  }
  if (times_ns.empty()) return contents;
  std::ranges::sort(times_ns);
  contents.first_ns = times_ns.front();
  contents.last_ns = times_ns.back();
  std::int64_t median_ns = 0;
  contents.gaps = gaps_in(times_ns, median_ns);
  if (median_ns > 0) contents.rate_hz = 1e9 / static_cast<double>(median_ns);
  return contents;
}

}  // namespace

std::vector<TopicContents> contents_of_log(const std::filesystem::path& path) {
  return contents_of_log([&](const LogVisitor& visitor) { read_log(path, visitor); });
}

std::vector<TopicContents> contents_of_log(const GoThrough& go_through) {
  std::map<std::pair<std::string, std::string>, std::pair<LogTopic, std::vector<std::int64_t>>>
      seen;
  const auto of = [&](const LogTopic& topic) -> auto& {
    return seen.try_emplace({topic.name, topic.type}, topic, std::vector<std::int64_t>{})
        .first->second.second;
  };
  go_through(
      {.wants =
           [&](const LogTopic& topic) {
             of(topic);
             return true;
           },
       .take = [&](const LogTopic& topic,
                   const LogMessage& message) { of(topic).push_back(message.received_ns); }});
  std::vector<TopicContents> contents;
  for (auto& [name, topic] : seen) {
    contents.push_back(contents_of(topic.first, std::move(topic.second)));
  }
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
