#pragma once

#include <sqlite3.h>

#include <cstdint>

#include "roadbed/geometry/primitives/work_limit.h"

namespace roadbed::map::inline files {

/// Has nothing run that a file of others may hold beside its rows: no view, no trigger, no function
/// of its schema; no value is longer than the file, of at least a mebibyte, and a statement ends
/// with SQLITE_INTERRUPT when it has spent the steps.
/// @param file_size  in bytes.
/// @param steps      of SQLite's machine; outlives the database.
void distrust(sqlite3* database, std::uint64_t file_size, geometry::WorkBudget& steps);

/// Whether a column of some table computes its values when it is read, for as long as it likes:
/// within one step. Also where the schema cannot be read. O(schema).
bool has_generated_columns(sqlite3* database);

}  // namespace roadbed::map::files
