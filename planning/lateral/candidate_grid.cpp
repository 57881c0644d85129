#include "roadbed/planning/lateral/candidate_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "roadbed/planning/lateral/candidate_fan.h"
#include "roadbed/planning/lateral/feasibility_check.h"
#include "roadbed/planning/lateral/search_by_cost.h"
#include "roadbed/planning/lateral/sure_edges.h"

namespace roadbed::planning::inline lateral {
namespace {

constexpr std::size_t kCoarse = 8;  // points in a section of the fan of all offsets

class GridJudge {
 public:
  GridJudge(CandidateEvaluator& evaluator, const OffsetIndexRange& offsets)
      : evaluator_(evaluator),
        check_(evaluator),
        offsets_(offsets),
        config_(batch_config(evaluator)) {
    const CollisionChecker& collision = evaluator.collision();
    if (collision.is_empty()) return;
    const std::vector<LineStretch> stretches =
        stretches_ahead(evaluator, evaluator.grid().max_l_m(), ends_of(offsets));
    for (const std::size_t thing : collision.things()) {
      const bool is_far = std::ranges::all_of(stretches, [&](const LineStretch& stretch) {
        return collision.keeps_clear(thing, stretch.cover, stretch.from_t_s,
                                     std::numeric_limits<double>::infinity());
      });
      if (!is_far) things_.push_back(thing);
    }
    find_completable(offsets, check_.completion().things());
  }

  /// Costs and verdicts of a batch.
  BatchCosts judge(std::size_t batch) {
    config_.frame = evaluator_.frame(batch);
    costs_ = evaluate_batch(evaluator_.stations(batch), evaluator_.family(batch), config_);
    batch_ = batch;
    drives_ = drives_of(evaluator_, batch);
    check_edges();
    const FanPoints all{0, drives_.points.size() - 1, kCoarse};
    if (!things_.empty()) {
      check_alike();
      check_collisions(offsets_, things_, all);
    }
    check_completion();
    return std::move(costs_);
  }

 private:
  OffsetRange ends_of(const OffsetIndexRange& range) const {
    return {end_d_m(range.first), end_d_m(range.first + range.count - 1)};
  }
  double end_d_m(std::size_t offset) const { return evaluator_.grid().end_d_m()[offset]; }
  std::size_t index(std::size_t offset) const {
    return batch_ * evaluator_.grid().offset_count() + offset;
  }
  bool is_open(std::size_t offset) const { return costs_.rejection[offset] == Rejection::none; }

  void check_edges() {
    const std::size_t last = offsets_.first + offsets_.count - 1;
    const OffsetRange asked{end_d_m(offsets_.first), end_d_m(last)};
    for (std::size_t point = 0; point < drives_.points.size(); ++point) {
      const OffsetInterval sure =
          surely_inside(evaluator_, *drives_.stations[point], drives_.points[point], asked);
      std::size_t left = offsets_.first, right = last + 1;
      for (; left < right && !(end_d_m(left) >= sure.from); ++left) check_edge(left, point);
      for (; right > left && !(end_d_m(right - 1) <= sure.to); --right) {
        check_edge(right - 1, point);
      }
    }
  }

  void check_edge(std::size_t offset, std::size_t point) {
    if (is_open(offset) && leaves_road(offset, point)) {
      costs_.rejection[offset] = Rejection::off_road;
    }
  }

  bool leaves_road(std::size_t offset, std::size_t point) {
    const double e = end_d_m(offset);
    const std::vector<CandidateBody> bodies =
        evaluator_.bodies(batch_, std::span(&e, 1), drives_.stations[point]->l_m, {});
    if (bodies.empty() || !bodies.front().is_there) return false;
    return evaluator_.excess_m(bodies.front()) > kLimitSlack;
  }

  // Most of those that collide do so where others did.
  void check_alike() {
    for (std::size_t i = 0; i < offsets_.count; ++i) {
      const std::size_t offset = offsets_.first + i;
      if (is_open(offset) && check_.is_known_to_collide(index(offset))) {
        costs_.rejection[offset] = Rejection::collision;
      }
    }
  }

  // Of those of the things that some drive of a range of offsets may come near to, and of the
  // points where it may, one range after another, ever smaller.
  void check_collisions(OffsetIndexRange range, std::vector<std::size_t> things,
                        const FanPoints& look_at) {
    while (range.count > 0 && !is_open(range.first)) ++range.first, --range.count;
    while (range.count > 0 && !is_open(range.first + range.count - 1)) --range.count;
    if (range.count == 0) return;
    FanPoints unclear{look_at.last, look_at.first,
                      std::max<std::size_t>(1, look_at.per_section / 2)};
    const auto sections = fan_sections(evaluator_, drives_, ends_of(range), look_at);
    std::erase_if(things, [&](std::size_t thing) { return is_clear(thing, sections, unclear); });
    if (things.empty()) return;
    if (range.count == 1) return check_one(range.first, things);
    const std::size_t half = range.count / 2;
    check_collisions({range.first, half}, things, unclear);
    check_collisions({range.first + half, range.count - half}, std::move(things), unclear);
  }

  // Adds to the points where it is not.
  bool is_clear(std::size_t thing, const std::vector<FanSection>& sections,
                FanPoints& unclear) const {
    bool is_clear = true;
    for (const FanSection& section : sections) {
      if (evaluator_.collision().keeps_clear(thing, section.cover, section.from_t_s,
                                             section.to_t_s)) {
        continue;
      }
      is_clear = false;
      unclear.first = std::min(unclear.first, section.first);
      unclear.last = std::max(unclear.last, section.last);
    }
    return is_clear;
  }

  void check_one(std::size_t offset, const std::vector<std::size_t>& things) {
    if (check_.collides(index(offset), things)) costs_.rejection[offset] = Rejection::collision;
  }

  // Of a range of offsets, or else of its halves.
  void find_completable(const OffsetIndexRange& range, std::vector<std::size_t> things) {
    const double stop_m = check_.completion().stop_m() / least_stretch(evaluator_, ends_of(range));
    const auto stretches = stretches_ahead(evaluator_, stop_m, ends_of(range));
    std::erase_if(things, [&](std::size_t thing) {
      return check_.completion().keeps_clear(thing, stretches);
    });
    if (things.empty() || range.count == 1) {
      is_completable_.insert(is_completable_.end(), range.count, things.empty());
      return;
    }
    const std::size_t half = range.count / 2;
    find_completable({range.first, half}, things);
    find_completable({range.first + half, range.count - half}, std::move(things));
  }

  void check_completion() {
    const double end_l_m = evaluator_.grid().end_l_m()[batch_];
    for (std::size_t i = 0; i < offsets_.count && !is_completable_.empty(); ++i) {
      const std::size_t offset = offsets_.first + i;
      if (!is_open(offset) || is_completable_[i]) continue;
      if (!check_.completion().exists(end_d_m(offset), end_l_m)) {
        costs_.rejection[offset] = Rejection::collision;
      }
    }
  }

  CandidateEvaluator& evaluator_;
  FeasibilityCheck check_;
  OffsetIndexRange offsets_;
  BatchConfig config_;
  std::vector<std::size_t> things_;   ///< that some candidate may come near to
  std::vector<bool> is_completable_;  ///< surely; one per offset, or empty: all are
  std::size_t batch_ = 0;
  BatchDrives drives_;
  BatchCosts costs_;
};

}  // namespace

CandidateGrid judge_grid(CandidateEvaluator& evaluator, const KeptCandidates& kept,
                         std::optional<double> chosen_d_m) {
  const Grid& grid = evaluator.grid();
  const std::span<const double> end_d_m =
      std::span(grid.end_d_m()).subspan(kept.offsets.first, kept.offsets.count);
  CandidateGrid result;
  result.end_d_m.assign(end_d_m.begin(), end_d_m.end());
  GridJudge judge(evaluator, kept.offsets);
  std::size_t runner_up = 0;
  for (std::size_t batch = 0; batch < grid.length_count(); batch += kept.length_stride) {
    const BatchCosts costs = judge.judge(batch);
    result.end_l_m.push_back(grid.end_l_m()[batch]);
    for (std::size_t i = 0; i < kept.offsets.count; ++i) {
      const std::size_t offset = kept.offsets.first + i;
      result.causes.push_back(static_cast<std::uint8_t>(costs.rejection[offset]));
      if (costs.rejection[offset] != Rejection::none || end_d_m[i] == chosen_d_m) continue;
      if (result.runner_up && costs.cost[offset] >= result.runner_up->cost) continue;
      runner_up = batch * grid.offset_count() + offset;
      result.runner_up = {
          .end_d_m = end_d_m[i], .end_l_m = grid.end_l_m()[batch], .cost = costs.cost[offset]};
    }
  }
  if (result.runner_up) result.runner_up->terms = terms_of(evaluator, runner_up);
  return result;
}

}  // namespace roadbed::planning::lateral
