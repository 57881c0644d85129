#pragma once

#include <string>

namespace roadbed::tests {

/// An SQLite file after statements: a new one, or `from`.
std::string database_after(const std::string& statements, const std::string& from = "");

/// An SQLite file with the rows of a small table billions of times over: pages of its tree name one
/// page many times, and are themselves named so.
std::string with_endless_rows(std::string database, const std::string& table);

}  // namespace roadbed::tests
