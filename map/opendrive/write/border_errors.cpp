#include "roadbed/map/opendrive/write/border_errors.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

#include "roadbed/geometry/index/box_tree.h"
#include "roadbed/geometry/primitives/segment.h"
#include "roadbed/map/files/in_threads.h"
#include "roadbed/map/opendrive/write/road_lines.h"
#include "roadbed/map/opendrive/write/written_borders.h"

namespace roadbed::map::opendrive {
namespace {

using LineSpan = std::span<const Eigen::Vector2d>;

/// Lines, and how far a point is from the nearest one.
class NearestLine {
 public:
  explicit NearestLine(const std::vector<LineSpan>& lines) {
    constexpr std::size_t together = 8;  // segments to a box
    std::vector<geometry::Box> boxes;
    for (const LineSpan& line : lines) {
      for (std::size_t i = 0; i + 1 < line.size(); i += together) {
        chains_.push_back(line.subspan(i, std::min(together + 1, line.size() - i)));
        boxes.push_back(geometry::box_around(chains_.back()));
      }
    }
    tree_ = geometry::BoxTree(boxes);
  }

  /// Of so many boxes at most, which it counts down; beyond, how far it is at most.
  double distance_m(const Eigen::Vector2d& point, double most_m, std::int64_t& boxes_left) const {
    double least_m = most_m;
    tree_.nearest(point, most_m, [&](std::size_t index) {
      if (--boxes_left < 0) return -1.0;  // ends the search
      double nearest_m = 1e300;
      const LineSpan& chain = chains_[index];
      for (std::size_t i = 1; i < chain.size(); ++i) {
        nearest_m =
            std::min(nearest_m, geometry::distance_to_segment_m(point, chain[i - 1], chain[i]));
      }
      least_m = std::min(least_m, nearest_m);
      return nearest_m;
    });
    return least_m;
  }

 private:
  std::vector<LineSpan> chains_;
  geometry::BoxTree tree_;
};

constexpr double kStride_m = 0.5, kWorthALook_m = 0.01, kLookedAt_m = 0.002;

/// The largest distance of a line to the nearest of all others: of places every half a metre, and
/// where these are off by more than a centimetre between them, too, as the farthest place may be
/// between two of the others. The one that it stands for runs beside it, mostly near enough to make
/// any other needless. Where so many lines lie on each other that it would look into more than 8
/// boxes for each place, that one has to do: the distance is at most what is said.
class LineError {
 public:
  explicit LineError(const NearestLine& others) : others_(others) {}

  void add(const LineSpan& line, const LineSpan& beside) {
    std::size_t at = 1;
    std::optional<Place> last;
    const auto look = [&](const Eigen::Vector2d& point) {
      boxes_left_ += 8;
      Place place{point, distance_beside_m(point, beside, at)};
      if (place.most_m > std::min(largest_.largest_m, kWorthALook_m)) {
        place.most_m = distance_m(point, place.most_m);
        note(place);
      }
      if (last && std::max(last->most_m, place.most_m) > kWorthALook_m) look_between(*last, place);
      last = place;
    };
    for (const Eigen::Vector2d& point : line) {
      if (last) {
        const Eigen::Vector2d from = last->at, step = point - from;
        const double parts = std::ceil(step.norm() / kStride_m);
        for (double i = 1.0; i < parts; i += 1.0) look(from + i / parts * step);
      }
      look(point);
    }
  }

  const BorderError& largest() const { return largest_; }

 private:
  struct Place {
    Eigen::Vector2d at;
    double most_m;  ///< it is no farther from the others
  };

  double distance_m(const Eigen::Vector2d& point, double most_m) {
    return boxes_left_ > 0 ? others_.distance_m(point, most_m, boxes_left_) : most_m;
  }

  void note(const Place& place) {
    if (place.most_m > largest_.largest_m) largest_ = {place.most_m, place.at};
  }

  // No place between is farther off than half of both distances and of the way.
  void look_between(const Place& from, const Place& to) {
    const double way_m = (to.at - from.at).norm();
    const bool is_no_farther = 0.5 * (from.most_m + to.most_m + way_m) <= largest_.largest_m;
    if (way_m < kLookedAt_m || is_no_farther) return;
    const Eigen::Vector2d at = 0.5 * (from.at + to.at);
    if (boxes_left_ <= 0) return note({at, 0.5 * (from.most_m + to.most_m + way_m)});
    const Place middle{at, distance_m(at, 0.5 * (from.most_m + to.most_m + way_m))};
    note(middle);
    look_between(from, middle);
    look_between(middle, to);
  }

  // Over the segments ahead, as long as one comes nearer.
  static double distance_beside_m(const Eigen::Vector2d& point, const LineSpan& beside,
                                  std::size_t& at) {
    constexpr std::size_t ahead = 4;
    double least_m = 1e300;
    std::size_t best = at;
    for (std::size_t i = at; i < beside.size() && i <= best + ahead; ++i) {
      const double off_m = geometry::distance_to_segment_m(point, beside[i - 1], beside[i]);
      if (off_m < least_m) {
        least_m = off_m;
        best = i;
      }
    }
    at = best;
    return least_m;
  }

  const NearestLine& others_;
  std::int64_t boxes_left_ = 4'000;
  BorderError largest_;
};

std::vector<Eigen::Vector2d> own_part(const RoadBorder& border) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = border.own_from; i <= border.own_to; ++i) {
    points.emplace_back(border.points[i].head<2>());
  }
  return points;
}

}  // namespace

std::vector<BorderError> border_errors(const RoadMap& road_map, const RoadPlan& plan,
                                       const std::vector<RoadShape>& shapes, int threads) {
  // By road, section, border.
  std::vector<std::vector<std::vector<WrittenLine>>> written(shapes.size());
  in_threads(shapes.size(), threads,
             [&](std::size_t road) { written[road] = written_borders(shapes[road]); });
  std::vector<LineSpan> all_written, all_source;
  for (const auto& sections : written) {
    for (const auto& section : sections) {
      all_written.insert(all_written.end(), section.begin(), section.end());
    }
  }
  for (const Lane& lane : road_map.lanes()) {
    for (const LaneLine* line : {&lane.left, &lane.right}) {
      all_source.emplace_back(line->in_map.points());
    }
  }
  const NearestLine nearest_written(all_written), nearest_source(all_source);
  std::vector<BorderError> errors(shapes.size());
  in_threads(shapes.size(), threads, [&](std::size_t road) {
    LineError there(nearest_source), back(nearest_written);
    const std::vector<WrittenSection> sections = written_sections(shapes[road]);
    for (std::size_t i = 0; i < sections.size(); ++i) {
      const PlannedSection& section = plan.roads[road].sections[sections[i].planned];
      for (std::size_t border = 0; border <= section.lanes.size(); ++border) {
        const auto own = own_part(border_along(road_map, section, border));
        there.add(written[road][i][border], own);
        if (sections[i].is_rim()) continue;
        back.add(own, written[road][i][border]);
        // The lane on the other side may have its own idea of the border.
        if (border == 0 || border == section.lanes.size()) continue;
        const PlannedLane& planned = section.lanes[border - 1];
        const Lane& lane = road_map.lane(planned.lane);
        back.add((planned.forward ? lane.right : lane.left).in_map.points(),
                 written[road][i][border]);
      }
    }
    errors[road] = std::ranges::max(there.largest(), back.largest(), {}, &BorderError::largest_m);
  });
  return errors;
}

}  // namespace roadbed::map::opendrive
