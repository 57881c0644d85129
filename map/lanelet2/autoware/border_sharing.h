#pragma once

#include "roadbed/map/lanelet2/autoware/rules.h"

namespace roadbed::map::lanelet2::autoware {

/// Lanelets that lie beside each other and have different border ways. One lies beside another if
/// one of its borders is nowhere further from the other's surface than 5 % of that one's width:
///
///     ════════════ A ════════════
///     ── own border of A ────────   ↕ ≤ 5 %     both lie beside the other: issue 1 for each
///     ── own border of B ────────
///     ════════════ B ════════════
///
/// Where only the smaller ones lie beside the larger, it is not divided as they are: issue 2 for
/// the larger one. Pairs that follow each other, share a border, or overlap by more than 5 % of
/// both (both directions of one road) are as they should be.
void border_sharing(const VectorMap& map, const validation::ValidateOptions& options,
                    validation::Report& report);

}  // namespace roadbed::map::lanelet2::autoware
