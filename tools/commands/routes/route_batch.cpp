#include "roadbed/tools/commands/routes/route_batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "roadbed/map/files/csv_field.h"
#include "roadbed/map/files/in_threads.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/planning/route/hierarchy_search.h"
#include "roadbed/planning/route/no_route_explanation.h"
#include "roadbed/planning/route/route_solver.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tools/cli/place.h"
#include "roadbed/tools/commands/routes/route_output.h"
#include "roadbed/tools/files/json.h"
#include "roadbed/tools/files/points_csv.h"

namespace roadbed::tools::inline commands::inline routes {
namespace {

struct PairRow : OdRow {
  std::optional<planning::RoutePlace> from_place, to_place;
};

/// What became of a row, or of all pairs that begin with it.
struct RowAnswers {
  std::string csv = {}, json = {};  ///< lines; elements of an array
  std::size_t found = 0, none = 0;
};

// One more element of an array in a document that is indented by one space a level.
void add_element(const std::string& json, std::string& array) {
  array += array.empty() ? "\n  " : ",\n  ";
  for (const char sign : json) {
    array += sign;
    if (sign == '\n') array += "  ";
  }
}

void refuse_many_pairs(const std::filesystem::path& file, std::size_t rows, bool json) {
  const std::size_t most = json ? 750'000 : 2'500'000;
  if (rows * rows <= most) return;
  throw map::InputError(
      {.file = map::input_name(file),
       .found = fmt::format("{} rows, of which a matrix has {} pairs", rows, rows * rows),
       .needed = fmt::format("at most {} pairs{}", most, json ? " in a JSON document" : ""),
       .remedy = json ? "write it with -o, or ask in parts" : "ask in parts"});
}

void place_row(const map::RoadMap& road_map, const planning::Router& router,
               map::Participant participant, PairRow& row) {
  try {
    row.from_place = find_place(road_map, row.from, participant).for_route();
    row.to_place = find_place(road_map, row.to, participant).for_route();
  } catch (const map::InputError& error) {
    row.fault = error.what();
    return;
  }
  row.fault = router.unfit(*row.from_place, "start");
  if (row.fault.empty()) row.fault = router.unfit(*row.to_place, "goal");
}

std::vector<PairRow> read_rows(const std::filesystem::path& file) {
  std::vector<PairRow> rows;
  for (OdRow& row :
       parse_od_csv(map::read_file(file, map::most_unpacked_of_rows), map::input_name(file))) {
    rows.push_back({std::move(row), {}, {}});
  }
  return rows;
}

class Batch {
 public:
  Batch(const map::RoadMap& road_map, const planning::RouteOptions& rules,
        const RouteBatchOptions& options)
      : road_map_(road_map),
        options_(options),
        router_(road_map, rules),
        solver_(router_.solver()) {
    router_.prepare();
  }

  void place(std::vector<PairRow>& rows) const {
    map::in_threads(rows.size(), options_.threads, [&](std::size_t i) {
      if (rows[i].fault.empty()) {
        place_row(road_map_, router_, router_.options().participant, rows[i]);
      }
    });
  }

  std::vector<RowAnswers> answer_rows(const std::vector<PairRow>& rows) const {
    std::vector<RowAnswers> answers(rows.size());
    map::in_threads(
        rows.size(), options_.threads,
        [&] {
          return Own{planning::HierarchySearch(solver_.metric()), {}};
        },
        [&](Own& own, std::size_t i) { answers[i] = answer(own, rows[i]); });
    return answers;
  }

  std::vector<RowAnswers> answer_matrix(const std::vector<PairRow>& rows) const {
    std::vector<planning::ClimbedSpace> goals(rows.size());
    const auto make = [&] { return planning::HierarchySearch(solver_.metric()); };
    map::in_threads(
        rows.size(), options_.threads, make, [&](planning::HierarchySearch& search, std::size_t i) {
          if (!rows[i].fault.empty()) return;
          const auto end = arrive_at(solver_.graph(), solver_.model(), *rows[i].to_place);
          goals[i] = search.climb(end.seeds, true);
        });
    std::vector<RowAnswers> answers(rows.size());
    map::in_threads(
        rows.size(), options_.threads, make, [&](planning::HierarchySearch& search, std::size_t i) {
          if (!rows[i].fault.empty()) return;
          const auto end = leave_from(solver_.graph(), solver_.model(), *rows[i].from_place);
          const planning::ClimbedSpace start = search.climb(end.seeds, false);
          for (std::size_t j = 0; j < rows.size(); ++j) {
            if (!rows[j].fault.empty()) continue;
            add_pair(rows[i], rows[j], start, goals[j], answers[i]);
          }
        });
    return answers;
  }

 private:
  /// What each thread has for itself.
  struct Own {
    planning::HierarchySearch search;
    std::optional<planning::NoRouteExplainer> obstacles;
  };

  RowAnswers answer(Own& own, const PairRow& row) const {
    if (!row.fault.empty()) return none(row, row.fault);
    planning::RouteTask task = solver_.task(*row.from_place, *row.to_place);
    const planning::GraphPath path = own.search.find(task.start.seeds, task.goal.seeds);
    const auto way = solver_.answer(std::move(task), path);
    if (!way) return no_route(own, row);
    const planning::Route route = router_.route_along(*way);
    std::string lanes;
    for (const planning::RouteLeg& leg : route.legs) {
      lanes += (lanes.empty() ? "" : " ") + road_map_.lane(leg.lane).name;
    }
    RowAnswers of_row{.csv = {}, .json = {}, .found = 1};
    of_row.csv =
        fmt::format("{},{},{},1,{:.4f},{:.4f},{:.3f},{},{},\n", row.line, map::csv_field(row.from),
                    map::csv_field(row.to), route.cost_s, route.cost_m, route.length_m,
                    route.lane_changes, map::csv_field(lanes));
    if (options_.json) add_with_row(route_json(road_map_, route), row, of_row);
    return of_row;
  }

  RowAnswers none(const PairRow& row, const std::string& reason) const {
    RowAnswers of_row{.csv = {}, .json = {}, .found = 0, .none = 1};
    of_row.csv = fmt::format("{},{},{},0,,,,,,{}\n", row.line, map::csv_field(row.from),
                             map::csv_field(row.to), map::csv_field(reason));
    if (options_.json) add_with_row({{"found", false}, {"reason", reason}}, row, of_row);
    return of_row;
  }

  // The table says that there is none, the document why.
  RowAnswers no_route(Own& own, const PairRow& row) const {
    const planning::RoutePlace from = *row.from_place, to = *row.to_place;
    RowAnswers of_row =
        none(row, fmt::format("no lane sequence leads from lane {} to lane {}",
                              road_map_.lane(from.lane).name, road_map_.lane(to.lane).name));
    if (!options_.json) return of_row;
    if (!own.obstacles) own.obstacles.emplace(road_map_, solver_);
    planning::RouteAnswer answer;
    answer.explanation = own.obstacles->find(from, to);
    answer.reason = describe(road_map_, from, to, *answer.explanation);
    of_row.json.clear();
    add_with_row(no_route_json(road_map_, answer), row, of_row);
    return of_row;
  }

  static void add_with_row(Json json, const PairRow& row, RowAnswers& answers) {
    json["row"] = row.line;
    add_element(text_of(json, 1), answers.json);
  }

  void add_pair(const PairRow& from, const PairRow& to, const planning::ClimbedSpace& start,
                const planning::ClimbedSpace& goal, RowAnswers& answers) const {
    planning::Ticks ticks = cost_between(start, goal);
    const auto direct = direct_way(solver_.model(), *from.from_place, *to.to_place);
    if (direct) ticks = std::min(ticks, direct->cost);
    const planning::RouteCost measure = solver_.options().cost;
    const double cost = static_cast<double>(ticks) / planning::ticks_per_unit(measure);
    const bool found = ticks != planning::kNever;
    ++(found ? answers.found : answers.none);
    answers.csv +=
        fmt::format("{},{},{},{},{},{}\n", from.line, to.line, map::csv_field(from.from),
                    map::csv_field(to.to), found ? 1 : 0, found ? fmt::format("{:.4f}", cost) : "");
    if (!options_.json) return;
    Json json = {{"from_row", from.line}, {"to_row", to.line}, {"found", found}};
    if (found) json[measure == planning::RouteCost::time ? "cost_s" : "cost_m"] = cost;
    add_element(text_of(json, 1), answers.json);
  }

  const map::RoadMap& road_map_;
  const RouteBatchOptions& options_;
  planning::Router router_;
  const planning::RouteSolver& solver_;
};

std::string header(const planning::RouteOptions& rules, bool matrix) {
  if (!matrix) return "row,from,to,found,cost_s,cost_m,length_m,lane_changes,lanes,reason\n";
  return fmt::format("from_row,to_row,from,to,found,{}\n",
                     rules.cost == planning::RouteCost::time ? "cost_s" : "cost_m");
}

}  // namespace

BatchAnswer route_batch(const map::RoadMap& road_map, const std::filesystem::path& file,
                        const planning::RouteOptions& rules, const RouteBatchOptions& options) {
  std::vector<PairRow> rows = read_rows(file);
  if (options.matrix) refuse_many_pairs(file, rows.size(), options.json);
  const Batch batch(road_map, rules, options);
  batch.place(rows);
  std::vector<RowAnswers> answers =
      options.matrix ? batch.answer_matrix(rows) : batch.answer_rows(rows);
  BatchAnswer answer;
  answer.csv = header(rules, options.matrix);
  std::size_t csv_bytes = answer.csv.size(), json_bytes = 100;
  for (const RowAnswers& row : answers) {
    csv_bytes += row.csv.size();
    json_bytes += row.json.size() + 1;
  }
  answer.csv.reserve(csv_bytes);
  std::string documents;
  documents.reserve(json_bytes);
  for (RowAnswers& each : answers) {  // one at a time, so that all is there once
    const RowAnswers row = std::move(each);
    answer.csv += row.csv;
    if (!documents.empty() && !row.json.empty()) documents += ',';
    documents += row.json;
    answer.found += row.found;
    answer.none += row.none;
  }
  for (const PairRow& row : rows) {
    if (row.fault.empty()) continue;
    answer.faults.push_back(fmt::format("{}:{}: {}", map::input_name(file), row.line, row.fault));
  }
  if (!options.matrix) answer.none -= answer.faults.size();
  if (!documents.empty()) documents += "\n ";
  if (options.json)
    answer.json = "{\n \"roadbed_routes\": 1,\n \"answers\": [" + documents + "]\n}\n";
  return answer;
}

}  // namespace roadbed::tools::commands::routes
