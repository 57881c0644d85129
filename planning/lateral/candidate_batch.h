#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "roadbed/planning/lateral/batch_sample.h"

namespace roadbed::planning::inline lateral {

/// All candidates of one length, with the work at a station shared by all of them: the same costs
/// (to rounding) and verdicts as cost_terms() and judge() of each one. Offsets come in blocks, and
/// what a block costs at least is known before it is evaluated.
class CandidateBatch {
 public:
  /// @param points  one per station; the batch fills them, and needs them as long as it is asked.
  CandidateBatch(const std::vector<Station>& stations, const QuinticFamily& family,
                 const BatchConfig& config, std::span<KernelPoint> points);

  std::size_t blocks() const { return bounds_.size(); }
  std::size_t first_offset(std::size_t block) const { return block * kSimdWidth; }
  std::size_t offsets_in(std::size_t block) const {
    return std::min(kSimdWidth, config_.end_d_m.size() - first_offset(block));
  }

  /// No candidate of the block that can be driven costs less; infinite if every offset leaves the
  /// road or is folded. README.md, eq. B.
  double bound(std::size_t block) const { return bounds_[block]; }

  /// Cost and verdict of a block's offsets, the road left out; a cost is meaningless where folded.
  /// @pre both spans have offsets_in(block) elements
  void evaluate(std::size_t block, std::span<double> cost, std::span<Rejection> rejection) const;

  /// The verdict of an offset as far as it is known without looking at curvature.
  Rejection first_verdict(std::size_t offset) const;

  /// Another road than the stations have; bounds change with it.
  void set_on_road(const OffsetInterval& on_road);

 private:
  // T of a candidate is at least that of its part along the line: linear in d_e.
  struct LeastDuration {
    double at_zero_s = 0.0, per_unit_s = 0.0;
    double at(double e) const { return at_zero_s + e * per_unit_s; }
  };

  static LeastDuration least_duration(const std::vector<BatchSample>& batch,
                                      std::span<const KernelPoint> points);
  double time_cost(double duration_s) const;
  void bound_curvature();

  BatchConfig config_;
  std::span<const KernelPoint> points_;
  EndOffsetQuadratic closed_form_;
  LeastDuration least_duration_;
  OffsetInterval on_road_, unfolded_;
  std::vector<Quartic> curvature_;  // what it costs at least, one per block
  std::vector<double> bounds_;      // one per block
};

/// Cost and verdict of every candidate of one length.
struct BatchCosts {
  std::vector<double> cost;          ///< one per offset; meaningless where folded or off the road
  std::vector<Rejection> rejection;  ///< as judge() finds it
};

/// Every block of a batch evaluated.
BatchCosts evaluate_batch(const std::vector<Station>& stations, const QuinticFamily& family,
                          const BatchConfig& config);

}  // namespace roadbed::planning::lateral
