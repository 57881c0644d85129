#include "roadbed/tests/support/endless_rows.h"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace roadbed::tests {
namespace {

// The copy that it reads and writes is SQLite's.
sqlite3* opened(const std::string& database) {
  sqlite3* file = nullptr;
  sqlite3_open(":memory:", &file);
  if (database.empty()) return file;
  auto* copy = static_cast<unsigned char*>(sqlite3_malloc64(database.size()));
  std::ranges::copy(database, copy);
  const auto size = static_cast<sqlite3_int64>(database.size());
  sqlite3_deserialize(file, "main", copy, size, size,
                      SQLITE_DESERIALIZE_FREEONCLOSE | SQLITE_DESERIALIZE_RESIZEABLE);
  return file;
}

std::size_t root_page(const std::string& database, const std::string& table) {
  if (table == "sqlite_schema") return 1;
  sqlite3* file = opened(database);
  sqlite3_stmt* question = nullptr;
  const std::string text = "select rootpage from sqlite_schema where name = '" + table + "'";
  sqlite3_prepare_v2(file, text.c_str(), -1, &question, nullptr);
  sqlite3_step(question);
  const int page = sqlite3_column_int(question, 0);
  sqlite3_finalize(question);
  sqlite3_close(file);
  return static_cast<std::size_t>(page);
}

std::string big_endian(std::size_t value, int bytes) {
  std::string text;
  for (int i = bytes; i-- > 0;) text += static_cast<char>(value >> 8 * i);
  return text;
}

}  // namespace

std::string database_after(const std::string& statements, const std::string& from) {
  sqlite3* file = opened(from);
  char* fault = nullptr;
  sqlite3_exec(file, statements.c_str(), nullptr, nullptr, &fault);
  EXPECT_EQ(fault, nullptr) << fault;
  sqlite3_free(fault);
  sqlite3_int64 size = 0;
  unsigned char* image = sqlite3_serialize(file, "main", &size, 0);
  std::string bytes(reinterpret_cast<const char*>(image), static_cast<std::size_t>(size));
  sqlite3_free(image);
  sqlite3_close(file);
  return bytes;
}

// [https://www.sqlite.org/fileformat2.html, 1.6]
std::string with_endless_rows(std::string database, const std::string& table) {
  constexpr std::size_t page = 4096, cells = 600, levels = 4;
  const std::size_t number = root_page(database, table);
  const std::size_t before = number == 1 ? 100 : 0;  // the file's head, in its first page
  const std::size_t root = (number - 1) * page;
  std::string leaf = database.substr(root, page);
  const std::size_t places = 8 + 2 * static_cast<unsigned char>(leaf[before + 4]);
  leaf.replace(0, places, leaf.substr(before, places));
  database += leaf;
  for (std::size_t level = 1; level <= levels; ++level) {
    const std::size_t child = database.size() / page, start = level < levels ? 0 : before;
    std::string inner = "\x05" + big_endian(0, 2) + big_endian(cells, 2) + big_endian(page - 5, 2) +
                        big_endian(0, 1) + big_endian(child, 4);
    for (std::size_t i = 0; i < cells; ++i) inner += big_endian(page - 5, 2);
    inner.resize(page - 5 - start);
    inner += big_endian(child, 4) + big_endian(1, 1);
    if (level < levels) {
      database += inner;
    } else {
      database.replace(root + before, inner.size(), inner);
    }
  }
  return database.replace(28, 4, big_endian(database.size() / page, 4));
}

}  // namespace roadbed::tests
