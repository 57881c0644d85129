#include "roadbed/planning/candidate_queue.h"

#include <algorithm>

namespace roadbed::planning {
namespace {

// A heap keeps the largest in front, so "less" means dearer.
struct Dearer {
  const std::vector<double>& cost;
  bool operator()(std::size_t a, std::size_t b) const { return cost[a] > cost[b]; }
};

}  // namespace

CandidateQueue::CandidateQueue(const std::vector<double>& cost,
                               const std::vector<Rejection>& rejection)
    : cost_(cost) {
  heap_.reserve(cost.size());
  for (std::size_t i = 0; i < cost.size(); ++i) {
    if (rejection[i] == Rejection::none) heap_.push_back(i);
  }
  std::ranges::make_heap(heap_, Dearer{cost_});
}

std::vector<std::size_t> CandidateQueue::pop_equals() {
  const double limit = cost_[heap_.front()] * (1.0 + kEqualCost);
  std::vector<std::size_t> equals;
  while (!heap_.empty() && cost_[heap_.front()] <= limit) {
    std::ranges::pop_heap(heap_, Dearer{cost_});
    equals.push_back(heap_.back());
    heap_.pop_back();
  }
  return equals;
}

}  // namespace roadbed::planning
