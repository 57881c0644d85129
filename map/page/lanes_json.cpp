#include <algorithm>
#include <cmath>
#include <map>

#include "roadbed/map/derived/conflicts.h"
#include "roadbed/map/page/page_data.h"

namespace roadbed::map::inline page {
namespace {

std::int64_t thousandths(double value) { return std::llround(value * 1e3); }

/// The ring that follows from a lane's borders, as long as nothing of it is folded.
bool is_plain(const Lane& lane) {
  geometry::Ring ring = lane.right.in_map.points();
  ring.insert(ring.end(), lane.left.in_map.points().rbegin(), lane.left.in_map.points().rend());
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  return ring == lane.polygon;
}

/// 0 if unknown.
long line_of(const Lane& lane, const validation::ElementLines& lines) {
  const auto found = lines.find("lane " + lane.name);
  return found == lines.end() ? 0 : found->second;
}

/// Texts of which many are alike: each is kept once, and told by its number.
class Pool {
 public:
  std::int64_t number_of(const std::string& text) {
    const auto [at, is_new] = numbers_.try_emplace(text, static_cast<std::int64_t>(texts_.size()));
    if (is_new) texts_.push_back(text);
    return at->second;
  }
  const std::vector<std::string>& texts() const { return texts_; }

 private:
  std::map<std::string, std::int64_t> numbers_;
  std::vector<std::string> texts_;
};

/// Lists of numbers, one list per lane.
struct Lists {
  Column counts, values;
  Json json() const { return {{"counts", counts.text()}, {"values", values.text()}}; }
};

class LaneColumns {
 public:
  explicit LaneColumns(const RoadMap& road_map) : road_map_(road_map) {}

  void add(const Lane& lane, int level, long line) {
    names_.push_back(lane.name);
    type_.add(types_.number_of(std::string(to_string(lane.type))));
    drivable_.add(is_drivable(lane.type) ? 1 : 0);
    road_.add_step(lane.road ? lane.road->index + 1 : 0);
    junction_.add_step(lane.junction ? lane.junction->index + 1 : 0);
    level_.add(level);
    line_.add_step(line);
    one_way_.add(lane.one_way ? 1 : 0);
    participants_.add(lane.participants.bits());
    attributes_.add(texts_.number_of(attribute_lines(lane.attributes)));
    add_shape(lane);
    add_links(lane);
    add_speeds(lane);
    for (const auto* marks : {&lane.left_marks, &lane.right_marks}) add_marks(*marks);
    if (!lane.road) return;
    road_from_.add_step(thousandths(lane.origin.road_from_s_m));
    road_to_.add_step(thousandths(lane.origin.road_to_s_m));
  }

  Json json() const {
    return {{"count", names_.size()},
            {"names", names_},
            {"types", types_.texts()},
            {"texts", texts_.texts()},
            {"type", type_.text()},
            {"drivable", drivable_.text()},
            {"road", road_.text()},
            {"junction", junction_.text()},
            {"level", level_.text()},
            {"line", line_.text()},
            {"oneWay", one_way_.text()},
            {"participants", participants_.text()},
            {"attributes", attributes_.text()},
            {"lines", lines_.json()},
            {"heights", heights_.text()},
            {"plain", plain_.text()},
            {"rings", rings_.json()},
            {"successors", successors_.json()},
            {"predecessors", predecessors_.json()},
            {"left", left_.text()},
            {"right", right_.text()},
            {"speeds", speeds_.json()},
            {"marks", marks_.json()},
            {"roadFrom", road_from_.text()},
            {"roadTo", road_to_.text()}};
  }

 private:
  void add_shape(const Lane& lane) {
    for (const LaneLine* line : {&lane.left, &lane.centre, &lane.right}) {
      lines_.add(line->in_map.points());
    }
    for (const double z_m : lane.centre.z_m) heights_.add_step(thousandths(z_m));
    const bool plain = is_plain(lane);
    plain_.add(plain ? 1 : 0);
    if (!plain) rings_.add(lane.polygon);
  }

  void add_links(const Lane& lane) {
    const LaneLinks& links = road_map_.graph().of(lane.id);
    const auto add_all = [&](Lists& lists, const std::vector<LaneId>& to) {
      lists.counts.add(static_cast<std::int64_t>(to.size()));
      for (const LaneId id : to) lists.values.add(step(lane.id, id));
    };
    add_all(successors_, links.successors);
    add_all(predecessors_, links.predecessors);
    add_neighbour(left_, lane.id, links.left);
    add_neighbour(right_, lane.id, links.right);
  }

  static std::int64_t step(LaneId from, LaneId to) {
    return std::int64_t{to.index} - std::int64_t{from.index};
  }

  // 0: none; else the step to its id, which is never 0, times 4, and two flags.
  static void add_neighbour(Column& column, LaneId from, const std::optional<Neighbour>& to) {
    if (!to) return column.add(0);
    column.add(4 * step(from, to->lane) + (to->same_direction ? 2 : 0) +
               (to->change_allowed() ? 1 : 0));
  }

  // From where, and the limit in mm/s plus one; 0: not known, -1: there is none.
  void add_speeds(const Lane& lane) {
    speeds_.counts.add(static_cast<std::int64_t>(lane.speed_limits.size()));
    for (const SpeedLimit& limit : lane.speed_limits) {
      speeds_.values.add(thousandths(limit.from_s_m));
      speeds_.values.add(!limit.limit_mps                  ? 0
                         : std::isfinite(*limit.limit_mps) ? thousandths(*limit.limit_mps) + 1
                                                           : -1);
    }
  }

  void add_marks(const std::vector<BorderMark>& marks) {
    marks_.counts.add(static_cast<std::int64_t>(marks.size()));
    for (const BorderMark& mark : marks) {
      marks_.values.add(thousandths(mark.from_s_m));
      marks_.values.add(static_cast<std::int64_t>(mark.type) * 2 +
                        (mark.color == "yellow" ? 1 : 0));
    }
  }

  const RoadMap& road_map_;
  std::vector<std::string> names_;
  Pool types_, texts_;
  Column type_, drivable_, road_, junction_, level_, line_, one_way_, participants_, attributes_;
  Column heights_, plain_, left_, right_, road_from_, road_to_;
  LineColumns lines_, rings_;
  Lists successors_, predecessors_, speeds_, marks_;
};

}  // namespace

Json lanes_json(const RoadMap& road_map, const validation::ElementLines& lines) {
  const std::vector<int> levels = levels_of_lanes(road_map);
  LaneColumns columns(road_map);
  for (const Lane& lane : road_map.lanes()) {
    columns.add(lane, levels[lane.id.index], line_of(lane, lines));
  }
  return columns.json();
}

}  // namespace roadbed::map::page
