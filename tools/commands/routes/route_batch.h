#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "roadbed/planning/route/route.h"
#include "roadbed/planning/route/route_options.h"

namespace roadbed::tools::inline commands::inline routes {

struct RouteBatchOptions {
  bool matrix = false;  ///< from every `from` to every `to` instead of row by row
  bool json = false;    ///< make the JSON text, too
  int threads = 1;
};

/// Answers of many pairs. The texts are the same for any number of threads.
struct BatchAnswer {
  std::string csv, json;            ///< the latter empty if not asked for
  std::vector<std::string> faults;  ///< of rows that could not be used: "pairs.csv:3: …"
  std::size_t found = 0, none = 0;
};

/// Routes between the pairs of a CSV file: a header line that names the columns `from` and `to`
/// (others are ignored), then a row per pair, places as on the command line, in quotes where they
/// hold commas. Rows that cannot be used get an answer, too: what is wrong with them. By the
/// hierarchy where there are many, see planning/route/README.md.
/// @throws InputError if the file is missing, has no such header or no row at all.
BatchAnswer route_batch(const map::RoadMap& road_map, const std::filesystem::path& file,
                        const planning::RouteOptions& rules, const RouteBatchOptions& options);

}  // namespace roadbed::tools::commands::routes
