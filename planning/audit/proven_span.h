#pragma once

#include <cstddef>

namespace roadbed::planning::inline audit {

/// A part of one segment of a drive, from sample `segment` to the next, and what holds in all of
/// it.
struct ProvenSpan {
  std::size_t segment = 0;
  double from = 0.0, to = 1.0;  ///< fractions of the segment's time
  double at_least_m = 0.0;      ///< no time of the span is nearer to what the proof is about
};

}  // namespace roadbed::planning::audit
