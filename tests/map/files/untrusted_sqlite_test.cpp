#include "roadbed/map/files/untrusted_sqlite.h"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <memory>
#include <string>

namespace roadbed::map {
namespace {

struct Close {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};
using Database = std::unique_ptr<sqlite3, Close>;

Database database_of(const std::string& statements) {
  sqlite3* made = nullptr;
  EXPECT_EQ(sqlite3_open(":memory:", &made), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(made, statements.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
      << sqlite3_errmsg(made);
  return Database(made);
}

TEST(UntrustedSqlite, TellsColumnsThatComputeTheirValues) {
  const std::string plain = "create table rows(id integer primary key, text);";
  EXPECT_EQ(schema_fault(database_of(plain).get()), "");
  for (const std::string kind : {"", " virtual", " stored"}) {
    const Database computes =
        database_of(plain + "create table more(a, b as (length(a))" + kind + ");");
    EXPECT_EQ(schema_fault(computes.get()), "a column that computes its values") << kind;
  }
}

TEST(UntrustedSqlite, OfAFileWithTablesOfModulesHasNone) {
  EXPECT_EQ(schema_fault(database_of("create virtual table boxes using rtree(id, a, b);").get()),
            "");
}

TEST(UntrustedSqlite, SaysWhatIsWrongWithAFileThatIsNone) {
  sqlite3* opened = nullptr;
  ASSERT_EQ(sqlite3_open(":memory:", &opened), SQLITE_OK);
  const Database database(opened);
  std::string bytes(4096, 'x');
  ASSERT_EQ(sqlite3_deserialize(opened, "main", reinterpret_cast<unsigned char*>(bytes.data()),
                                4096, 4096, SQLITE_DESERIALIZE_READONLY),
            SQLITE_OK);
  EXPECT_EQ(schema_fault(opened), "file is not a database");
}

TEST(UntrustedSqlite, RunsNoViewMakesNoLongValueAndEnds) {
  const Database database = database_of("create table t(a); create view v as select a from t;");
  geometry::WorkBudget steps(100'000);
  distrust(database.get(), 4096, steps);
  const auto status = [&](const char* question) {
    return sqlite3_exec(database.get(), question, nullptr, nullptr, nullptr);
  };
  EXPECT_EQ(status("select a from t"), SQLITE_OK);
  EXPECT_EQ(status("select a from v"), SQLITE_ERROR);
  EXPECT_EQ(status("select zeroblob(2000000)"), SQLITE_TOOBIG);
  EXPECT_EQ(status("with recursive n(i) as (select 1 union all select i + 1 from n) "
                   "select max(i) from n"),
            SQLITE_INTERRUPT);
}

}  // namespace
}  // namespace roadbed::map
