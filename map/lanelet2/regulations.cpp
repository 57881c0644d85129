#include "roadbed/map/lanelet2/build_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/lanelet2/traffic_rules.h"

namespace roadbed::map::lanelet2 {
namespace {

bool is_signal_type(std::string_view type) {
  return type == "traffic_light" || type == "traffic_sign";
}

// Kinds of regulatory elements whose `refers` are signs or lights.
bool refers_to_signals(std::string_view subtype) {
  return subtype == "traffic_light" || subtype == "traffic_sign" || subtype == "speed_limit" ||
         subtype == "right_of_way" || subtype == "all_way_stop";
}

template <typename Item>
void sort_out(std::vector<Item>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

class RegulationBuilder {
 public:
  RegulationBuilder(Document& document, BuiltLanes& built, RoadMapParts& parts)
      : document_(document),
        built_(built),
        parts_(parts),
        budget_(1'500'000 + 2 * document.text.size()),
        signal_of_way_(document.ways.size()),
        stop_line_of_way_(document.ways.size()) {}

  void build() {
    for (std::uint32_t i = 0; i < document_.ways.size(); ++i) {
      if (is_signal_type(document_.ways[i].type)) signal_at(i);
      if (document_.ways[i].type == "stop_line") stop_line_at(i);
    }
    find_lanes();
    for (std::uint32_t i = 0; i < document_.relations.size(); ++i) {
      if (document_.relations[i].type == "regulatory_element") add(i);
    }
    for (Signal& signal : parts_.signals) {
      sort_out(signal.lanes);
      turn_to_traffic(signal);
    }
    for (StopLine& line : parts_.stop_lines) {
      sort_out(line.lanes);
      sort_out(line.signals);
    }
  }

 private:
  // Elements that name each other crosswise could mean far more than the file is long.
  void spend(std::size_t amount) {
    if (amount > budget_) {
      throw InputError({.file = document_.name,
                        .found = "its regulatory elements repeat more than a map of this size can "
                                 "hold",
                        .remedy = "check whether many of them name the same lines and lanelets"});
    }
    budget_ -= amount;
  }

  template <typename Some>
  Attributes copied(const Some& tags) {
    for (const auto& [key, value] : tags) spend(key.size() + value.size());
    return {tags.begin(), tags.end()};
  }

  // Which lanes name each regulatory element.
  void find_lanes() {
    lanes_of_relation_.resize(document_.relations.size());
    ranks_of_relation_.resize(document_.relations.size());
    limit_rank_of_lane_.assign(built_.lanes.size(), std::numeric_limits<std::size_t>::max());
    for (const Lane& lane : built_.lanes) {
      const Relation& relation = document_.relations[built_.relations[lane.id.index]];
      for (const Member& member : relation.members) {
        if (member.role != "regulatory_element") continue;
        const auto found = document_.relation_index.find(member.id);
        if (!found || document_.relations[*found].type != "regulatory_element") {
          document_
              .fault(relation.at, "import.reference",
                     fmt::format("its regulatory element {} is not in the file", member.id))
              .in_text = member.kind == MemberKind::relation && !found;
          continue;
        }
        std::vector<LaneId>& lanes = lanes_of_relation_[*found];
        if (!lanes.empty() && lanes.back() == lane.id) continue;
        lanes.push_back(lane.id);
        ranks_of_relation_[*found].push_back(
            static_cast<std::size_t>(&member - relation.members.data()));
      }
    }
  }

  void add(std::uint32_t index) {
    const Relation& relation = document_.relations[index];
    Regulation regulation;
    regulation.source_id = std::to_string(relation.id);
    regulation.type = relation.subtype;
    regulation.lanes = lanes_of_relation_[index];
    regulation.attributes = attributes_of(relation.tags);
    if (relation.subtype.empty()) {
      document_
          .fault(relation.at, "import.regulation-type",
                 "has no subtype; it is kept, but says nothing")
          .in_text = true;
    }
    for (const Member& member : relation.members) {
      regulation.members.push_back(resolved(relation, member));
    }
    add_signals(relation, regulation);
    add_stop_lines(relation, regulation);
    if (relation.subtype == "speed_limit") add_speed_limit(index, regulation);
    parts_.regulations.push_back(std::move(regulation));
  }

  RegulationMember resolved(const Relation& relation, const Member& member) {
    RegulationMember found{std::string(member.role), std::to_string(member.id), {}, {}, {}};
    bool there = false, in_file = false;
    if (member.kind == MemberKind::way) {
      if (const auto way = document_.way_index.find(member.id)) {
        there = true;
        Way& line = document_.ways[*way];
        line.used = true;
        found.attributes = copied(line.tags);
        spend(line.nodes.size());
        found.in_map = document_.points(line);
      }
    } else if (member.kind == MemberKind::node) {
      const auto node = document_.node_index.find(member.id);
      in_file = node.has_value();
      if (node && document_.nodes[*node].placed) {
        there = true;
        found.attributes = copied(document_.tags_of(document_.nodes[*node].at));
        found.in_map = {document_.nodes[*node].in_map};
      }
    } else if (const auto other = document_.relation_index.find(member.id)) {
      there = true;
      found.lane = built_.lane_of_relation[*other];
    }
    if (!there) {
      document_
          .fault(relation.at, "import.reference",
                 fmt::format("its {} {} is not in the file", member.role, member.id))
          .in_text = !in_file;
    }
    return found;
  }

  Signal* signal_at(std::uint32_t way_index) {
    Way& way = document_.ways[way_index];
    if (way.nodes.empty()) return nullptr;
    way.used = true;
    if (!signal_of_way_[way_index]) {
      signal_of_way_[way_index] = parts_.signals.size();
      parts_.signals.push_back(signal_from(way));
    }
    return &parts_.signals[*signal_of_way_[way_index]];
  }

  Signal signal_from(const Way& way) const {
    Signal signal;
    signal.source_id = std::to_string(way.id);
    signal.type = way.type;
    signal.subtype = way.subtype;
    signal.dynamic = way.type == "traffic_light";
    signal.attributes = attributes_of(way.tags);
    if (const auto limit = sign_speed_mps(way.subtype)) {
      signal.value = *limit * 3.6;
      signal.unit = "km/h";
    }
    const Eigen::Vector3d first = document_.nodes[way.nodes.front()].in_map;
    const Eigen::Vector3d last = document_.nodes[way.nodes.back()].in_map;
    signal.in_map = 0.5 * (first + last).head<2>();
    signal.z_m = 0.5 * (first.z() + last.z());
    const Eigen::Vector2d along = (last - first).head<2>();
    if (along.norm() > 1e-6) signal.heading_rad = std::atan2(-along.x(), along.y());
    return signal;
  }

  void add_signals(const Relation& relation, const Regulation& regulation) {
    if (!refers_to_signals(relation.subtype)) return;
    for (const Member& member : relation.members) {
      if (member.role != "refers" || member.kind != MemberKind::way) continue;
      const auto way = document_.way_index.find(member.id);
      Signal* const signal = way ? signal_at(*way) : nullptr;
      if (signal == nullptr) continue;
      spend(regulation.lanes.size());
      signal->lanes.insert(signal->lanes.end(), regulation.lanes.begin(), regulation.lanes.end());
      if (relation.subtype == "traffic_light") signal->dynamic = true;
    }
  }

  // The lines of a sign or light do not say which side is its face: the one that traffic sees, of
  // which the way from left to right is only the habit.
  void turn_to_traffic(Signal& signal) const {
    if (!signal.heading_rad || signal.lanes.empty()) return;
    const Lane& lane = built_.lanes[signal.lanes.front().index];
    const double towards_rad = lane.pose_at(lane.length_m()).heading_rad;
    if (std::cos(*signal.heading_rad - towards_rad) > 0.0) {
      signal.heading_rad =
          std::remainder(*signal.heading_rad + std::numbers::pi, 2.0 * std::numbers::pi);
    }
  }

  StopLine* stop_line_at(std::uint32_t way_index) {
    Way& way = document_.ways[way_index];
    if (way.nodes.size() < 2) return nullptr;
    way.used = true;
    if (!stop_line_of_way_[way_index]) {
      stop_line_of_way_[way_index] = parts_.stop_lines.size();
      parts_.stop_lines.push_back({std::to_string(way.id), document_.points(way), {}, {}});
    }
    return &parts_.stop_lines[*stop_line_of_way_[way_index]];
  }

  void add_stop_lines(const Relation& relation, const Regulation& regulation) {
    const bool is_sign = relation.subtype == "traffic_sign" || relation.subtype == "road_marking";
    if (!refers_to_signals(relation.subtype) && !is_sign) return;
    if (relation.subtype == "speed_limit") return;  // its line is where the limit begins
    for (const Member& member : relation.members) {
      if (member.kind != MemberKind::way) continue;
      const auto way = document_.way_index.find(member.id);
      const bool stops =
          member.role == "ref_line" || (way && document_.ways[*way].type == "stop_line");
      StopLine* const line = way && stops ? stop_line_at(*way) : nullptr;
      if (line != nullptr) fill(*line, relation, regulation);
    }
  }

  void fill(StopLine& line, const Relation& relation, const Regulation& regulation) {
    const std::vector<LaneId> lanes = stopping_lanes(relation, regulation);
    spend(lanes.size() + regulation.members.size());
    line.lanes.insert(line.lanes.end(), lanes.begin(), lanes.end());
    for (const RegulationMember& member : regulation.members) {
      if (member.role == "refers" && refers_to_signals(relation.subtype)) {
        line.signals.push_back(member.source_id);
      }
    }
  }

  // Who stops at an element's line: of a right of way those that yield.
  static std::vector<LaneId> stopping_lanes(const Relation& relation,
                                            const Regulation& regulation) {
    if (relation.subtype != "right_of_way") return regulation.lanes;
    std::vector<LaneId> lanes;
    for (const RegulationMember& member : regulation.members) {
      if (member.role == "yield" && member.lane) lanes.push_back(*member.lane);
    }
    return lanes;
  }

  static std::string_view subtype_of(const RegulationMember& member) {
    for (const auto& [key, value] : member.attributes) {
      if (key == "subtype") return value;
    }
    return {};
  }

  // What the sign shows counts before what the element says, and of several elements the one that a
  // lanelet names first, as in the library lanelet2 (TrafficRules::speedLimit).
  void add_speed_limit(std::uint32_t index, const Regulation& regulation) {
    const Relation& relation = document_.relations[index];
    std::string_view code;
    for (const RegulationMember& member : regulation.members) {
      if (member.role == "refers" && code.empty()) code = subtype_of(member);
    }
    if (code.empty()) code = value_of(relation.tags, "sign_type");
    if (code.empty()) code = value_of(relation.tags, "speed_limit");
    const std::optional<double> limit_mps = sign_speed_mps(code);
    if (!limit_mps) {
      document_.fault(relation.at, "import.speed-limit",
                      fmt::format("\"{}\" is no speed that is known here; its lanes have no limit "
                                  "from it",
                                  code));
      return;
    }
    for (std::size_t i = 0; i < regulation.lanes.size(); ++i) {
      const std::size_t lane = regulation.lanes[i].index, rank = ranks_of_relation_[index][i];
      if (rank >= limit_rank_of_lane_[lane]) continue;
      limit_rank_of_lane_[lane] = rank;
      built_.lanes[lane].speed_limits = {{0.0, limit_mps}};
    }
  }

  Document& document_;
  BuiltLanes& built_;
  RoadMapParts& parts_;
  std::size_t budget_;
  std::vector<std::optional<std::size_t>> signal_of_way_, stop_line_of_way_;
  std::vector<std::vector<LaneId>> lanes_of_relation_;
  std::vector<std::vector<std::size_t>> ranks_of_relation_;  // its place among each lane's members
  std::vector<std::size_t> limit_rank_of_lane_;              // of the element that set its limit
};

}  // namespace

void add_regulations(Document& document, BuiltLanes& built, RoadMapParts& parts) {
  RegulationBuilder(document, built, parts).build();
}

}  // namespace roadbed::map::lanelet2
