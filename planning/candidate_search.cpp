#include "roadbed/planning/candidate_search.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace roadbed::planning {

// A heap keeps the largest in front, so "less" means later. Blocks come before candidates of the
// same cost: they may hold one that is equal.
bool CandidateSearch::is_later(const Entry& a, const Entry& b) {
  return a.cost != b.cost ? a.cost > b.cost : !a.is_block && b.is_block;
}

CandidateSearch::CandidateSearch(std::vector<Row> rows, std::vector<KernelPoint> points,
                                 std::size_t lanes, bool evaluate_all)
    : points_(std::move(points)),
      rows_(std::move(rows)),
      lanes_(lanes),
      cost_(rows_.size() * lanes),
      rejection_(rows_.size() * lanes, Rejection::none) {
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    for (std::size_t block = 0; block < rows_[row].blocks(); ++block) {
      const double bound = rows_[row].bound(block);
      if (evaluate_all) {
        evaluate(row, block);
      } else if (std::isfinite(bound)) {
        heap_.push_back({bound, true, row * lanes_ + rows_[row].first_lane(block)});
      } else {
        reject_block(row, block);
      }
    }
  }
  std::ranges::make_heap(heap_, is_later);
}

void CandidateSearch::evaluate(std::size_t row, std::size_t block) {
  const std::size_t first = row * lanes_ + rows_[row].first_lane(block);
  const std::size_t count = rows_[row].lanes_in(block);
  rows_[row].evaluate(block, std::span(cost_).subspan(first, count),
                      std::span(rejection_).subspan(first, count));
  evaluated_ += count;
  for (std::size_t i = first; i < first + count; ++i) {
    if (rejection_[i] == Rejection::none) heap_.push_back({cost_[i], false, i});
  }
}

void CandidateSearch::reject_block(std::size_t row, std::size_t block) {
  for (std::size_t i = 0; i < rows_[row].lanes_in(block); ++i) {
    const std::size_t lane = rows_[row].first_lane(block) + i;
    rejection_[row * lanes_ + lane] = rows_[row].first_verdict(lane);
  }
}

CandidateSearch::Entry CandidateSearch::pop() {
  std::ranges::pop_heap(heap_, is_later);
  const Entry entry = heap_.back();
  heap_.pop_back();
  if (!entry.is_block) return entry;
  const std::size_t size_before = heap_.size();
  evaluate(entry.index / lanes_, entry.index % lanes_ / kLanesPerBlock);
  for (std::size_t size = size_before + 1; size <= heap_.size(); ++size) {
    std::push_heap(heap_.begin(), heap_.begin() + static_cast<std::ptrdiff_t>(size), is_later);
  }
  return entry;
}

std::vector<std::size_t> CandidateSearch::pop_equals() {
  std::vector<std::size_t> equals;
  double limit = 0.0;
  while (!heap_.empty() && (equals.empty() || heap_.front().cost <= limit)) {
    const Entry entry = pop();
    if (entry.is_block) continue;
    if (equals.empty()) limit = entry.cost * (1.0 + kEqualCost);
    equals.push_back(entry.index);
  }
  return equals;
}

}  // namespace roadbed::planning
