#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "roadbed/planning/lateral/candidate_batch.h"

namespace roadbed::planning::inline lateral {

/// Costs that differ by less than this fraction are equal.
inline constexpr double kEqualCost = 1e-12;

/// Indices of the end offsets that are asked for.
struct OffsetIndexRange {
  std::size_t first = 0, count = 0;
};

/// The candidates of a grid that can be driven, the cheapest first. Best first: a heap holds
/// batches and blocks of offsets by what they cost at least, and candidates by what they cost. A
/// batch is made and a block evaluated only when nothing cheaper is left, so the order is that of
/// evaluating everything, for less work; in the worst case, when every candidate is asked for,
/// everything is evaluated once.
class CandidateSearch {
 public:
  /// What is known of a candidate before it is evaluated: why it fails, or `none`.
  using Known = std::function<Rejection(std::size_t index)>;

  using MakeBatch = std::function<CandidateBatch(std::size_t batch)>;
  using OnRoad = std::function<OffsetInterval(std::size_t batch)>;

  /// @param offset_count  of every batch.
  /// @param least_cost  of each batch: none of its candidates costs less.
  /// @param make_batch  is called when the batch is needed, on the road as it is then.
  /// @param evaluate_all  every batch at once, each before the next is made.
  CandidateSearch(std::size_t offset_count, std::vector<double> least_cost, MakeBatch make_batch,
                  bool evaluate_all);

  /// Another road for every batch. To be followed by a restart.
  void set_on_road(const OnRoad& on_road);

  /// Begins anew with some offsets only. What was evaluated is kept.
  void restart(const OffsetIndexRange& offsets);

  /// Takes out the cheapest candidate and all that cost the same, by index with d_e fastest, in no
  /// particular order. Empty: there is none left.
  /// @param known  A block of which every candidate is known to fail is not evaluated: its
  ///               candidates fail for that.
  std::vector<std::size_t> pop_equals(const Known& known);

  /// Of a candidate in an evaluated block.
  double cost(std::size_t index) const { return cost_[index]; }

  /// `none` for candidates that were not looked at. A verdict may be added.
  const std::vector<Rejection>& rejections() const { return rejection_; }
  void reject(std::size_t index, Rejection cause) { rejection_[index] = cause; }

  /// How many candidates were evaluated, of all.
  std::size_t evaluated() const { return evaluated_; }

 private:
  enum class Kind { batch, block, candidate };
  struct Entry {
    double cost;  // of a batch or block: at least
    Kind kind;
    std::size_t index;  // of the candidate, or of the first one
  };
  static bool is_later(const Entry& a, const Entry& b);

  void make(std::size_t batch);
  void push(const Entry& entry);
  void evaluate(std::size_t batch, std::size_t block);
  void enter_batch(std::size_t batch);
  void enter_block(std::size_t batch, std::size_t block);
  OffsetIndexRange asked_in(std::size_t batch, std::size_t block) const;
  void enter_candidates(std::size_t batch, std::size_t block);
  bool rejects_block(std::size_t batch, std::size_t block, const Known& known);
  Entry pop(const Known& known);

  std::size_t blocks() const { return (offset_count_ + kSimdWidth - 1) / kSimdWidth; }

  std::vector<std::optional<CandidateBatch>> batches_;  // those that were needed
  std::size_t offset_count_;
  std::vector<double> least_cost_;
  MakeBatch make_batch_;
  OffsetIndexRange asked_;
  bool is_heap_ = false;
  std::vector<double> cost_;
  std::vector<Rejection> limits_;     // verdicts of evaluate()
  std::vector<Rejection> rejection_;  // with the road, and what was added
  std::vector<bool> is_evaluated_;    // per block
  std::vector<Entry> heap_;
  std::size_t evaluated_ = 0;
};

}  // namespace roadbed::planning::lateral
