#pragma once

#include <vector>

#include "roadbed/planning/route/route_place.h"
#include "roadbed/planning/route/router.h"

namespace roadbed::planning::inline route {

/// How many other routes are wanted, and how different.
struct AlternativeOptions {
  int count = 3;             ///< routes wanted, with the cheapest
  double most_shared = 0.7;  ///< fraction of a route's length on stretches of any route before it
  double most_cost = 1.5;    ///< times the cheapest route's cost
};

/// A route that differs from those before it.
struct Alternative {
  Route route;
  double shared =
      0.0;  ///< the greatest fraction of its length that it has in common with one before
};

/// The cheapest route, then others that differ from each one before: found by making the lanes of
/// routes found dearer by 40 % a time, until enough are found or 20 searches have been made. None
/// if there is no route. It may be that there is another one that this does not find.
std::vector<Alternative> find_alternatives(Router& router, const RoutePlace& from,
                                           const RoutePlace& to,
                                           const AlternativeOptions& options = {});

/// Fraction of a route's length that lies on stretches of another one.
double shared_length_ratio(const Route& route, const Route& other);

}  // namespace roadbed::planning::route
