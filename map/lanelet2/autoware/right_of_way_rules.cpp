#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "roadbed/map/lanelet2/autoware/right_of_way.h"
#include "roadbed/map/lanelet2/autoware/rules.h"

namespace roadbed::map::lanelet2::autoware {
namespace {

using validation::Report;
using validation::ValidateOptions;

/// Of all that are checked by one element; who has to yield to one does not so slightly.
void merge(Conflicts& all, Conflicts more) {
  all.yielding.merge(more.yielding);
  all.slightly.merge(more.slightly);
  for (const std::int64_t id : all.yielding) all.slightly.erase(id);
}

/// Numbers of a rule's issues.
struct Numbers {
  int missing, unnecessary, slight;
  validation::Severity unnecessary_severity = validation::Severity::error;
};

/// Elements, each with the lanelets that have the right of way by it and that a rule looks at.
using Elements = std::map<const Relation*, std::vector<const Lanelet*>>;

void check_element(const VectorMap& map, Report& report, const Relation& element,
                   const std::vector<const Lanelet*>& lanelets, const MustYield& must_yield,
                   const Numbers& numbers) {
  Conflicts met, of_all;
  for (const Lanelet* lanelet : lanelets) merge(met, conflicts_of(map, *lanelet, must_yield));
  for (const Lanelet* lanelet : map.lanelets(element, "right_of_way")) {
    merge(of_all, conflicts_of(map, *lanelet, must_yield));
  }
  if (map.budget().is_spent()) return;
  std::set<std::int64_t> named;
  for (const Lanelet* lanelet : map.lanelets(element, "yield")) named.insert(lanelet->id());
  for (const std::int64_t id : met.yielding) {
    if (named.contains(id)) continue;
    add_issue(
        report, map, numbers.missing, element,
        fmt::format("lanelet {} meets one with the right of way and does not yield; add it as "
                    "member \"yield\"",
                    id));
  }
  for (const std::int64_t id : named) {
    if (of_all.yielding.contains(id) || of_all.slightly.contains(id)) continue;
    add_issue(
        report, map, numbers.unnecessary, element,
        fmt::format("lanelet {} yields and need not for one with the right of way; remove it", id))
        .severity = numbers.unnecessary_severity;
  }
  for (const auto& [id, share] : met.slightly) {
    if (named.contains(id)) continue;
    add_issue(
        report, map, numbers.slight, element,
        fmt::format("lanelet {} covers {:.2g} % of one with the right of way; look whether it "
                    "has to yield",
                    id, 100.0 * share))
        .severity = validation::Severity::info;
  }
}

/// In order of the file.
void check_elements(const VectorMap& map, Report& report, const Elements& elements,
                    const MustYield& must_yield, const Numbers& numbers) {
  for (const Relation* element : map.regulations()) {
    const auto found = elements.find(element);
    if (found == elements.end()) continue;
    check_element(map, report, *element, found->second, must_yield, numbers);
  }
}

/// The right_of_way elements that a lanelet names; issues where it has none or several.
/// @param number  of the issue of none; that of several follows it.
const Relation* only_right_of_way(const VectorMap& map, Report& report, const Lanelet& lanelet,
                                  int number, std::string_view lights) {
  const auto elements = regulations_of(lanelet, "right_of_way");
  if (elements.empty()) {
    add_issue(report, map, number, lanelet,
              fmt::format("has {} and no right_of_way; add a regulatory element that says who "
                          "yields",
                          lights));
  } else if (elements.size() > 1) {
    add_issue(report, map, number + 1, lanelet,
              fmt::format("names {} right_of_way elements; make them one", elements.size()));
  }
  return elements.size() == 1 ? elements.front() : nullptr;
}

/// The lanelets that have the right of way by each element, looked up once.
class RightsOfWay {
 public:
  explicit RightsOfWay(const VectorMap& map) : map_(map) {}

  const std::vector<const Lanelet*>& of(const Relation& element) {
    const auto [found, is_new] = by_element_.try_emplace(&element);
    if (is_new) {
      found->second = map_.lanelets(element, "right_of_way");
      std::ranges::sort(found->second);
    }
    return found->second;
  }

 private:
  const VectorMap& map_;
  std::map<const Relation*, std::vector<const Lanelet*>> by_element_;
};

/// An issue where the lanelet names the element and the element gives it no right of way.
bool check_role(const VectorMap& map, RightsOfWay& rights, Report& report,
                const Relation& regulation, const Lanelet& lanelet, int number) {
  if (std::ranges::binary_search(rights.of(regulation), &lanelet)) return true;
  add_issue(report, map, number, regulation,
            fmt::format("lanelet {} names it and is not its member \"right_of_way\"; add it, or "
                        "remove the element there",
                        lanelet.id()));
  return false;
}

bool check_role_count(const VectorMap& map, RightsOfWay& rights, Report& report,
                      const Relation& regulation, int number) {
  const std::size_t count = rights.of(regulation).size();
  if (count == 1) return true;
  add_issue(report, map, number, regulation,
            fmt::format("gives {} lanelets the right of way; give it just one", count));
  return false;
}

void with_lights(const VectorMap& map, const ValidateOptions&, Report& report) {
  Elements elements;
  RightsOfWay rights(map);
  for (const Lanelet& lanelet : map.lanelets()) {
    if (!turns_at_lights(lanelet)) continue;
    const Relation* element = only_right_of_way(
        map, report, lanelet, 1,
        fmt::format("turn_direction={} and a traffic light", lanelet.tag("turn_direction")));
    if (element == nullptr || !check_role(map, rights, report, *element, lanelet, 3)) continue;
    elements[element].push_back(&lanelet);
  }
  const auto must_yield = [&](const Lanelet& lanelet, const Lanelet& other) {
    return yields_at_lights(map, lanelet, other);
  };
  check_elements(map, report, elements, must_yield, {.missing = 4, .unnecessary = 5, .slight = 6});
}

void with_virtual_lights(const VectorMap& map, const ValidateOptions&, Report& report) {
  Elements elements;
  RightsOfWay rights(map);
  for (const Lanelet& lanelet : map.lanelets()) {
    if (regulations_of(lanelet, "virtual_traffic_light").empty()) continue;
    const Relation* element = only_right_of_way(map, report, lanelet, 1, "a virtual_traffic_light");
    if (element == nullptr || !check_role_count(map, rights, report, *element, 3)) continue;
    if (check_role(map, rights, report, *element, lanelet, 4))
      elements[element].push_back(&lanelet);
  }
  // Who passes a virtual light has the whole crossing to himself: lanelets from the same place
  // yield, too.
  const auto must_yield = [](const Lanelet&, const Lanelet&) { return true; };
  check_elements(map, report, elements, must_yield, {.missing = 5, .unnecessary = 6, .slight = 7});
}

/// Intersection areas none of whose lanelets names a right_of_way.
void areas_without_right_of_way(const VectorMap& map, Report& report) {
  std::map<std::int64_t, bool> has_one;
  for (const Lanelet& lanelet : map.lanelets()) {
    const auto area = id_in(lanelet.tag("intersection_area"));
    if (!area) continue;
    bool& found = has_one.emplace(*area, false).first->second;
    found = found || !regulations_of(lanelet, "right_of_way").empty();
  }
  for (const auto& [id, found] : has_one) {
    const Way* area = map.way(id);
    if (found || area == nullptr) continue;  // one that is not there is another rule's
    add_issue(report, map, 5, *area,
              "no lanelet in this intersection names a right_of_way; add the elements that say who "
              "yields");
  }
}

void without_lights(const VectorMap& map, const ValidateOptions&, Report& report) {
  Elements elements;
  RightsOfWay rights(map);
  for (const Lanelet& lanelet : map.lanelets()) {
    if (!has_tag(lanelet, "turn_direction") && !has_tag(lanelet, "intersection_area")) continue;
    if (!regulations_of(lanelet, "traffic_light").empty() ||
        !regulations_of(lanelet, "virtual_traffic_light").empty()) {
      continue;
    }
    for (const Relation* element : regulations_of(lanelet, "right_of_way")) {
      if (!check_role_count(map, rights, report, *element, 1)) continue;
      if (check_role(map, rights, report, *element, lanelet, 2))
        elements[element].push_back(&lanelet);
    }
  }
  const auto must_yield = [&](const Lanelet& lanelet, const Lanelet& other) {
    return !have_one_source(map, lanelet, other);
  };
  check_elements(map, report, elements, must_yield,
                 {.missing = 3,
                  .unnecessary = 4,
                  .slight = 6,
                  .unnecessary_severity = validation::Severity::warning});
  areas_without_right_of_way(map, report);
}

constexpr std::array<Rule, 3> kRightOfWayRules = {{
    {{"autoware.intersection.right-of-way-with-lights",
      {},
      validation::Severity::error,
      "a turn with traffic lights does not say rightly who yields to it",
      "Intersection.RightOfWayWithTrafficLights"},
     with_lights},
    {{"autoware.intersection.right-of-way-with-virtual-lights",
      {},
      validation::Severity::error,
      "a lanelet with a virtual traffic light does not say rightly who yields to it",
      "Intersection.RightOfWayForVirtualTrafficLights"},
     with_virtual_lights},
    {{"autoware.intersection.right-of-way",
      {},
      validation::Severity::error,
      "a lanelet in an intersection without lights does not say rightly who yields to it",
      "Intersection.RightOfWayWithoutTrafficLights"},
     without_lights},
}};

}  // namespace

std::span<const Rule> right_of_way_rules() { return kRightOfWayRules; }

}  // namespace roadbed::map::lanelet2::autoware
