#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "roadbed/map/edit/clipping/region_part.h"

namespace roadbed::map::inline edit::inline clipping {

/// A part of a line of whatever measure.
struct Span {
  double from = 0.0, to = 0.0;
};

/// Where across something that is measured along by s a region is touched: its ends to within
/// rounding. What is touched only inside a stretch that is short may be missed.
/// @param around    of the region, what is near the whole stretch.
/// @param box       around the stretch between two s.
/// @param side      of a part of the region that is near such a stretch, all across it: outside,
///                  inside at least in part all along, or border where it is not known.
/// @param is_short  whether a stretch is not halved any more.
/// @param touches   whether a part of the region is touched at s.
/// @param found     in order; one that begins where the last one ends goes on with it.
template <typename Box, typename Side, typename IsShort, typename Touches>
void touching_spans(const RegionPart& around, double from, double to, const Box& box,
                    const Side& side, const IsShort& is_short, const Touches& touches,
                    std::vector<Span>& found) {
  const auto add = [&](double begin, double end) {
    if (!found.empty() && begin <= found.back().to) {
      found.back().to = std::max(found.back().to, end);
    } else {
      found.push_back({begin, end});
    }
  };
  std::optional<RegionPart> nearer;
  if (!around.is_simple()) nearer = around.within(box(from, to));
  const RegionPart& part = nearer ? *nearer : around;
  const Region::Side where = side(part, from, to);
  if (where == Region::Side::outside) return;
  if (where == Region::Side::inside) return add(from, to);
  if (!is_short(from, to)) {
    const double middle = 0.5 * (from + to);
    touching_spans(part, from, middle, box, side, is_short, touches, found);
    touching_spans(part, middle, to, box, side, is_short, touches, found);
    return;
  }
  const bool first = touches(part, from), last = touches(part, to);
  if (first && last) return add(from, to);
  if (!first && !last) return;
  double inside = first ? from : to, outside = first ? to : from;
  for (;;) {
    const double between = 0.5 * (inside + outside);
    if (between == inside || between == outside) break;
    (touches(part, between) ? inside : outside) = between;
  }
  first ? add(from, inside) : add(inside, to);
}

}  // namespace roadbed::map::edit::clipping
