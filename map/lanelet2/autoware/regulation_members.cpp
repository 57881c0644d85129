#include "roadbed/map/lanelet2/autoware/regulation_members.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

namespace roadbed::map::lanelet2::autoware {
namespace {

geometry::Box box_around(const VectorMap& map, const Relation& regulation) {
  geometry::Box box;
  for (const Member& member : regulation.members) {
    if (member.kind == MemberKind::way) {
      const Way* way = map.way(member.id);
      if (way == nullptr) continue;
      for (const std::uint32_t node : way->nodes) {
        box.extend(map.document().nodes[node].in_map.head<2>());
      }
    } else if (member.kind == MemberKind::relation) {
      const Lanelet* lanelet = map.lanelet(member.id);
      if (lanelet != nullptr && lanelet->surface) box.extend(lanelet->surface->box);
    }
  }
  return box;
}

}  // namespace

void check_extent(const VectorMap& map, validation::Report& report, int number,
                  const Relation& regulation, validation::Severity severity) {
  constexpr double kMost_m = 100.0;
  const geometry::Box box = box_around(map, regulation);
  if (box.isEmpty() || box.diagonal().norm() <= kMost_m) return;
  add_issue(report, map, number, regulation,
            fmt::format("its members lie {:.0f} m apart; remove those that belong elsewhere",
                        box.diagonal().norm()))
      .severity = severity;
}

void check_line_types(const VectorMap& map, validation::Report& report, int number,
                      const Relation& regulation, std::string_view role, std::string_view type) {
  for (const Way* line : map.lines(regulation, role)) {
    if (line->type == type) continue;
    add_issue(report, map, number, *line,
              fmt::format("{} {} names it as {} and it is of type \"{}\"; make it {}",
                          regulation.subtype, regulation.id, role, line->type, type));
  }
}

}  // namespace roadbed::map::lanelet2::autoware
