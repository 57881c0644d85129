#include "roadbed/tools/support/obstacles_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "roadbed/map/input_error.h"

namespace roadbed::tools {
namespace {

enum ObstacleColumn : std::size_t { kTime, kX, kY, kHeading, kLength, kWidth, kId };

struct ColumnRule {
  std::string_view name;
  double least, most;
};

constexpr double kFarthest = 1e9, kLongestBox_m = 1000.0;
constexpr std::array<ColumnRule, 7> kRules{{
    {"t_s", -kFarthest, kFarthest},
    {"x_m", -kFarthest, kFarthest},
    {"y_m", -kFarthest, kFarthest},
    {"heading_rad", -kFarthest, kFarthest},
    {"length_m", 1e-3, kLongestBox_m},
    {"width_m", 1e-3, kLongestBox_m},
    {"id", 0.0, 0.0},
}};

/// A line of the file, taken apart.
struct ObstacleLine {
  const std::string& file;
  std::size_t number = 0;
  std::vector<std::string_view> fields = {};

  [[noreturn]] void refuse(const std::string& element, const std::string& found,
                           const std::string& needed) const {
    throw map::InputError({.file = file,
                           .place = std::to_string(number),
                           .element = element,
                           .found = found,
                           .needed = needed,
                           .remedy = "mend the row"});
  }

  // Takes the next line off the text.
  void take(std::string_view& text) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    ++number;
    fields.clear();
    for (;;) {
      const std::size_t comma = line.find(',');
      fields.push_back(stripped(line.substr(0, comma)));
      if (comma == std::string_view::npos) return;
      line.remove_prefix(comma + 1);
    }
  }

  bool is_empty() const { return fields.size() == 1 && fields[0].empty(); }

 private:
  static std::string_view stripped(std::string_view text) {
    constexpr std::string_view space = " \t\r";
    const std::size_t first = text.find_first_not_of(space);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(space) - first + 1);
  }
};

using Places = std::array<std::size_t, kRules.size()>;

Places places_of_columns(const ObstacleLine& header) {
  Places places{};
  for (std::size_t c = 0; c < kRules.size(); ++c) {
    const auto found = std::ranges::find(header.fields, kRules[c].name);
    if (found == header.fields.end()) {
      header.refuse(fmt::format("column {}", kRules[c].name), "is missing from the header",
                    "a first line like t_s,id,x_m,y_m,heading_rad,length_m,width_m");
    }
    places[c] = static_cast<std::size_t>(found - header.fields.begin());
  }
  return places;
}

double number_in(const ObstacleLine& line, const Places& places, ObstacleColumn column) {
  const ColumnRule& rule = kRules[column];
  const std::string_view text = line.fields[places[column]];
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_whole = error == std::errc() && end == text.data() + text.size();
  if (!is_whole || !(value >= rule.least && value <= rule.most)) {
    line.refuse(fmt::format("column {}", rule.name), fmt::format("\"{}\"", text),
                fmt::format("a number from {:g} to {:g}", rule.least, rule.most));
  }
  return value;
}

/// Gathers the rows of each id.
class ObstacleTable {
 public:
  void add(const ObstacleLine& line, const Places& places) {
    if (line.fields.size() <= *std::ranges::max_element(places)) {
      line.refuse("row", fmt::format("has {} fields", line.fields.size()), "as many as the header");
    }
    const std::string id(line.fields[places[kId]]);
    if (id.empty()) line.refuse("column id", "is empty", "a name");
    const auto [known, is_new] = number_of_.emplace(id, rows_.size());
    if (is_new) {
      rows_.emplace_back();
      boxes_.push_back({.id = id, .length_m = 0.0, .width_m = 0.0, .motion = {}});
    }
    auto& rows = rows_[known->second];
    rows.push_back({.t_s = number_in(line, places, kTime),
                    .x_m = number_in(line, places, kX),
                    .y_m = number_in(line, places, kY),
                    .heading_rad = number_in(line, places, kHeading)});
    if (rows.size() > 1 && !(rows.back().t_s > rows[rows.size() - 2].t_s)) {
      line.refuse("column t_s",
                  fmt::format("{} s does not come after {} s of the row before of \"{}\"",
                              rows.back().t_s, rows[rows.size() - 2].t_s, id),
                  "increasing times of each id");
    }
    planning::Obstacle& box = boxes_[known->second];
    box.length_m = std::max(box.length_m, number_in(line, places, kLength));
    box.width_m = std::max(box.width_m, number_in(line, places, kWidth));
  }

  std::vector<planning::MovingObstacle> take() {
    std::vector<planning::MovingObstacle> obstacles;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      boxes_[i].motion = geometry::Trajectory(std::move(rows_[i]));
      planning::MovingObstacle obstacle{.obstacle = std::move(boxes_[i])};
      if (!obstacle.obstacle.is_static()) {
        obstacle.from_s = obstacle.obstacle.motion.start_s();
        obstacle.to_s = obstacle.obstacle.motion.end_s();
      }
      obstacles.push_back(std::move(obstacle));
    }
    return obstacles;
  }

 private:
  std::map<std::string, std::size_t> number_of_;
  std::vector<planning::Obstacle> boxes_;
  std::vector<std::vector<geometry::TrajectoryPoint>> rows_;
};

}  // namespace

std::vector<planning::MovingObstacle> parse_obstacles_csv(std::string_view bytes,
                                                          const std::string& name) {
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
  if (bytes.starts_with(byte_order_mark)) bytes.remove_prefix(byte_order_mark.size());
  ObstacleLine line{name};
  line.take(bytes);
  const Places places = places_of_columns(line);
  ObstacleTable table;
  while (!bytes.empty()) {
    line.take(bytes);
    if (!line.is_empty()) table.add(line, places);
  }
  std::vector<planning::MovingObstacle> obstacles = table.take();
  if (obstacles.empty()) line.refuse("row", "there is none", "at least one below the header");
  return obstacles;
}

std::string obstacles_text(const std::vector<planning::MovingObstacle>& obstacles) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  for (const planning::MovingObstacle& moving : obstacles) {
    const planning::Obstacle& box = moving.obstacle;
    fmt::format_to(out, "{},{},{},{},{}\n", box.id, box.length_m, box.width_m, moving.from_s,
                   moving.to_s);
    for (const auto& row : box.motion.points()) {
      fmt::format_to(out, "{},{},{},{}\n", row.t_s, row.x_m, row.y_m, row.heading_rad);
    }
  }
  return fmt::to_string(text);
}

}  // namespace roadbed::tools
