#pragma once

#include <cstddef>
#include <vector>

#include "roadbed/planning/row.h"

namespace roadbed::planning {

/// Costs that differ by less than this share are equal.
inline constexpr double kEqualCost = 1e-12;

/// The candidates of a grid that can be driven, the cheapest first. Best first: a heap holds blocks
/// of lanes by what they cost at least, and candidates by what they cost. A block is evaluated only
/// when nothing cheaper is left, so the order is that of evaluating everything, for less work; in
/// the worst case, when every candidate is asked for, everything is evaluated once.
class CandidateSearch {
 public:
  /// @param rows      one per length of the grid, with equal lanes.
  /// @param points    what the rows refer to.
  /// @param evaluate_all  from the start.
  CandidateSearch(std::vector<Row> rows, std::vector<KernelPoint> points, std::size_t lanes,
                  bool evaluate_all);

  /// Takes out the cheapest candidate and all that cost the same, by index with d_e fastest, in no
  /// particular order. Empty: there is none left.
  std::vector<std::size_t> pop_equals();

  /// Of a candidate in an evaluated block.
  double cost(std::size_t index) const { return cost_[index]; }

  /// `none` for candidates that were not looked at. A verdict may be added.
  const std::vector<Rejection>& rejections() const { return rejection_; }
  void reject(std::size_t index, Rejection cause) { rejection_[index] = cause; }

  /// How many candidates were evaluated, of all.
  std::size_t evaluated() const { return evaluated_; }

 private:
  struct Entry {
    double cost;  // of a block: at least
    bool is_block;
    std::size_t index;  // of the candidate, or of the block's first lane
  };
  static bool is_later(const Entry& a, const Entry& b);

  void evaluate(std::size_t row, std::size_t block);
  void reject_block(std::size_t row, std::size_t block);
  Entry pop();

  std::vector<KernelPoint> points_;
  std::vector<Row> rows_;
  std::size_t lanes_;
  std::vector<double> cost_;
  std::vector<Rejection> rejection_;
  std::vector<Entry> heap_;
  std::size_t evaluated_ = 0;
};

}  // namespace roadbed::planning
