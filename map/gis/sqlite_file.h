#pragma once

#include <memory>
#include <string>
#include <vector>

#include "roadbed/map/gis/layers.h"

struct sqlite3;
struct sqlite3_stmt;

namespace roadbed::map::inline gis {

/// An SQLite database in memory, for writing only; its bytes depend on nothing but what was put in
/// (and the version of SQLite).
class SqliteFile {
 public:
  SqliteFile();

  /// Runs statements that return nothing. @throws std::invalid_argument if SQLite refuses them.
  void run(const std::string& sql);

  /// A statement that is run once per row: "insert into t values (?, ?)".
  class Insert {
   public:
    Insert(SqliteFile& file, const std::string& sql);
    Insert& text(const std::string& value);
    Insert& blob(const std::string& bytes);  ///< NULL if empty
    Insert& number(double value);
    Insert& whole(std::int64_t value);
    Insert& value(const Value& value);  ///< lists as JSON
    void run();

   private:
    struct Finalize {
      void operator()(sqlite3_stmt* statement) const;
    };
    std::unique_ptr<sqlite3_stmt, Finalize> statement_;
    int next_ = 1;
  };

  /// The database as the bytes of a file.
  std::string bytes() const;

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  std::unique_ptr<sqlite3, Close> database_;
};

/// A name as SQL quotes it.
std::string sql_name(const std::string& name);

}  // namespace roadbed::map::gis
