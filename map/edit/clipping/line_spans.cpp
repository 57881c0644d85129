#include "roadbed/map/edit/clipping/line_spans.h"

#include <algorithm>
#include <cmath>

#include "roadbed/map/edit/clipping/region_part.h"

namespace roadbed::map::inline edit::inline clipping {
namespace {

using Eigen::Vector2d;

constexpr double kSamePlaceM = 1e-6;

Vector2d point_at(std::span<const Vector2d> line, double place) {
  const auto i = std::min(static_cast<std::size_t>(place), line.size() - 2);
  return line[i] + (place - static_cast<double>(i)) * (line[i + 1] - line[i]);
}

// The disc around the line's box.
Region::Side side_of(std::span<const Vector2d> line, const Region& region) {
  const geometry::Box box = geometry::box_around(line);
  return region.side_of_disc(box.center(), 0.5 * box.diagonal().norm() + kSamePlaceM);
}

// Where the line may go in or out, both its ends among them.
std::vector<double> places_of_change(std::span<const Vector2d> line, const Region& region) {
  const auto last = static_cast<double>(line.size() - 1);
  std::vector<double> places{0.0};
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double length_m = (line[i + 1] - line[i]).norm();
    for (const double at : region.crossings(line[i], line[i + 1])) {
      const auto first = static_cast<double>(i);
      if (at * length_m < kSamePlaceM) {
        places.push_back(first);
      } else if ((1.0 - at) * length_m < kSamePlaceM) {
        places.push_back(first + 1.0);
      } else {
        places.push_back(first + at);
      }
    }
  }
  places.push_back(last);
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

}  // namespace

std::vector<LineSpan> spans_inside(std::span<const Vector2d> line, const Region& region) {
  if (line.size() < 2) return {};
  const Region::Side side = side_of(line, region);
  if (side == Region::Side::outside) return {};
  if (side == Region::Side::inside) return {{0.0, static_cast<double>(line.size() - 1)}};
  std::vector<LineSpan> spans;
  const std::vector<double> places = places_of_change(line, region);
  std::vector<Vector2d> between;
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    between.push_back(point_at(line, 0.5 * (places[i] + places[i + 1])));
  }
  const std::vector<bool> inside = contains_each(region, between);
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    if (!inside[i]) continue;
    if (!spans.empty() && spans.back().to == places[i]) {
      spans.back().to = places[i + 1];
    } else {
      spans.push_back({places[i], places[i + 1]});
    }
  }
  return spans;
}

std::vector<LineSpan> reversed(const std::vector<LineSpan>& spans, std::size_t points) {
  const auto last = static_cast<double>(points - 1);
  std::vector<LineSpan> turned;
  for (auto span = spans.rbegin(); span != spans.rend(); ++span) {
    turned.push_back({last - span->to, last - span->from});
  }
  return turned;
}

bool correspond(const std::vector<LineSpan>& a, std::size_t points_a,
                const std::vector<LineSpan>& b, std::size_t points_b) {
  if (a.size() != b.size()) return false;
  const auto last_a = static_cast<double>(points_a - 1), last_b = static_cast<double>(points_b - 1);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if ((a[i].from <= 0.0) != (b[i].from <= 0.0) || (a[i].to >= last_a) != (b[i].to >= last_b)) {
      return false;
    }
  }
  return true;
}

}  // namespace roadbed::map::edit::clipping
