#include "roadbed/map/edit/clipping/ladders.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "roadbed/map/edit/xml_edit.h"

namespace roadbed::map::inline edit::inline clipping {
namespace {

using Eigen::Vector2d;
using Line = std::vector<Vector2d>;

constexpr double kShortM = 0.1;    // stretches shorter than this are not looked into
constexpr double kSameRow = 1e-9;  // fractions of a row this near to a row are that row

Vector2d at_row(const Line& line, double row) {
  const auto i = std::min(static_cast<std::size_t>(row), line.size() - 2);
  return line[i] + (row - static_cast<double>(i)) * (line[i + 1] - line[i]);
}

}  // namespace

LadderMap::LadderMap(const commonroad::Document& document) {
  for (const auto lanelet : document.lanelets()) read(document.xml, lanelet);
  make_groups();
  std::vector<geometry::Box> boxes;
  for (const Group& group : groups_) {
    geometry::Box& box = boxes.emplace_back();
    for (const std::size_t i : group) {
      for (const Line* line : {&ladders_[i].left, &ladders_[i].right}) {
        for (const Vector2d& point : *line) box.extend(point);
      }
    }
  }
  if (!boxes.empty()) tree_ = geometry::BoxTree(boxes);
}

void LadderMap::read(const XmlDocument& xml, pugi::xml_node lanelet) {
  Ladder ladder{lanelet, text(lanelet, "id"), {}, {}};
  const auto points = [&](const char* bound, Line& line) {
    for (const Eigen::Vector3d& point :
         commonroad::read_points(xml, lanelet.child(bound), {0.0, 0.0})) {
      line.push_back(point.head<2>());
    }
  };
  points("leftBound", ladder.left);
  points("rightBound", ladder.right);
  if (ladder.left.size() < 2 || ladder.right.size() < 2) {
    unusable_.push_back(lanelet);
    return;
  }
  by_id_.emplace(ladder.id, ladders_.size());
  ladders_.push_back(std::move(ladder));
}

void LadderMap::make_groups() {
  for (std::size_t i = 0; i < ladders_.size(); ++i) {
    ladders_[i].group = SIZE_MAX;
  }
  for (std::size_t i = 0; i < ladders_.size(); ++i) {
    if (ladders_[i].group != SIZE_MAX) continue;
    ladders_[i].group = groups_.size();
    groups_.push_back({i});
    for (std::size_t k = 0; k < groups_.back().size(); ++k) add_neighbours(groups_.back()[k]);
  }
}

void LadderMap::add_neighbours(std::size_t index) {
  const Ladder& ladder = ladders_[index];
  for (const char* side : {"adjacentLeft", "adjacentRight"}) {
    const auto adjacent = ladder.node.child(side);
    const auto found = by_id_.find(text(adjacent, "ref"));
    if (found == by_id_.end()) continue;
    Ladder& other = ladders_[found->second];
    if (other.group != SIZE_MAX || !ladder.is_regular() || !other.is_regular() ||
        other.left.size() != ladder.left.size()) {
      continue;
    }
    other.group = ladder.group;
    other.against = ladder.against != !commonroad::is_same_direction(adjacent);
    groups_[ladder.group].push_back(found->second);
  }
}

std::vector<std::vector<Span>> LadderMap::spans_inside(const Region& region, bool whole) const {
  std::vector<std::vector<Span>> spans(groups_.size());
  if (groups_.empty()) return spans;
  tree_.visit(region.bounds(), [&](std::size_t i) {
    spans[i] = spans_of(groups_[i], region);
    if (!spans[i].empty() && whole) spans[i] = {{0.0, ladders_[groups_[i].front()].last_row()}};
  });
  return spans;
}

std::vector<Span> LadderMap::spans_of(const Group& group, const Region& region) const {
  std::vector<Span> spans;
  const double last = ladders_[group.front()].last_row();
  if (!ladders_[group.front()].is_regular()) {  // rows that do not correspond: whole or nothing
    const RegionPart part = RegionPart(region).within(box_of(group, 0.0, last));
    if (side_of(group, 0.0, last, part) != Region::Side::outside) spans.push_back({0.0, last});
    return spans;
  }
  for (double row = 0.0; row < last; row += 1.0) {
    touching_spans(
        RegionPart(region), row, row + 1.0, [&](double a, double b) { return box_of(group, a, b); },
        [&](const RegionPart& part, double a, double b) { return side_of(group, a, b, part); },
        [&](double a, double b) { return length_m(group, a, b) <= kShortM; },
        [&](const RegionPart& part, double r) { return touches(group, r, part); }, spans);
  }
  for (Span& span : spans) {
    for (double* end : {&span.from, &span.to}) {
      if (std::abs(*end - std::round(*end)) < kSameRow) *end = std::round(*end);
    }
  }
  std::erase_if(spans, [](const Span& span) { return !(span.to - span.from > 1e-6); });
  return spans;
}

geometry::Box LadderMap::box_of(const Ladder& ladder, double from, double to) {
  geometry::Box box;
  for (const Line* line : {&ladder.left, &ladder.right}) {
    if (ladder.is_regular()) {
      box.extend(at_row(*line, ladder.own_row(from)));
      box.extend(at_row(*line, ladder.own_row(to)));
    } else {
      for (const Vector2d& point : *line) box.extend(point);
    }
  }
  return box;
}

geometry::Box LadderMap::box_of(const Group& group, double from, double to) const {
  geometry::Box box;
  for (const std::size_t i : group) box.extend(box_of(ladders_[i], from, to));
  const Vector2d margin = Vector2d::Constant(1e-6);  // of rounding
  return {box.min() - margin, box.max() + margin};
}

Region::Side LadderMap::side_of(const Group& group, double from, double to,
                                const RegionPart& region) const {
  bool all_outside = true;
  for (const std::size_t i : group) {
    const geometry::Box box = box_of(ladders_[i], from, to);
    const auto side = region.side_of_disc(box.center(), 0.5 * box.diagonal().norm() + 1e-6);
    if (side == Region::Side::inside) return side;
    all_outside = all_outside && side == Region::Side::outside;
  }
  return all_outside ? Region::Side::outside : Region::Side::border;
}

double LadderMap::length_m(const Group& group, double from, double to) const {
  double most_m = 0.0;
  for (const std::size_t i : group) {
    const double a = ladders_[i].own_row(from), b = ladders_[i].own_row(to);
    most_m = std::max({most_m, (at_row(ladders_[i].left, a) - at_row(ladders_[i].left, b)).norm(),
                       (at_row(ladders_[i].right, a) - at_row(ladders_[i].right, b)).norm()});
  }
  return most_m;
}

bool LadderMap::touches(const Group& group, double row, const RegionPart& region) const {
  return std::any_of(group.begin(), group.end(), [&](std::size_t i) {
    const double own = ladders_[i].own_row(row);
    return region.touches(at_row(ladders_[i].left, own), at_row(ladders_[i].right, own));
  });
}

}  // namespace roadbed::map::edit::clipping
