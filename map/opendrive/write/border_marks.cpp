#include "roadbed/map/opendrive/write/border_marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "roadbed/map/files/xml_characters.h"
#include "roadbed/map/opendrive/stretch.h"
#include "roadbed/map/opendrive/write/number_text.h"

namespace roadbed::map::opendrive {
namespace {

constexpr double kSame_m = 1e-3;  // stations that are nearer are one

std::string_view word_of(MarkType type, int minor) {
  static constexpr std::array<std::string_view, 12> words = {
      "none",          "solid",      "broken", "solid solid", "solid broken", "broken solid",
      "broken broken", "botts dots", "curb",   "grass",       "edge",         "custom"};
  const bool is_new = type == MarkType::edge || type == MarkType::other;
  if (is_new && minor < 5) return type == MarkType::edge ? "curb" : "none";
  return words.at(static_cast<std::size_t>(type));
}

std::string_view color_of(const std::string& color) {
  static constexpr std::array<std::string_view, 7> words = {"blue",   "green",  "red",     "white",
                                                            "yellow", "orange", "standard"};
  const auto found = std::find(words.begin(), words.end(), color);
  return found == words.end() ? "standard" : *found;
}

struct Range {
  double from_m, to_m;
};

class MarkWriter {
 public:
  MarkWriter(const RoadMap& road_map, const PlannedSection& section, const SectionShape& shape,
             std::size_t place)
      : road_map_(road_map), section_(section), shape_(shape), place_(place) {
    if (place > 0) {
      read_marks(place - 1, false);
      rightwards_ = windows(place - 1, false);
    }
    if (place < section.lanes.size()) {
      if (marks_.empty()) read_marks(place, true);
      leftwards_ = windows(place, true);
    }
  }

  std::string write(double from_m, double to_m, int minor) const {
    const bool between = place_ > 0 && place_ < section_.lanes.size();
    if (marks_.empty() && !between) return {};
    std::string text, last;
    for (const double s_m : stations(from_m, to_m)) {
      const BorderMark mark = mark_at(s_m + kSame_m);
      const bool is_bare = mark.type == MarkType::none && mark.width_m <= 0.0;
      if (is_bare && !between && text.empty()) continue;  // where no record holds, no mark is
      std::string words =
          fmt::format("type=\"{}\" color=\"{}\"", word_of(mark.type, minor), color_of(mark.color));
      if (mark.width_m > 0.0) words += fmt::format(" width=\"{}\"", short_number(mark.width_m));
      if (between) words += fmt::format(" laneChange=\"{}\"", change_at(s_m + kSame_m));
      if (words == last) continue;
      fmt::format_to(std::back_inserter(text), "<roadMark sOffset=\"{}\" {}/>",
                     short_number(s_m - from_m), words);
      last = std::move(words);
    }
    return text;
  }

 private:
  void read_marks(std::size_t index, bool on_left) {
    const PlannedLane& planned = section_.lanes[index];
    const Lane& lane = road_map_.lane(planned.lane);
    const auto& marks = on_left == planned.forward ? lane.left_marks : lane.right_marks;
    std::vector<double> from_m;
    for (const BorderMark& mark : marks) from_m.push_back(mark.from_s_m);
    marks_ = along_road(shape_, index, planned.forward, lane.length_m(), from_m, marks);
    for (auto& mark : marks_) {
      // Of two lines the one left along the lane comes first; in the file the inner one does.
      const bool turn = !planned.forward != (place_ < section_.left_lanes);
      if (turn) mark.value.type = mirrored(mark.value.type);
    }
  }

  // Where a lane may be left across the border, by the road's s, in order and apart.
  std::vector<Range> windows(std::size_t index, bool on_left) const {
    const PlannedLane& planned = section_.lanes[index];
    const LaneLinks& links = road_map_.graph().of(planned.lane);
    const auto& beside = on_left == planned.forward ? links.left : links.right;
    const std::size_t other = on_left ? place_ - 1 : place_;
    if (!beside || place_ == 0 || other >= section_.lanes.size()) return {};
    if (beside->lane != section_.lanes[other].lane) return {};
    std::vector<Range> ranges;
    for (const StationRange& window : beside->change_windows) {
      const double a = shape_.road_s_m(index, window.from_s_m);
      const double b = shape_.road_s_m(index, window.to_s_m);
      ranges.push_back({std::min(a, b), std::max(a, b)});
    }
    std::ranges::sort(ranges, {}, &Range::from_m);
    return ranges;
  }

  std::vector<double> stations(double from_m, double to_m) const {
    std::vector<double> all{from_m};
    const auto add = [&](double s_m) {
      if (s_m > from_m + kSame_m && s_m < to_m - kSame_m) all.push_back(s_m);
    };
    for (const auto& mark : marks_) add(mark.s_m);
    for (const auto* ranges : {&leftwards_, &rightwards_}) {
      for (const Range& range : *ranges) {
        add(range.from_m);
        add(range.to_m);
      }
    }
    std::sort(all.begin(), all.end());
    const auto near = [](double a, double b) { return b - a < kSame_m; };
    all.erase(std::unique(all.begin(), all.end(), near), all.end());
    return all;
  }

  BorderMark mark_at(double s_m) const {
    if (marks_.empty()) return {};
    const auto behind = std::ranges::upper_bound(marks_, s_m, {}, &FromStation<BorderMark>::s_m);
    return behind == marks_.begin() ? behind->value : std::prev(behind)->value;
  }

  std::string_view change_at(double s_m) const {
    const auto inside = [&](const std::vector<Range>& ranges) {
      const auto behind = std::ranges::upper_bound(ranges, s_m, {}, &Range::from_m);
      return behind != ranges.begin() && s_m < std::prev(behind)->to_m;
    };
    const bool increase = inside(leftwards_), decrease = inside(rightwards_);
    if (increase && decrease) return "both";
    return increase ? "increase" : decrease ? "decrease" : "none";
  }

  const RoadMap& road_map_;
  const PlannedSection& section_;
  const SectionShape& shape_;
  std::size_t place_;
  std::vector<FromStation<BorderMark>> marks_;
  std::vector<Range> leftwards_, rightwards_;
};

}  // namespace

std::string marks_text(const RoadMap& road_map, const PlannedSection& section,
                       const SectionShape& shape, std::size_t place, double from_m, double to_m,
                       int minor) {
  return MarkWriter(road_map, section, shape, place).write(from_m, to_m, minor);
}

}  // namespace roadbed::map::opendrive
