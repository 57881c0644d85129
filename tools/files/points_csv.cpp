#include "roadbed/tools/files/points_csv.h"

#include <fmt/format.h>

#include "roadbed/map/files/read_file.h"
#include "roadbed/tools/files/csv.h"

namespace roadbed::tools::inline files {
namespace {

std::size_t column_of_axis(const CsvReader& table, std::string_view name) {
  const auto without_unit = table.find_column(name.substr(0, 1));
  return without_unit && !table.find_column(name) ? *without_unit : table.column(name, "x_m,y_m");
}

}  // namespace

std::vector<Eigen::Vector2d> parse_points_csv(std::string_view bytes, const std::string& name) {
  constexpr double farthest_m = 1e9;
  CsvReader table(bytes, name);
  const std::size_t x = column_of_axis(table, "x_m"), y = column_of_axis(table, "y_m");
  std::vector<Eigen::Vector2d> points;
  while (table.next_row()) {
    table.check_width();
    points.emplace_back(table.number(x, -farthest_m, farthest_m),
                        table.number(y, -farthest_m, farthest_m));
  }
  if (points.empty()) table.refuse("rows", "there is none", "at least one below the header");
  return points;
}

std::vector<Eigen::Vector2d> read_points_csv(const std::filesystem::path& file) {
  return parse_points_csv(map::read_file(file), file.string());
}

std::vector<OdRow> parse_od_csv(std::string_view bytes, const std::string& name) {
  CsvReader table(bytes, name);
  const std::size_t from = table.column("from", "from,to"), to = table.column("to", "from,to");
  std::vector<OdRow> rows;
  while (table.next_row()) {
    const std::vector<std::string>& fields = table.fields();
    OdRow& row = rows.emplace_back();
    row.line = table.line();
    if (fields.size() == table.width()) {
      row.from = fields[from];
      row.to = fields[to];
    } else {
      row.fault = fmt::format("{} fields, the header has {}; put places with commas in quotes",
                              fields.size(), table.width());
    }
  }
  if (rows.empty()) table.refuse("row", "there is none", "a pair a row below the header");
  return rows;
}

}  // namespace roadbed::tools::files
