#include "roadbed/map/commonroad/build_map.h"

#include <fmt/format.h>

#include "roadbed/map/commonroad/values.h"
#include "roadbed/map/elements/lane_lines.h"

namespace roadbed::map::commonroad {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// Users that the children of that name name; unknown words name nobody.
Participants named_users(pugi::xml_node lanelet, const char* child) {
  Participants named;
  for (const std::string& word : texts(lanelet, child)) {
    named = Participants::from_bits(static_cast<std::uint16_t>(named.bits() | users(word).bits()));
  }
  return named;
}

Attributes kept_words(pugi::xml_node lanelet) {
  Attributes kept;
  for (const char* child : {"laneletType", "userOneWay", "userBidirectional"}) {
    for (std::string& word : texts(lanelet, child)) kept.emplace_back(child, std::move(word));
  }
  return kept;
}

/// What a `lineMarking` child of a bound says; none if nothing.
std::optional<BorderMark> read_marking(pugi::xml_node bound) {
  return border_mark(text_of(bound.child("lineMarking")));
}

void set_use(const XmlDocument& xml, pugi::xml_node lanelet, Lane& lane) {
  const Participants both_ways = named_users(lanelet, "userBidirectional");
  const Participants one_way = named_users(lanelet, "userOneWay");
  const auto named =
      Participants::from_bits(static_cast<std::uint16_t>(one_way.bits() | both_ways.bits()));
  lane.type = lane_type(texts(lanelet, "laneletType"), named);
  lane.participants = named.empty() ? default_users(lane.type) : named;
  lane.one_way = !both_ways.has(Participant::car);
  lane.attributes = kept_words(lanelet);
  if (lanelet.child("speedLimit")) {
    lane.speed_limits = {{0.0, xml.text_number(lanelet, "speedLimit")}};
  }
  if (const auto mark = read_marking(lanelet.child("leftBound"))) lane.left_marks = {*mark};
  if (const auto mark = read_marking(lanelet.child("rightBound"))) lane.right_marks = {*mark};
}

class LaneBuilder {
 public:
  LaneBuilder(const XmlDocument& xml, const Eigen::Vector2d& origin_in_source,
              std::vector<ImportDiagnostic>& remarks)
      : xml_(xml), origin_in_source_(origin_in_source), remarks_(remarks) {}

  void add(pugi::xml_node lanelet) {
    const std::string id = lanelet.attribute("id").value();
    if (id.empty() || built_.ids.contains(id)) {
      fault("import.lanelet-id", lanelet,
            id.empty() ? "it has no id and is left out" : "another one has its id; it is left out",
            !id.empty());
      return;
    }
    Points left = read_points(xml_, lanelet.child("leftBound"), origin_in_source_);
    Points right = read_points(xml_, lanelet.child("rightBound"), origin_in_source_);
    if (left.size() < 2 || right.size() < 2) {
      fault("import.short-border", lanelet,
            fmt::format("its borders have {} and {} points, each needs 2; it is left out",
                        left.size(), right.size()),
            true);
      return;
    }
    if (left.size() != right.size()) {
      fault("import.border-points", lanelet,
            fmt::format("its borders have {} and {} points, which should be equal; points are "
                        "added in between",
                        left.size(), right.size()),
            true);
      pair_points(left, right);
    }
    add_lane(id, lanelet, left, right);
  }

  BuiltLanes take() {
    if (faults_ > kMostFaults) {
      remarks_.back() = {remarks_.back().rule, true, "file", 0,
                         fmt::format("and {} more faulty lanelets", faults_ - kMostFaults)};
    }
    return std::move(built_);
  }

 private:
  static constexpr std::size_t kMostFaults = 10'000;  // that are told one by one

  void fault(const char* rule, pugi::xml_node lanelet, const std::string& message,
             bool in_text = false) {
    if (++faults_ > kMostFaults + 1) return;
    remarks_.push_back({rule, true, fmt::format("lanelet {}", lanelet.attribute("id").value()),
                        xml_.line_of(lanelet), message, in_text});
  }

  void add_lane(const std::string& id, pugi::xml_node lanelet, const Points& left,
                const Points& right) {
    Lane lane;
    lane.id = LaneId{static_cast<std::uint32_t>(built_.lanes.size())};
    lane.origin.source_id = id;
    lane.name = id;
    set_lines(left, points_halfway(left, right), right, lane);
    if (!(lane.length_m() > 0.0)) {
      fault("import.empty-lanelet", lanelet, "it has no length and is left out");
      return;
    }
    set_use(xml_, lanelet, lane);
    check_sides(lanelet, lane);
    built_.ids.emplace(id, lane.id);
    built_.elements.push_back(lanelet);
    built_.lanes.push_back(std::move(lane));
  }

  void check_sides(pugi::xml_node lanelet, const Lane& lane) {
    if (!has_swapped_borders(lane)) return;
    fault("import.swapped-borders", lanelet,
          "its left border lies to the right of its right one; swap them or turn both round");
  }

  const XmlDocument& xml_;
  Eigen::Vector2d origin_in_source_;
  std::vector<ImportDiagnostic>& remarks_;
  std::size_t faults_ = 0;
  BuiltLanes built_;
};

}  // namespace

std::optional<LaneId> BuiltLanes::find(std::string_view source_id) const {
  const auto found = ids.find(source_id);
  if (found == ids.end()) return {};
  return found->second;
}

BuiltLanes build_lanes(const Document& document, const Eigen::Vector2d& origin_in_source,
                       std::vector<ImportDiagnostic>& remarks) {
  LaneBuilder builder(document.xml, origin_in_source, remarks);
  for (const pugi::xml_node lanelet : document.lanelets()) builder.add(lanelet);
  return builder.take();
}

}  // namespace roadbed::map::commonroad
