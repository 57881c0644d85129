#include "roadbed/map/commonroad/build_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "roadbed/map/elements/side.h"

namespace roadbed::map::commonroad {
namespace {

constexpr double kJoinedM = 1.0;  ///< lane ends or borders further apart are not joined

double end_gap_m(const Lane& from, const Lane& to) {
  const auto gap = [](const LaneLine& a, const LaneLine& b) {
    return (a.in_map.points().back() - b.in_map.points().front()).norm();
  };
  return std::max(gap(from.left, to.left), gap(from.right, to.right));
}

class Linker {
 public:
  Linker(const Document& document, const BuiltLanes& built, std::vector<ImportDiagnostic>& remarks)
      : document_(document), built_(built), remarks_(remarks), links_(built.lanes.size()) {}

  std::vector<LaneLinks> link() {
    for (const Lane& lane : built_.lanes) {
      for (const auto& [link, to] : targets(lane, "successor")) join(lane, to, lane, link);
      for (const auto& [link, from] : targets(lane, "predecessor")) join(from, lane, lane, link);
      put_beside(lane, Side::left, "adjacentLeft");
      put_beside(lane, Side::right, "adjacentRight");
    }
    for (LaneLinks& links : links_) {
      tidy(links.successors);
      tidy(links.predecessors);
    }
    for (const Lane& lane : built_.lanes) check_both_say(lane);
    return std::move(links_);
  }

 private:
  pugi::xml_node element(const Lane& lane) const { return built_.elements[lane.id.index]; }

  void fault(const char* rule, const Lane& lane, const std::string& message, bool in_text) {
    remarks_.push_back({rule, true, "lanelet " + lane.name, document_.xml.line_of(element(lane)),
                        message, in_text});
  }

  static void tidy(std::vector<LaneId>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }

  std::optional<LaneId> target(const Lane& lane, const char* child, const std::string& id) {
    const std::optional<LaneId> found = built_.find(id);
    if (!found) {
      fault("import.link", lane,
            fmt::format("its {} {} is not there; the link is left out", child, id),
            !document_.lanelet_by_id.contains(id));
    }
    return found;
  }

  struct Target {
    pugi::xml_node link;
    const Lane& lane;
  };

  std::vector<Target> targets(const Lane& lane, const char* child) {
    std::vector<Target> found;
    for (const pugi::xml_node link : element(lane).children(child)) {
      const auto other = target(lane, child, link.attribute("ref").value());
      if (other) found.push_back({link, built_.lanes[other->index]});
    }
    return found;
  }

  void join(const Lane& from, const Lane& to, const Lane& speaker, pugi::xml_node link) {
    const double gap_m = end_gap_m(from, to);
    if (gap_m > kJoinedM) {
      fault("import.link-geometry", speaker,
            fmt::format("lanelet {} is said to lead to {}, but their ends are {:.2f} m apart; the "
                        "link is left out",
                        from.name, to.name, gap_m),
            !is_answered(element(speaker), link, element(&speaker == &from ? to : from)));
      return;
    }
    links_[from.id.index].successors.push_back(to.id);
    links_[to.id.index].predecessors.push_back(from.id);
  }

  void check_both_say(const Lane& lane) {
    check_back(lane, links_[lane.id.index].successors, "successor", "predecessor");
    check_back(lane, links_[lane.id.index].predecessors, "predecessor", "successor");
  }

  // Links of the graph hold for both ends; here each end is asked whether it names the other.
  void check_back(const Lane& lane, const std::vector<LaneId>& others, const char* child,
                  const char* back) {
    std::vector<std::string> named = references(element(lane), child);
    std::sort(named.begin(), named.end());
    for (const LaneId other : others) {
      const std::string& id = built_.lanes[other.index].name;
      if (std::binary_search(named.begin(), named.end(), id)) continue;
      fault("import.one-sided-link", lane,
            fmt::format("is the {} of lanelet {} but does not name it as its {}; name each other "
                        "in both",
                        back, id, child),
            true);
    }
  }

  void put_beside(const Lane& lane, Side side, const char* child) {
    const pugi::xml_node adjacent = element(lane).child(child);
    if (!adjacent) return;
    const auto found = target(lane, child, adjacent.attribute("ref").value());
    if (!found || *found == lane.id) return;
    const Lane& other = built_.lanes[found->index];
    const bool same = is_same_direction(adjacent);
    std::vector<StationRange> joined = joined_ranges(lane, side, other, same, kJoinedM);
    if (joined.empty()) {
      fault("import.link-geometry", lane,
            fmt::format("its {} {} runs nowhere along that border in the {} direction; lanes "
                        "cannot be changed there",
                        child, other.name, same ? "same" : "opposite"),
            !is_answered(element(lane), adjacent, element(other)));
    }
    if (!may_change(lane, side, other, same)) joined.clear();
    neighbour(links_[lane.id.index], side) = Neighbour{other.id, same, std::move(joined)};
  }

  const Document& document_;
  const BuiltLanes& built_;
  std::vector<ImportDiagnostic>& remarks_;
  std::vector<LaneLinks> links_;
};

}  // namespace

std::vector<LaneLinks> link_lanes(const Document& document, const BuiltLanes& built,
                                  std::vector<ImportDiagnostic>& remarks) {
  return Linker(document, built, remarks).link();
}

}  // namespace roadbed::map::commonroad
