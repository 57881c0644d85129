#include "roadbed/map/lanelet2/write/autoware/rights_of_way.h"

#include <utility>
#include <vector>

#include "roadbed/map/lanelet2/autoware/right_of_way.h"

namespace roadbed::map::lanelet2 {

void add_rights_of_way(const WrittenMap& written, LaneletMap& made) {
  const autoware::VectorMap& map = written.map();
  for (const autoware::Lanelet& lanelet : map.lanelets()) {
    if (!lanelet.surface || !autoware::turns_at_lights(lanelet)) continue;
    if (!autoware::regulations_of(lanelet, "right_of_way").empty()) continue;
    std::vector<OsmMember> members{
        {MemberKind::relation, written.relation(lanelet), "right_of_way"}};
    const autoware::Conflicts met =
        autoware::conflicts_of(map, lanelet, [&](const auto& one, const auto& other) {
          return autoware::yields_at_lights(map, one, other);
        });
    if (met.yielding.empty()) continue;  // Lanelet2 does not load an element to which nobody yields
    for (const std::int64_t id : met.yielding) {
      members.push_back({MemberKind::relation, written.relation(*map.lanelet(id)), "yield"});
    }
    const std::uint32_t element = made.osm.add_relation(
        std::move(members), {{"type", "regulatory_element"}, {"subtype", "right_of_way"}});
    made.osm.relations[written.relation(lanelet)].members.push_back(
        {MemberKind::relation, element, "regulatory_element"});
  }
}

}  // namespace roadbed::map::lanelet2
