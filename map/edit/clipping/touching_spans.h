#pragma once

#include <algorithm>
#include <vector>

#include "roadbed/map/edit/clipping/region_part.h"

namespace roadbed::map::inline edit::inline clipping {

/// A part of a line of whatever measure.
struct Span {
  double from = 0.0, to = 0.0;
};

/// A part of a region, and on which side of it something lies.
struct PartAndSide {
  RegionPart part;
  Region::Side side;
};

/// Where across something that is measured along by s a region is touched: its ends to within
/// rounding. What is touched only inside a stretch that is short may be missed.
/// @param around    of the region, what is near the whole stretch.
/// @param look      what of that is near the stretch between two s, and the side of all across it:
///                  outside, inside at least in part all along, or border where it is not known.
/// @param is_short  whether a stretch is not halved any more.
/// @param touches   whether a part of the region is touched at s.
/// @param found     in order; one that begins where the last one ends goes on with it.
template <typename Look, typename IsShort, typename Touches>
void touching_spans(const RegionPart& around, double from, double to, const Look& look,
                    const IsShort& is_short, const Touches& touches, std::vector<Span>& found) {
  const auto add = [&](double begin, double end) {
    if (!found.empty() && begin <= found.back().to) {
      found.back().to = std::max(found.back().to, end);
    } else {
      found.push_back({begin, end});
    }
  };
  const auto [part, where] = look(around, from, to);
  if (where == Region::Side::outside) return;
  if (where == Region::Side::inside) return add(from, to);
  if (!is_short(from, to)) {
    const double middle = 0.5 * (from + to);
    touching_spans(part, from, middle, look, is_short, touches, found);
    touching_spans(part, middle, to, look, is_short, touches, found);
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
