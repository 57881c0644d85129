#include "roadbed/tools/audit/obstacle_finder.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "roadbed/map/files/in_threads.h"
#include "roadbed/map/files/input_error.h"

namespace roadbed::tools::inline audit {

double CloudClock::time_s(const map::PointCloud& cloud) {
  const double before_s = time_s_;
  time_s_ = cloud.stamp_ns ? since_start_s(cloud) : period_s_ * static_cast<double>(count_);
  if (count_++ == 0 || time_s_ > before_s) return time_s_;
  throw map::InputError(
      {.file = cloud.name,
       .element = "time",
       .found = fmt::format("{} s does not come after {} s of the cloud before", time_s_, before_s),
       .needed = "clouds in the order in which they were measured",
       .remedy = "sort them, and give each once"});
}

double CloudClock::since_start_s(const map::PointCloud& cloud) {
  if (cloud.drive_start_ns) start_ns_ = cloud.drive_start_ns;
  if (!start_ns_) start_ns_ = start_of_log_();
  if (!start_ns_) start_ns_ = cloud.stamp_ns;
  return 1e-9 * static_cast<double>(*cloud.stamp_ns - *start_ns_);
}

ObstacleFinder::ObstacleFinder(const map::ObjectOptions& options, CloudClock clock, int threads)
    : options_(options), clock_(std::move(clock)), threads_(std::max(1, threads)) {}

void ObstacleFinder::take(map::PointCloud cloud) {
  ++clouds_;
  points_ += cloud.points.size();
  waiting_.push_back(std::move(cloud));
  if (std::cmp_equal(waiting_.size(), threads_)) find_in_waiting();
}

std::vector<planning::ObstacleInSource> ObstacleFinder::obstacles() {
  find_in_waiting();
  return follower_.obstacles();
}

void ObstacleFinder::find_in_waiting() {
  std::vector<std::vector<map::FoundObject>> found(waiting_.size());
  map::in_threads(waiting_.size(), threads_,
                  [&](std::size_t i) { found[i] = map::find_objects(waiting_[i], options_); });
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    std::vector<geometry::Rectangle> boxes;
    for (const map::FoundObject& object : found[i]) boxes.push_back(object.box);
    follower_.observe(clock_.time_s(waiting_[i]), boxes);
  }
  waiting_.clear();
}

}  // namespace roadbed::tools::audit
