#include "roadbed/map/files/untrusted_sqlite.h"

#include <sqlite3.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "roadbed/map/files/visible_text.h"

namespace roadbed::map::inline files {
namespace {

constexpr int kStepsAtOnce = 1000;
constexpr std::uint64_t kLeastLength = 1 << 20, kMostLength = std::numeric_limits<int>::max();

int spend(void* budget) {
  return static_cast<geometry::WorkBudget*>(budget)->spend(kStepsAtOnce) ? 0 : 1;
}

}  // namespace

void distrust(sqlite3* database, std::uint64_t file_size, geometry::WorkBudget& steps) {
  sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_limit(database, SQLITE_LIMIT_LENGTH,
                static_cast<int>(std::clamp(file_size, kLeastLength, kMostLength)));
  sqlite3_progress_handler(database, kStepsAtOnce, spend, &steps);
}

std::string schema_fault(sqlite3* database) {
  constexpr const char* kQuestion =
      "select 1 from sqlite_schema s, pragma_table_xinfo(s.name) c "
      "where s.type = 'table' and s.sql not like 'create virtual%' and c.hidden > 1";
  sqlite3_stmt* prepared = nullptr;
  const int status = sqlite3_prepare_v2(database, kQuestion, -1, &prepared, nullptr);
  const std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)> statement(prepared,
                                                                             sqlite3_finalize);
  const int step = status == SQLITE_OK ? sqlite3_step(prepared) : status;
  if (step == SQLITE_DONE) return {};
  if (step == SQLITE_ROW) return "a column that computes its values";
  if (step == SQLITE_INTERRUPT)
    return "a schema that takes longer to read than its size can ask for";
  return one_line(sqlite3_errmsg(database));
}

std::size_t pages_looked_up(sqlite3* database) {
  std::size_t sum = 0;
  for (const int which : {SQLITE_DBSTATUS_CACHE_HIT, SQLITE_DBSTATUS_CACHE_MISS}) {
    int count = 0, unused = 0;
    sqlite3_db_status(database, which, &count, &unused, 0);
    sum += static_cast<std::size_t>(count);
  }
  return sum;
}

}  // namespace roadbed::map::files
