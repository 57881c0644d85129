#include "roadbed/map/opendrive/write/written_borders.h"

#include <algorithm>
#include <cmath>

#include "roadbed/map/opendrive/write/clothoid.h"

namespace roadbed::map::opendrive {
namespace {

constexpr double kSagitta_m = 2e-4;  // of a chord
constexpr double kLongestStep_m = 2.0;
constexpr double kShortestStep_m = 0.02;

class BorderEvaluator {
 public:
  explicit BorderEvaluator(const RoadShape& shape) : shape_(shape), view_(shape.plan_view) {}

  std::vector<WrittenLine> lines(const WrittenSection& written) const {
    const SectionShape& section = *written.shape;
    std::vector<WrittenLine> lines(section.widths.size() + 1);
    const std::vector<double> corners_m = corners(section, written.from_m, written.to_m);
    for (std::size_t i = 0; i + 1 < corners_m.size(); ++i) {
      add(section, corners_m[i], corners_m[i + 1], i + 2 == corners_m.size(), lines);
    }
    return lines;
  }

 private:
  // Where a piece or a record begins: only there a border may have a corner.
  std::vector<double> corners(const SectionShape& section, double from_m, double to_m) const {
    std::vector<double> s_m{from_m, to_m};
    const auto note = [&](double at_m) {
      if (at_m > from_m && at_m < to_m) s_m.push_back(at_m);
    };
    for (const geometry::PlanPiece& piece : shape_.plan_view) note(piece.s_m);
    const auto note_all = [&](const geometry::PiecewiseCubic& cubic) {
      for (const geometry::CubicRecord& record : cubic.records()) note(record.s_m);
    };
    note_all(shape_.lane_offset);
    note_all(shape_.superelevation);
    for (const geometry::PiecewiseCubic& width : section.widths) note_all(width);
    std::sort(s_m.begin(), s_m.end());
    s_m.erase(std::unique(s_m.begin(), s_m.end()), s_m.end());
    return s_m;
  }

  void add(const SectionShape& section, double from_m, double to_m, bool is_last,
           std::vector<WrittenLine>& lines) const {
    const double record_m = 0.5 * (from_m + to_m);
    for (double s_m = from_m; s_m < to_m;) {
      place(section, s_m, record_m, lines);
      // Curvatures are linear in between, so that the greatest one is at an end.
      const double step_m = chord_m(section, s_m, record_m);
      s_m += std::min(step_m, chord_m(section, std::min(s_m + step_m, to_m), record_m));
    }
    if (is_last) place(section, to_m, record_m, lines);
  }

  // How long a chord may be where the road is bent as at a station.
  double chord_m(const SectionShape& section, double s_m, double record_m) const {
    double bend_per_m = 0.0;
    for (const geometry::CubicValue& t : offsets(section, s_m, record_m)) {
      bend_per_m = std::max(bend_per_m, std::abs(t.d2));
    }
    bend_per_m += std::abs(view_.at(s_m, record_m).curvature_per_m);
    return std::clamp(std::sqrt(8.0 * kSagitta_m / std::max(bend_per_m, 1e-9)), kShortestStep_m,
                      kLongestStep_m);
  }

  void place(const SectionShape& section, double s_m, double record_m,
             std::vector<WrittenLine>& lines) const {
    const geometry::Pose2 pose = view_.at(s_m, record_m).pose;
    const double lean = std::cos(shape_.superelevation.at(s_m, record_m).value);
    const Eigen::Vector2d along = unit(pose.heading_rad);
    const Eigen::Vector2d across(-lean * along.y(), lean * along.x());
    const auto t = offsets(section, s_m, record_m);
    for (std::size_t border = 0; border < t.size(); ++border) {
      lines[border].emplace_back(pose.position() + t[border].value * across);
    }
  }

  // Of each border at a station, from left to right: the lane offset and the widths up to it.
  std::vector<geometry::CubicValue> offsets(const SectionShape& section, double s_m,
                                            double record_m) const {
    const std::size_t middle = section.left_lanes, count = section.widths.size();
    std::vector<geometry::CubicValue> t(count + 1);
    t[middle] = shape_.lane_offset.at(s_m, record_m);
    const auto add_width = [&](std::size_t border, std::size_t inner, std::size_t lane, int side) {
      const geometry::CubicValue width = section.widths[lane].at(s_m, record_m);
      t[border] = {t[inner].value + side * width.value, t[inner].d1 + side * width.d1,
                   t[inner].d2 + side * width.d2};
    };
    for (std::size_t i = middle; i > 0; --i) add_width(i - 1, i, i - 1, 1);
    for (std::size_t i = middle; i < count; ++i) add_width(i + 1, i, i, -1);
    return t;
  }

  const RoadShape& shape_;
  geometry::PlanView view_;
};

}  // namespace

std::vector<std::vector<WrittenLine>> written_borders(const RoadShape& shape) {
  const BorderEvaluator evaluator(shape);
  std::vector<std::vector<WrittenLine>> lines;
  for (const WrittenSection& section : written_sections(shape)) {
    lines.push_back(evaluator.lines(section));
  }
  return lines;
}

}  // namespace roadbed::map::opendrive
