#include "roadbed/map/edit/clipping/ladders.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "roadbed/geometry/index/box_tree.h"
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

class LadderSearch {
 public:
  LadderSearch(const commonroad::Document& document, const Region& region, bool whole)
      : region_(region), whole_(whole) {
    for (const auto lanelet : document.lanelets()) read(document.xml, lanelet);
  }

  LadderSpans run() {
    make_groups();
    find_spans();
    return {std::move(ladders_), std::move(spans_), std::move(unusable_)};
  }

 private:
  void read(const XmlDocument& xml, pugi::xml_node lanelet) {
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

  // Lanelets beside each other, with rows that correspond, are cut together.
  void make_groups() {
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

  void add_neighbours(std::size_t index) {
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

  void find_spans() {
    for (const std::vector<std::size_t>& group : groups_) {
      std::vector<Span>& spans = spans_.emplace_back();
      const double last = ladders_[group.front()].last_row();
      if (!ladders_[group.front()].is_regular()) {  // rows that do not correspond: whole or nothing
        if (side_of(group, 0.0, last) != Region::Side::outside) spans.push_back({0.0, last});
        continue;
      }
      for (double row = 0.0; row < last; row += 1.0) {
        touching_spans(
            row, row + 1.0, [&](double a, double b) { return side_of(group, a, b); },
            [&](double a, double b) { return length_m(group, a, b) <= kShortM; },
            [&](double r) { return touches(group, r); }, spans);
      }
      for (Span& span : spans) {
        for (double* end : {&span.from, &span.to}) {
          if (std::abs(*end - std::round(*end)) < kSameRow) *end = std::round(*end);
        }
      }
      std::erase_if(spans, [](const Span& span) { return !(span.to - span.from > 1e-6); });
      if (!spans.empty() && whole_) spans = {{0.0, last}};
    }
  }

  Region::Side side_of(const std::vector<std::size_t>& group, double from, double to) const {
    bool all_outside = true;
    for (const std::size_t i : group) {
      const Ladder& ladder = ladders_[i];
      const double a = ladder.own_row(from), b = ladder.own_row(to);
      geometry::Box box;
      if (ladder.is_regular()) {
        for (const Line* line : {&ladder.left, &ladder.right}) {
          box.extend(at_row(*line, a));
          box.extend(at_row(*line, b));
        }
      } else {
        for (const Vector2d& point : ladder.left) box.extend(point);
        for (const Vector2d& point : ladder.right) box.extend(point);
      }
      const auto side = region_.side_of_disc(box.center(), 0.5 * box.diagonal().norm() + 1e-6);
      if (side == Region::Side::inside) return side;
      all_outside = all_outside && side == Region::Side::outside;
    }
    return all_outside ? Region::Side::outside : Region::Side::border;
  }

  double length_m(const std::vector<std::size_t>& group, double from, double to) const {
    double most_m = 0.0;
    for (const std::size_t i : group) {
      const double a = ladders_[i].own_row(from), b = ladders_[i].own_row(to);
      most_m = std::max({most_m, (at_row(ladders_[i].left, a) - at_row(ladders_[i].left, b)).norm(),
                         (at_row(ladders_[i].right, a) - at_row(ladders_[i].right, b)).norm()});
    }
    return most_m;
  }

  bool touches(const std::vector<std::size_t>& group, double row) const {
    return std::any_of(group.begin(), group.end(), [&](std::size_t i) {
      const double own = ladders_[i].own_row(row);
      return region_.touches(at_row(ladders_[i].left, own), at_row(ladders_[i].right, own));
    });
  }

  const Region& region_;
  bool whole_;
  std::vector<Ladder> ladders_;
  std::map<std::string, std::size_t> by_id_;
  std::vector<std::vector<std::size_t>> groups_;  // of ladders that are cut together
  std::vector<std::vector<Span>> spans_;          // of each group, in rows
  std::vector<pugi::xml_node> unusable_;
};

}  // namespace

LadderSpans ladders_inside(const commonroad::Document& document, const Region& region, bool whole) {
  return LadderSearch(document, region, whole).run();
}

}  // namespace roadbed::map::edit::clipping
