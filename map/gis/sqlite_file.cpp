#include "roadbed/map/gis/sqlite_file.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "roadbed/map/files/json_text.h"

namespace roadbed::map::inline gis {
namespace {

void check(int status, const std::string& what) {
  if (status == SQLITE_OK || status == SQLITE_DONE) return;
  throw std::invalid_argument(fmt::format("SqliteFile: {}: {}", sqlite3_errstr(status), what));
}

std::string json_list(const std::vector<std::string>& texts) {
  return json_text(nlohmann::json(texts));
}

}  // namespace

void SqliteFile::Close::operator()(sqlite3* database) const { sqlite3_close(database); }
void SqliteFile::Insert::Finalize::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

SqliteFile::SqliteFile() {
  sqlite3* database = nullptr;
  const int status = sqlite3_open(":memory:", &database);
  database_.reset(database);
  check(status, "open");
  run("pragma page_size = 4096; pragma encoding = 'UTF-8'");
}

void SqliteFile::run(const std::string& sql) {
  check(sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr), sql);
}

std::string SqliteFile::bytes() const {
  sqlite3_int64 size = 0;
  const std::unique_ptr<unsigned char, decltype(&sqlite3_free)> image(
      sqlite3_serialize(database_.get(), "main", &size, 0), sqlite3_free);
  if (!image) throw std::bad_alloc();
  return {reinterpret_cast<const char*>(image.get()), static_cast<std::size_t>(size)};
}

SqliteFile::Insert::Insert(SqliteFile& file, const std::string& sql) {
  sqlite3_stmt* statement = nullptr;
  const int status = sqlite3_prepare_v2(file.database_.get(), sql.c_str(), -1, &statement, nullptr);
  statement_.reset(statement);
  check(status, sql);
}

SqliteFile::Insert& SqliteFile::Insert::text(const std::string& value) {
  const auto size = static_cast<sqlite3_uint64>(value.size());
  check(sqlite3_bind_text64(statement_.get(), next_++, value.data(), size, SQLITE_TRANSIENT,
                            SQLITE_UTF8),
        "text");
  return *this;
}

SqliteFile::Insert& SqliteFile::Insert::blob(const std::string& bytes) {
  const int status = bytes.empty() ? sqlite3_bind_null(statement_.get(), next_++)
                                   : sqlite3_bind_blob64(statement_.get(), next_++, bytes.data(),
                                                         bytes.size(), SQLITE_TRANSIENT);
  check(status, "blob");
  return *this;
}

SqliteFile::Insert& SqliteFile::Insert::number(double value) {
  check(sqlite3_bind_double(statement_.get(), next_++, value), "number");
  return *this;
}

SqliteFile::Insert& SqliteFile::Insert::whole(std::int64_t value) {
  check(sqlite3_bind_int64(statement_.get(), next_++, value), "whole number");
  return *this;
}

SqliteFile::Insert& SqliteFile::Insert::value(const Value& value) {
  if (const bool* truth = std::get_if<bool>(&value)) return whole(*truth ? 1 : 0);
  if (const auto* held = std::get_if<std::int64_t>(&value)) return whole(*held);
  if (const double* held = std::get_if<double>(&value)) return number(*held);
  if (const auto* held = std::get_if<std::string>(&value)) return text(*held);
  if (const auto* held = std::get_if<std::vector<std::string>>(&value)) {
    return text(json_list(*held));
  }
  check(sqlite3_bind_null(statement_.get(), next_++), "null");
  return *this;
}

void SqliteFile::Insert::run() {
  check(sqlite3_step(statement_.get()), "step");
  check(sqlite3_reset(statement_.get()), "reset");
  next_ = 1;
}

std::string sql_name(const std::string& name) {
  std::string quoted = "\"";
  for (const char c : name) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace roadbed::map::gis
