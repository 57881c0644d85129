#include "roadbed/planning/lateral/candidate_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roadbed::planning::inline lateral {

CandidateSearch::CandidateSearch(std::size_t lanes, std::vector<double> least_cost,
                                 MakeRow make_row, bool evaluate_all)
    : rows_(least_cost.size()),
      lanes_(lanes),
      least_cost_(std::move(least_cost)),
      make_row_(std::move(make_row)),
      cost_(rows_.size() * lanes),
      limits_(cost_.size(), Rejection::none),
      rejection_(cost_.size(), Rejection::none),
      is_evaluated_(rows_.size() * blocks()) {
  for (std::size_t row = 0; evaluate_all && row < rows_.size(); ++row) {
    make(row);
    for (std::size_t block = 0; block < blocks(); ++block) evaluate(row, block);
  }
  restart({0, lanes});
}

// A heap keeps the largest in front, so "less" means later. Rows and blocks come before candidates
// of the same cost: they may hold one that is equal.
bool CandidateSearch::is_later(const Entry& a, const Entry& b) {
  return a.cost != b.cost ? a.cost > b.cost : a.kind > b.kind;
}

void CandidateSearch::push(const Entry& entry) {
  heap_.push_back(entry);
  if (is_heap_) std::ranges::push_heap(heap_, is_later);
}

void CandidateSearch::make(std::size_t row) { rows_[row].emplace(make_row_(row)); }

void CandidateSearch::set_on_road(const OnRoad& on_road) {
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    if (rows_[row]) rows_[row]->set_on_road(on_road(row));
  }
}

void CandidateSearch::restart(const LaneRange& lanes) {
  asked_ = lanes;
  heap_.clear();
  is_heap_ = false;
  std::ranges::fill(rejection_, Rejection::none);
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    if (rows_[row]) {
      enter_row(row);
    } else {
      push({least_cost_[row], Kind::row, row * lanes_});
    }
  }
}

void CandidateSearch::enter_row(std::size_t row) {
  for (std::size_t block = 0; block < blocks(); ++block) {
    if (asked_in(row, block).count > 0) enter_block(row, block);
  }
}

// The lanes of a block that are asked for.
LaneRange CandidateSearch::asked_in(std::size_t row, std::size_t block) const {
  const std::size_t first = rows_[row]->first_lane(block),
                    end = first + rows_[row]->lanes_in(block);
  const std::size_t from = std::max(first, asked_.first);
  const std::size_t to = std::min(end, asked_.first + asked_.count);
  return {from, to > from ? to - from : 0};
}

void CandidateSearch::evaluate(std::size_t row, std::size_t block) {
  const std::size_t first = row * lanes_ + rows_[row]->first_lane(block);
  const std::size_t count = rows_[row]->lanes_in(block);
  rows_[row]->evaluate(block, std::span(cost_).subspan(first, count),
                       std::span(limits_).subspan(first, count));
  evaluated_ += count;
  is_evaluated_[row * blocks() + block] = true;
}

void CandidateSearch::enter_block(std::size_t row, std::size_t block) {
  if (is_evaluated_[row * blocks() + block]) return enter_candidates(row, block);
  const double bound = rows_[row]->bound(block);
  if (std::isfinite(bound)) {
    push({bound, Kind::block, row * lanes_ + rows_[row]->first_lane(block)});
  } else {
    rejects_block(row, block, [](std::size_t) { return Rejection::none; });
  }
}

void CandidateSearch::enter_candidates(std::size_t row, std::size_t block) {
  const LaneRange asked = asked_in(row, block);
  for (std::size_t lane = asked.first; lane < asked.first + asked.count; ++lane) {
    const std::size_t index = row * lanes_ + lane;
    const Rejection first = rows_[row]->first_verdict(lane);
    rejection_[index] = first != Rejection::none ? first : limits_[index];
    if (rejection_[index] != Rejection::none) continue;
    push({cost_[index], Kind::candidate, index});
  }
}

bool CandidateSearch::rejects_block(std::size_t row, std::size_t block, const Known& known) {
  const LaneRange asked = asked_in(row, block);
  for (std::size_t lane = asked.first; lane < asked.first + asked.count; ++lane) {
    const std::size_t index = row * lanes_ + lane;
    const Rejection first = rows_[row]->first_verdict(lane);
    rejection_[index] = first != Rejection::none ? first : known(index);
    if (rejection_[index] == Rejection::none) return false;
  }
  return true;
}

CandidateSearch::Entry CandidateSearch::pop(const Known& known) {
  std::ranges::pop_heap(heap_, is_later);
  const Entry entry = heap_.back();
  heap_.pop_back();
  if (entry.kind == Kind::candidate) return entry;
  const std::size_t row = entry.index / lanes_, block = entry.index % lanes_ / kLanesPerBlock;
  if (entry.kind == Kind::row) {
    make(row);
    enter_row(row);
    return entry;
  }
  if (rejects_block(row, block, known)) return entry;
  evaluate(row, block);
  enter_candidates(row, block);
  return entry;
}

std::vector<std::size_t> CandidateSearch::pop_equals(const Known& known) {
  if (!is_heap_) std::ranges::make_heap(heap_, is_later);
  is_heap_ = true;
  std::vector<std::size_t> equals;
  double limit = 0.0;
  while (!heap_.empty() && (equals.empty() || heap_.front().cost <= limit)) {
    const Entry entry = pop(known);
    if (entry.kind != Kind::candidate) continue;
    if (equals.empty()) limit = entry.cost * (1.0 + kEqualCost);
    equals.push_back(entry.index);
  }
  return equals;
}

}  // namespace roadbed::planning::lateral
