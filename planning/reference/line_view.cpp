#include "roadbed/planning/reference/line_view.h"

namespace roadbed::planning::inline reference {

LineView::LineView(const ReferenceLine& line)
    : at_([line](double s_m) { return line.at(s_m); }),
      corridor_at_([line](double s_m) { return line.corridor_at(s_m); }) {}

}  // namespace roadbed::planning::reference
