#include "roadbed/tools/support/route_batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "roadbed/map/input_error.h"
#include "roadbed/map/read_file.h"
#include "roadbed/planning/dissection.h"
#include "roadbed/planning/hierarchy_search.h"
#include "roadbed/planning/route_solver.h"
#include "roadbed/tools/support/place.h"
#include "roadbed/tools/support/route_output.h"

namespace roadbed::tools {
namespace {

using Json = nlohmann::ordered_json;

struct Row {
  std::size_t line = 0;
  std::string from_text, to_text;
  std::optional<map::LanePlace> from, to;
  std::string fault;  ///< why the row cannot be used
};

struct Cell {
  std::string csv;
  Json json;
  bool found = false;
};

[[noreturn]] void refuse(const std::filesystem::path& file, std::size_t line,
                         const std::string& found) {
  throw map::InputError({.file = file.string(),
                         .place = std::to_string(line),
                         .element = {},
                         .found = found,
                         .needed = "a header line with the columns from and to, then a row a pair",
                         .remedy = "mend the file"});
}

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string made = "\"";
  for (const char sign : text) made += sign == '"' ? "\"\"" : std::string(1, sign);
  return made + "\"";
}

void place_row(const map::RoadMap& road_map, const planning::Router& router,
               map::Participant participant, Row& row) {
  try {
    row.from = find_place(road_map, row.from_text, participant).on_lane;
    row.to = find_place(road_map, row.to_text, participant).on_lane;
  } catch (const map::InputError& error) {
    row.fault = error.what();
    return;
  }
  row.fault = router.unfit(*row.from, "start");
  if (row.fault.empty()) row.fault = router.unfit(*row.to, "goal");
}

std::vector<Row> read_rows(const std::filesystem::path& file) {
  std::istringstream text(map::read_file(file));
  std::string line;
  std::getline(text, line);
  const std::vector<std::string> names = csv_fields(line);
  const auto column = [&](const char* name) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) refuse(file, 1, fmt::format("no column {}", name));
    return static_cast<std::size_t>(found - names.begin());
  };
  const std::size_t from = column("from"), to = column("to");
  std::vector<Row> rows;
  for (std::size_t number = 2; std::getline(text, line); ++number) {
    if (line.empty() || line == "\r") continue;
    const std::vector<std::string> fields = csv_fields(line);
    Row row{.line = number, .from_text = {}, .to_text = {}, .from = {}, .to = {}, .fault = {}};
    if (fields.size() != names.size()) {
      row.fault = fmt::format("{} fields, the header has {}; put places with commas in quotes",
                              fields.size(), names.size());
    } else {
      row.from_text = fields[from];
      row.to_text = fields[to];
    }
    rows.push_back(std::move(row));
  }
  if (rows.empty()) refuse(file, 1, "no row");
  return rows;
}

/// Runs work(0) … work(count − 1), each in one of the threads. `make` makes a thread's own tools.
template <typename Make, typename Work>
void in_threads(std::size_t count, int threads, const Make& make, const Work& work) {
  const auto run = [&](std::size_t first) {
    auto own = make();
    for (std::size_t i = first; i < count; i += static_cast<std::size_t>(threads)) work(own, i);
  };
  std::vector<std::thread> others;
  for (int i = 1; i < threads; ++i) others.emplace_back(run, static_cast<std::size_t>(i));
  run(0);
  for (std::thread& other : others) other.join();
}

class Batch {
 public:
  Batch(const map::RoadMap& road_map, const planning::RouteOptions& rules,
        const BatchOptions& options)
      : road_map_(road_map),
        options_(options),
        router_(road_map, rules),
        solver_(router_.solver()),
        hierarchy_(planning::make_hierarchy(
            solver_.graph(),
            planning::dissection_order(solver_.graph(), solver_.guide().place_in_map))),
        metric_(solver_.graph(), hierarchy_, solver_.weights()) {}

  void place(std::vector<Row>& rows) const {
    in_threads(
        rows.size(), options_.threads, [] { return 0; },
        [&](int, std::size_t i) {
          if (rows[i].fault.empty()) {
            place_row(road_map_, router_, router_.options().participant, rows[i]);
          }
        });
  }

  std::vector<Cell> answer_rows(const std::vector<Row>& rows) const {
    std::vector<Cell> cells(rows.size());
    in_threads(
        rows.size(), options_.threads, [&] { return planning::HierarchySearch(metric_); },
        [&](planning::HierarchySearch& search, std::size_t i) {
          cells[i] = answer(search, rows[i]);
        });
    return cells;
  }

  std::vector<Cell> answer_matrix(const std::vector<Row>& rows) const {
    std::vector<planning::ClimbedSpace> goals(rows.size());
    const auto make = [&] { return planning::HierarchySearch(metric_); };
    in_threads(rows.size(), options_.threads, make,
               [&](planning::HierarchySearch& search, std::size_t i) {
                 if (!rows[i].fault.empty()) return;
                 const auto end = arrive_at(solver_.graph(), solver_.rules(), *rows[i].to);
                 goals[i] = search.climb(end.seeds, true);
               });
    std::vector<Cell> cells(rows.size() * rows.size());
    in_threads(rows.size(), options_.threads, make,
               [&](planning::HierarchySearch& search, std::size_t i) {
                 if (!rows[i].fault.empty()) return;
                 const auto end = leave_from(solver_.graph(), solver_.rules(), *rows[i].from);
                 const planning::ClimbedSpace start = search.climb(end.seeds, false);
                 for (std::size_t j = 0; j < rows.size(); ++j) {
                   if (!rows[j].fault.empty()) continue;
                   cells[i * rows.size() + j] = matrix_cell(rows[i], rows[j], start, goals[j]);
                 }
               });
    std::erase_if(cells, [](const Cell& cell) { return cell.csv.empty(); });
    return cells;
  }

 private:
  Cell answer(planning::HierarchySearch& search, const Row& row) const {
    if (!row.fault.empty()) return none(row, row.fault);
    planning::RouteTask task = solver_.task(*row.from, *row.to);
    const planning::GraphPath path = search.find(task.start.seeds, task.goal.seeds);
    const auto way = solver_.answer(std::move(task), path);
    if (!way) {
      return none(
          row, fmt::format("no lane sequence leads from lane {} to lane {}",
                           road_map_.lane(row.from->lane).name, road_map_.lane(row.to->lane).name));
    }
    const planning::Route route = router_.route_along(*way);
    std::string lanes;
    for (const planning::RouteLeg& leg : route.legs) {
      lanes += (lanes.empty() ? "" : " ") + road_map_.lane(leg.lane).name;
    }
    Cell cell;
    cell.found = true;
    cell.csv = fmt::format("{},{},{},1,{:.4f},{:.4f},{:.3f},{},{},\n", row.line,
                           csv_text(row.from_text), csv_text(row.to_text), route.cost_s,
                           route.cost_m, route.length_m, route.lane_changes, csv_text(lanes));
    if (options_.json) {
      cell.json = route_json(road_map_, route);
      cell.json["row"] = row.line;
    }
    return cell;
  }

  Cell none(const Row& row, const std::string& reason) const {
    Cell cell;
    cell.csv = fmt::format("{},{},{},0,,,,,,{}\n", row.line, csv_text(row.from_text),
                           csv_text(row.to_text), csv_text(reason));
    if (options_.json) cell.json = {{"found", false}, {"reason", reason}, {"row", row.line}};
    return cell;
  }

  Cell matrix_cell(const Row& from, const Row& to, const planning::ClimbedSpace& start,
                   const planning::ClimbedSpace& goal) const {
    planning::Ticks ticks = cost_between(start, goal);
    const auto direct = direct_way(solver_.rules(), *from.from, *to.to);
    if (direct) ticks = std::min(ticks, direct->cost);
    const planning::RouteCost measure = solver_.options().cost;
    const double cost = static_cast<double>(ticks) / planning::ticks_per_unit(measure);
    Cell cell;
    cell.found = ticks != planning::kNever;
    cell.csv = fmt::format("{},{},{},{},{},{}\n", from.line, to.line, csv_text(from.from_text),
                           csv_text(to.to_text), cell.found ? 1 : 0,
                           cell.found ? fmt::format("{:.4f}", cost) : "");
    if (!options_.json) return cell;
    cell.json = {{"from_row", from.line}, {"to_row", to.line}, {"found", cell.found}};
    const char* key = measure == planning::RouteCost::time ? "cost_s" : "cost_m";
    if (cell.found) cell.json[key] = cost;
    return cell;
  }

  const map::RoadMap& road_map_;
  const BatchOptions& options_;
  planning::Router router_;
  const planning::RouteSolver& solver_;
  planning::Hierarchy hierarchy_;
  planning::HierarchyMetric metric_;
};

std::string header(const planning::RouteOptions& rules, bool matrix) {
  if (!matrix) return "row,from,to,found,cost_s,cost_m,length_m,lane_changes,lanes,reason\n";
  return fmt::format("from_row,to_row,from,to,found,{}\n",
                     rules.cost == planning::RouteCost::time ? "cost_s" : "cost_m");
}

}  // namespace

std::vector<std::string> csv_fields(const std::string& line) {
  std::vector<std::string> fields(1);
  bool in_quotes = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char sign = line[i];
    if (in_quotes && sign == '"' && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += '"';
      ++i;
    } else if (sign == '"') {
      in_quotes = !in_quotes;
    } else if (sign == ',' && !in_quotes) {
      fields.emplace_back();
    } else if (sign != '\r' || i + 1 < line.size()) {
      fields.back() += sign;
    }
  }
  return fields;
}

BatchAnswer route_batch(const map::RoadMap& road_map, const std::filesystem::path& file,
                        const planning::RouteOptions& rules, const BatchOptions& options) {
  std::vector<Row> rows = read_rows(file);
  const Batch batch(road_map, rules, options);
  batch.place(rows);
  const std::vector<Cell> cells =
      options.matrix ? batch.answer_matrix(rows) : batch.answer_rows(rows);
  BatchAnswer answer;
  answer.csv = header(rules, options.matrix);
  Json list = Json::array();
  for (const Cell& cell : cells) {
    answer.csv += cell.csv;
    if (options.json) list.push_back(cell.json);
    ++(cell.found ? answer.found : answer.none);
  }
  for (const Row& row : rows) {
    if (row.fault.empty()) continue;
    answer.faults.push_back(fmt::format("{}:{}: {}", file.string(), row.line, row.fault));
  }
  if (!options.matrix) answer.none -= answer.faults.size();
  if (options.json) answer.json = text_of(Json{{"answers", std::move(list)}}, 1) + "\n";
  return answer;
}

}  // namespace roadbed::tools
