#include "roadbed/planning/lateral/candidate_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roadbed::planning::inline lateral {

CandidateSearch::CandidateSearch(std::size_t offset_count, std::vector<double> least_cost,
                                 MakeBatch make_batch, bool evaluate_all)
    : batches_(least_cost.size()),
      offset_count_(offset_count),
      least_cost_(std::move(least_cost)),
      make_batch_(std::move(make_batch)),
      cost_(batches_.size() * offset_count),
      limits_(cost_.size(), Rejection::none),
      rejection_(cost_.size(), Rejection::none),
      is_evaluated_(batches_.size() * blocks()) {
  for (std::size_t batch = 0; evaluate_all && batch < batches_.size(); ++batch) {
    make(batch);
    for (std::size_t block = 0; block < blocks(); ++block) evaluate(batch, block);
  }
  restart({0, offset_count});
}

// A heap keeps the largest in front, so "less" means later. Batches and blocks come before
// candidates of the same cost: they may hold one that is equal.
bool CandidateSearch::is_later(const Entry& a, const Entry& b) {
  return a.cost != b.cost ? a.cost > b.cost : a.kind > b.kind;
}

void CandidateSearch::push(const Entry& entry) {
  heap_.push_back(entry);
  if (is_heap_) std::ranges::push_heap(heap_, is_later);
}

void CandidateSearch::make(std::size_t batch) { batches_[batch].emplace(make_batch_(batch)); }

void CandidateSearch::set_on_road(const OnRoad& on_road) {
  for (std::size_t batch = 0; batch < batches_.size(); ++batch) {
    if (batches_[batch]) batches_[batch]->set_on_road(on_road(batch));
  }
}

void CandidateSearch::restart(const OffsetIndexRange& offsets) {
  asked_ = offsets;
  heap_.clear();
  is_heap_ = false;
  std::ranges::fill(rejection_, Rejection::none);
  for (std::size_t batch = 0; batch < batches_.size(); ++batch) {
    if (batches_[batch]) {
      enter_batch(batch);
    } else {
      push({least_cost_[batch], Kind::batch, batch * offset_count_});
    }
  }
}

void CandidateSearch::enter_batch(std::size_t batch) {
  for (std::size_t block = 0; block < blocks(); ++block) {
    if (asked_in(batch, block).count > 0) enter_block(batch, block);
  }
}

// The offsets of a block that are asked for.
OffsetIndexRange CandidateSearch::asked_in(std::size_t batch, std::size_t block) const {
  const std::size_t first = batches_[batch]->first_offset(block),
                    end = first + batches_[batch]->offsets_in(block);
  const std::size_t from = std::max(first, asked_.first);
  const std::size_t to = std::min(end, asked_.first + asked_.count);
  return {from, to > from ? to - from : 0};
}

void CandidateSearch::evaluate(std::size_t batch, std::size_t block) {
  const std::size_t first = batch * offset_count_ + batches_[batch]->first_offset(block);
  const std::size_t count = batches_[batch]->offsets_in(block);
  batches_[batch]->evaluate(block, std::span(cost_).subspan(first, count),
                            std::span(limits_).subspan(first, count));
  evaluated_ += count;
  is_evaluated_[batch * blocks() + block] = true;
}

void CandidateSearch::enter_block(std::size_t batch, std::size_t block) {
  if (is_evaluated_[batch * blocks() + block]) return enter_candidates(batch, block);
  const double bound = batches_[batch]->bound(block);
  if (std::isfinite(bound)) {
    push({bound, Kind::block, batch * offset_count_ + batches_[batch]->first_offset(block)});
  } else {
    rejects_block(batch, block, [](std::size_t) { return Rejection::none; });
  }
}

void CandidateSearch::enter_candidates(std::size_t batch, std::size_t block) {
  const OffsetIndexRange asked = asked_in(batch, block);
  for (std::size_t offset = asked.first; offset < asked.first + asked.count; ++offset) {
    const std::size_t index = batch * offset_count_ + offset;
    const Rejection first = batches_[batch]->first_verdict(offset);
    rejection_[index] = first != Rejection::none ? first : limits_[index];
    if (rejection_[index] != Rejection::none) continue;
    push({cost_[index], Kind::candidate, index});
  }
}

bool CandidateSearch::rejects_block(std::size_t batch, std::size_t block, const Known& known) {
  const OffsetIndexRange asked = asked_in(batch, block);
  for (std::size_t offset = asked.first; offset < asked.first + asked.count; ++offset) {
    const std::size_t index = batch * offset_count_ + offset;
    const Rejection first = batches_[batch]->first_verdict(offset);
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
  const std::size_t batch = entry.index / offset_count_,
                    block = entry.index % offset_count_ / kSimdWidth;
  if (entry.kind == Kind::batch) {
    make(batch);
    enter_batch(batch);
    return entry;
  }
  if (rejects_block(batch, block, known)) return entry;
  evaluate(batch, block);
  enter_candidates(batch, block);
  return entry;
}

// The kernel sums in another order than the single evaluation, so that costs that are equal by
// design differ in their last digits. All within that are handed out together: who asks chooses by
// `is_preferred`, never by rounding.
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
