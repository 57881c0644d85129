#include "roadbed/tests/support/straight_profile.h"

namespace roadbed::tests {

planning::PathProfile straight_profile(double wanted_mps, double most_mps) {
  planning::PathProfile profile;
  for (int i = 0; i <= 400; ++i) {
    const double ahead_m = 0.5 * i;
    profile.ahead_m.push_back(ahead_m);
    profile.station_m.push_back(ahead_m);
    profile.body.push_back(geometry::body_at({ahead_m, 0.0, 0.0}, {}));
    profile.wanted_mps.push_back(wanted_mps);
    profile.most_mps.push_back(most_mps);
  }
  return profile;
}

}  // namespace roadbed::tests
