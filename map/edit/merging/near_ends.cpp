#include "roadbed/map/edit/merging/near_ends.h"

#include <fmt/format.h>

#include <algorithm>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline edit::inline merging {
namespace {

constexpr std::size_t kStepsOfPair = 32;  // it takes memory, too

std::vector<geometry::Box> boxes_of(const std::vector<Eigen::Vector2d>& ends) {
  std::vector<geometry::Box> boxes;
  boxes.reserve(ends.size());
  for (const Eigen::Vector2d& end : ends) boxes.emplace_back(end);
  return boxes;
}

}  // namespace

NearEnds::NearEnds(const std::vector<Eigen::Vector2d>& ends, double tolerance_m)
    : size_(ends.size()),
      tolerance_m_(tolerance_m),
      tree_(boxes_of(ends)),
      steps_(geometry::most_steps(ends.size())) {}

std::vector<std::size_t> NearEnds::around(const Eigen::Vector2d& place) {
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(tolerance_m_);
  std::vector<std::size_t> found;
  tree_.visit(geometry::Box(place - reach, place + reach), [&](std::size_t i) {
    if (steps_.spend(1)) found.push_back(i);
  });
  spend(0);
  std::sort(found.begin(), found.end());
  return found;
}

void NearEnds::add_pair() { spend(kStepsOfPair); }

void NearEnds::spend(std::size_t steps) {
  if (steps_.spend(steps)) return;
  throw InputError(
      {.file = "merge",
       .found = fmt::format("{} free ends, too many of which lie on each other", size_),
       .needed = "a few at most that meet in one place",
       .remedy = "leave repeated roads or lanelets out, or give a smaller --tolerance"});
}

}  // namespace roadbed::map::edit::merging
