#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "roadbed/planning/lateral/candidate_evaluator.h"
#include "roadbed/planning/lateral/maneuver_completion.h"

namespace roadbed::planning::inline lateral {

/// What is too expensive to check for every candidate: the corners of the body against the road,
/// collisions, and whether the maneuver can be completed. Candidates are much alike. Where one of
/// them fails is remembered, and checked first for the others, for all offsets of a block together:
/// mostly nothing else has to be checked.
class FeasibilityCheck {
 public:
  /// @param evaluator  kept by reference.
  explicit FeasibilityCheck(CandidateEvaluator& evaluator);

  /// First cause to reject a candidate of those that are checked here.
  Rejection at(std::size_t index);

  /// Whether a candidate that keeps to the road comes too near to something.
  /// @param things  of CollisionChecker::things(); the others are known to be far away.
  bool collides(std::size_t index, const std::vector<std::size_t>& things);

  /// Whether it surely does where others did; `false`: not known.
  bool is_known_to_collide(std::size_t index);

  ManeuverCompletion& completion() { return completion_; }

  /// A cause that a candidate surely fails for, as far as that is remembered: without the cost of
  /// a check. `none`: not known.
  Rejection known(std::size_t index);

 private:
  // Where candidates fail: beside a corridor's edge, or too near to something.
  struct Place {
    double l_m;
    std::optional<Contact> contact;  // none: the edge
    std::vector<std::optional<std::uint8_t>>
        who;  // per block, a bit per offset; none: not looked at
  };

  bool is_among(Place& place, std::size_t index);
  void remember(const CandidateDrive& drive, const Contact& contact);
  void remember(double l_m, const std::optional<Contact>& contact);
  std::optional<double> edge_place_m(const CandidateDrive& drive) const;
  double contact_place_m(const CandidateDrive& drive, const Contact& contact) const;
  std::uint8_t who_fails(const Place& place, std::size_t batch, std::size_t first_offset);
  bool fails(const Place& place, const CandidateBody& at) const;

  CandidateEvaluator& evaluator_;
  ManeuverCompletion completion_;
  std::vector<Place> places_;  // the last one first
};

}  // namespace roadbed::planning::lateral
