#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/geometry/primitives/work_limit.h"

struct sqlite3;

namespace roadbed::map::inline files {

/// Has nothing run that a file of others may hold beside its rows: no view, no trigger, no function
/// of its schema; no value is longer than the file, of at least a mebibyte, and a statement ends
/// with SQLITE_INTERRUPT when it has spent the steps.
/// @param file_size  in bytes.
/// @param steps      of SQLite's machine; outlives the database.
void distrust(sqlite3* database, std::uint64_t file_size, geometry::WorkBudget& steps);

/// What speaks against reading a table: that a column of some table computes its values when it is
/// read, within one step and for as long as it likes; or what SQLite says of the schema. Empty:
/// nothing does. O(schema).
std::string schema_fault(sqlite3* database);

/// Pages that were looked up since the database was opened, again each time: what rows cost whose
/// branches or overflowing bytes share pages, which SQLite follows within one step.
std::size_t pages_looked_up(sqlite3* database);

/// How many of them reading each row of a file of such size once can take.
constexpr std::size_t most_pages_looked_up(std::uint64_t file_size) {
  constexpr std::uint64_t page = 4096;
  return geometry::most_steps(file_size / page);
}

}  // namespace roadbed::map::files
