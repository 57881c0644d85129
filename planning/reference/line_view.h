#pragma once

#include <functional>
#include <utility>

#include "roadbed/planning/reference/reference_line.h"

namespace roadbed::planning::inline reference {

/// What lateral planning asks of a reference line: its geometry and the room beside it. Made from
/// a ReferenceLine, or from any two functions, such as those of an analytic line.
class LineView {
 public:
  LineView(const ReferenceLine& line)  // NOLINT: a ReferenceLine may stand for its view
      : at_([line](double s_m) { return line.at(s_m); }),
        corridor_at_([line](double s_m) { return line.corridor_at(s_m); }) {}
  LineView(std::function<ReferencePoint(double)> at, std::function<Corridor(double)> corridor_at)
      : at_(std::move(at)), corridor_at_(std::move(corridor_at)) {}

  ReferencePoint at(double s_m) const { return at_(s_m); }
  Corridor corridor_at(double s_m) const { return corridor_at_(s_m); }

 private:
  std::function<ReferencePoint(double)> at_;
  std::function<Corridor(double)> corridor_at_;
};

}  // namespace roadbed::planning::reference
