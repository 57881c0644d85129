#include "roadbed/tools/files/od_csv.h"

#include <fmt/format.h>

#include "roadbed/tools/files/csv.h"

namespace roadbed::tools::inline files {

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

}  // namespace roadbed::tools
