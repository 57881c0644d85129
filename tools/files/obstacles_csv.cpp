#include "roadbed/tools/files/obstacles_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <span>
#include <string_view>
#include <utility>

#include "roadbed/map/files/csv_field.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/short_number.h"
#include "roadbed/map/files/visible_text.h"
#include "roadbed/planning/obstacles/obstacle_limits.h"
#include "roadbed/tools/files/csv.h"

namespace roadbed::tools::inline files {
namespace {

enum ObstacleColumn : std::size_t { kTime, kX, kY, kHeading, kLength, kWidth, kId };

struct ColumnRule {
  std::string_view name;
  double least, most;
};

constexpr const char* kHeader = "t_s,id,x_m,y_m,heading_rad,length_m,width_m";
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

using Places = std::array<std::size_t, kRules.size()>;

Places places_of_columns(const CsvReader& table) {
  Places places{};
  for (std::size_t c = 0; c < kRules.size(); ++c) {
    places[c] = table.column(kRules[c].name, kHeader);
  }
  return places;
}

double number_in(const CsvReader& row, const Places& places, ObstacleColumn column) {
  return row.number(places[column], kRules[column].least, kRules[column].most);
}

/// Gathers the rows of each id.
class ObstacleTable {
 public:
  void add(const CsvReader& row, const Places& places) {
    row.check_width();
    const std::string& id = row.fields()[places[kId]];
    if (id.empty()) row.refuse("column id", "is empty", "a name");
    const auto [known, is_new] = number_of_.emplace(id, rows_.size());
    if (is_new) {
      rows_.emplace_back();
      boxes_.push_back({.id = id, .length_m = 0.0, .width_m = 0.0, .motion = {}});
    }
    auto& rows = rows_[known->second];
    rows.push_back({.t_s = number_in(row, places, kTime),
                    .x_m = number_in(row, places, kX),
                    .y_m = number_in(row, places, kY),
                    .heading_rad = number_in(row, places, kHeading)});
    if (rows.size() > 1 &&
        !(rows.back().t_s >= rows[rows.size() - 2].t_s + planning::kLeastObstacleStep_s)) {
      row.refuse("column t_s",
                 fmt::format("{} s does not come after {} s of the row before of \"{}\"",
                             rows.back().t_s, rows[rows.size() - 2].t_s, id),
                 "times of each id that increase, by 1 µs at least");
    }
    planning::ObstacleInSource& box = boxes_[known->second];
    box.length_m = std::max(box.length_m, number_in(row, places, kLength));
    box.width_m = std::max(box.width_m, number_in(row, places, kWidth));
  }

  std::vector<planning::ObstacleInSource> take() {
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      planning::ObstacleInSource& obstacle = boxes_[i];
      obstacle.motion = geometry::Trajectory(std::move(rows_[i]));
      if (!obstacle.is_static()) {
        obstacle.validity = {obstacle.motion.start_s(), obstacle.motion.end_s()};
      }
    }
    return std::move(boxes_);
  }

 private:
  std::map<std::string, std::size_t> number_of_;
  std::vector<planning::ObstacleInSource> boxes_;
  std::vector<std::vector<geometry::TrajectoryPoint>> rows_;
};

// Rows of one field are those of one obstacle, whoever reads them.
[[noreturn]] void refuse_same_field(std::string_view id, std::string_view other) {
  throw map::InputError({.file = fmt::format("obstacle {}", map::visible_text(std::string(id))),
                         .found = id == other ? "another has the same id"
                                              : fmt::format("its id is written as that of {}",
                                                            map::visible_text(std::string(other))),
                         .needed = "an id of its own in a table",
                         .remedy = "rename one of the two"});
}

}  // namespace

std::vector<planning::ObstacleInSource> parse_obstacles_csv(std::string_view bytes,
                                                            const std::string& name) {
  CsvReader table(bytes, name);
  const Places places = places_of_columns(table);
  ObstacleTable gathered;
  while (table.next_row()) gathered.add(table, places);
  std::vector<planning::ObstacleInSource> obstacles = gathered.take();
  if (obstacles.empty()) table.refuse("row", "there is none", "at least one below the header");
  planning::refuse_endless_ways(std::span<const planning::ObstacleInSource>(obstacles), name);
  return obstacles;
}

std::string write_obstacles_csv(const std::vector<planning::ObstacleInSource>& obstacles) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "{}\n", kHeader);
  std::map<std::string, std::string_view> id_of_field;
  for (const planning::ObstacleInSource& box : obstacles) {
    const std::string id = map::csv_field(box.id);
    const auto [other, is_new] = id_of_field.emplace(id, box.id);
    if (!is_new) refuse_same_field(box.id, other->second);
    const std::string length = map::short_number(box.length_m),
                      width = map::short_number(box.width_m);
    for (const auto& row : box.motion.points()) {
      fmt::format_to(out, "{},{},{},{},{},{},{}\n", map::number_within(row.t_s, 1e-9), id,
                     map::short_number(row.x_m), map::short_number(row.y_m),
                     map::number_within(row.heading_rad, 1e-9), length, width);
    }
  }
  return fmt::to_string(text);
}

std::string obstacles_text(const std::vector<planning::ObstacleInSource>& obstacles) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  for (const planning::ObstacleInSource& box : obstacles) {
    fmt::format_to(out, "{},{},{},{},{}\n", box.id, box.length_m, box.width_m, box.validity.from_s,
                   box.validity.to_s);
    for (const auto& row : box.motion.points()) {
      fmt::format_to(out, "{},{},{},{}\n", row.t_s, row.x_m, row.y_m, row.heading_rad);
    }
  }
  return fmt::to_string(text);
}

}  // namespace roadbed::tools::files
