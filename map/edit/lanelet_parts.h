#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "roadbed/map/edit/row_span.h"

namespace roadbed::map::inline edit {

/// What of a lanelet of CommonRoad is there.
struct LaneletSpan : RowSpan {
  std::string whole;  ///< id of the whole lanelet
};

/// All of a lanelet as it stands.
LaneletSpan all_rows(pugi::xml_node lanelet);

/// What a clip remembers of a lanelet that it cut, `<?roadbed-clip lanelet="7" from="0" to="3.5"
/// rows="9"?>`; none if there is nothing, or something that the lanelet's points do not fit.
std::optional<LaneletSpan> remembered_span(pugi::xml_node lanelet);

/// Remembers that, or nothing where the lanelet is whole.
void remember_span(pugi::xml_node lanelet, const LaneletSpan& span);

/// Puts back the links of lanelets, and the incomings and crossings of intersections, as they were
/// before a clip, `<?roadbed-clip-links <successor ref="9"/>?>`: all name whole lanelets then.
/// @param root  `<commonRoad>`.
void recall_links(pugi::xml_node root);

/// A lanelet, or a part of one.
struct LaneletPart {
  pugi::xml_node node;
  LaneletSpan span;
  std::size_t source = 0;  ///< which file it is from
};

/// What was taken off.
struct LostLinks {
  std::size_t links = 0, incomings = 0;
};

/// Lanelets of a map by the whole that they are parts of, and which of their links hold.
class LaneletParts {
 public:
  void add(LaneletPart part);

  /// Parts of a lanelet from its start on; null if there are none.
  const std::vector<LaneletPart>* of(const std::string& whole) const;

  /// Makes links that name whole lanelets name parts, and takes off and remembers those that lead
  /// to what is not there. Links between lanelets of different files hold if both say so.
  /// @param root  `<commonRoad>`, whose lanelets were added after recall_links().
  /// @param all   what leads nowhere is taken off everywhere, else only where links were recalled.
  LostLinks settle_links(pugi::xml_node root, bool all) const;

 private:
  std::map<std::string, std::vector<LaneletPart>> parts_;
};

}  // namespace roadbed::map::edit
