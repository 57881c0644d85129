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

PointTable parse_point_table(std::string_view bytes, const std::string& name) {
  constexpr double farthest_m = 1e9, most_lon_deg = 180.0, most_lat_deg = 90.0;
  CsvReader table(bytes, name);
  PointTable read;
  read.is_lon_lat = !table.find_column("x_m") && !table.find_column("x") &&
                    table.find_column("lon_deg").has_value();
  const std::size_t x =
      read.is_lon_lat ? table.column("lon_deg", "lon_deg,lat_deg") : column_of_axis(table, "x_m");
  const std::size_t y =
      read.is_lon_lat ? table.column("lat_deg", "lon_deg,lat_deg") : column_of_axis(table, "y_m");
  const double most_x = read.is_lon_lat ? most_lon_deg : farthest_m;
  const double most_y = read.is_lon_lat ? most_lat_deg : farthest_m;
  while (table.next_row()) {
    table.check_width();
    read.points.emplace_back(table.number(x, -most_x, most_x), table.number(y, -most_y, most_y));
  }
  if (read.points.empty()) table.refuse("rows", "there is none", "at least one below the header");
  return read;
}

PointTable read_point_table(const std::filesystem::path& file) {
  return parse_point_table(map::read_file(file, map::most_unpacked_of_rows), map::input_name(file));
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
