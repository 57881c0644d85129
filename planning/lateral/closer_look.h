#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "roadbed/planning/lateral/cycle.h"
#include "roadbed/planning/lateral/way_on.h"

namespace roadbed::planning::inline lateral {

/// What is too dear to ask of every candidate: the corners of the body, obstacles, and the way on.
/// Candidates are much alike. Where one of them fails is remembered, and looked at first in others,
/// in all lanes of a block together: mostly nothing else has to be looked at.
class CloserLook {
 public:
  /// @param cycle  kept by reference.
  explicit CloserLook(Cycle& cycle);

  /// First cause to reject a candidate of those that are looked at here.
  Rejection at(std::size_t index);

  /// A cause that a candidate surely fails for, as far as that is remembered: without the cost of
  /// a look. `none`: not known.
  Rejection known(std::size_t index);

 private:
  // Where candidates fail: beside a corridor's edge, or too near to something.
  struct Place {
    double l_m;
    std::optional<Contact> contact;                // none: the edge
    std::vector<std::optional<std::uint8_t>> who;  // per block, a bit per lane; none: not looked at
  };

  void remember(double l_m, const std::optional<Contact>& contact);
  std::optional<double> edge_place_m(const CandidateDrive& drive) const;
  double contact_place_m(const CandidateDrive& drive, const Contact& contact) const;
  std::uint8_t who_fails(const Place& place, std::size_t row, std::size_t first_lane);
  bool fails(const Place& place, const CandidateBody& at) const;

  Cycle& cycle_;
  WayOn way_on_;
  std::vector<Place> places_;  // the last one first
};

}  // namespace roadbed::planning::lateral
