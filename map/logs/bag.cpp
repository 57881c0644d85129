#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <new>

#include "roadbed/geometry/primitives/work_limit.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/untrusted_sqlite.h"
#include "roadbed/map/files/visible_text.h"
#include "roadbed/map/logs/containers.h"
#include "roadbed/map/logs/message_unpacker.h"

namespace roadbed::map::inline logs {
namespace {

namespace fs = std::filesystem;

struct Close {
  void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Database = std::unique_ptr<sqlite3, Close>;
using Statement = std::unique_ptr<sqlite3_stmt, Close>;

class BagReader {
 public:
  BagReader(Database database, std::string name, std::uint64_t size, const LogVisitor& visitor)
      : database_(std::move(database)),
        name_(std::move(name)),
        size_(size),
        steps_(geometry::most_steps(size / 64)),  // a row of few bytes takes fewer
        unread_(size),
        unpacker_(name_, size),
        visitor_(visitor) {
    distrust(database_.get(), size, steps_);
  }

  void run() {
    std::map<std::int64_t, LogTopic> topics;
    const std::string fault = schema_fault(database_.get());
    if (!fault.empty()) refuse("", fault);
    const Statement of_topics = prepared("select id, name, type, serialization_format from topics");
    while (step(of_topics)) {
      count({bytes_of(of_topics, 1), bytes_of(of_topics, 2), bytes_of(of_topics, 3)});
      const LogTopic topic{text(of_topics, 1), text(of_topics, 2), text(of_topics, 3)};
      if (visitor_.wants(topic)) topics[sqlite3_column_int64(of_topics.get(), 0)] = topic;
    }
    if (topics.empty()) return;
    const Statement messages = prepared("select topic_id, timestamp, id, data from messages");
    while (step(messages)) {
      count({bytes_of(messages, 3)});
      const auto found = topics.find(sqlite3_column_int64(messages.get(), 0));
      if (found != topics.end()) take(found->second, messages);
    }
  }

 private:
  [[noreturn]] void refuse(const std::string& place, const std::string& found) const {
    throw InputError({.file = name_,
                      .place = place,
                      .found = found,
                      .needed = "an SQLite file as rosbag2 writes it",
                      .remedy = "copy or record the bag anew"});
  }

  Statement prepared(const char* sql) const {
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(database_.get(), sql, -1, &statement, nullptr) != SQLITE_OK) {
      refuse("", one_line(sqlite3_errmsg(database_.get())));
    }
    return Statement(statement);
  }

  bool step(const Statement& statement) const {
    const int status = sqlite3_step(statement.get());
    if (status == SQLITE_ROW) return true;
    if (status != SQLITE_DONE) refuse("", one_line(sqlite3_errmsg(database_.get())));
    return false;
  }

  static std::string_view bytes_of(const Statement& row, int column) {
    const auto* bytes = static_cast<const char*>(sqlite3_column_blob(row.get(), column));
    if (bytes == nullptr) return {};
    return {bytes, static_cast<std::size_t>(sqlite3_column_bytes(row.get(), column))};
  }
  static std::string text(const Statement& row, int column) {
    return one_line(std::string(bytes_of(row, column)));
  }

  // Rows and what they hold are stored once each; pages that several of a damaged tree's branches
  // name would be read without end.
  void count(std::initializer_list<std::string_view> row) {
    std::size_t bytes = 1;
    for (const std::string_view cell : row) bytes += cell.size();
    if (!unread_.spend(bytes)) refuse("", fmt::format("more rows than {} bytes can hold", size_));
    if (pages_looked_up(database_.get()) > most_pages_looked_up(size_)) {
      refuse("", "rows that share pages");
    }
  }

  void take(const LogTopic& topic, const Statement& row) {
    const std::string_view bytes = bytes_of(row, 3);
    const std::string place = fmt::format("message {}", sqlite3_column_int64(row.get(), 2));
    const std::int64_t received_ns = sqlite3_column_int64(row.get(), 1);
    if (!is_usable_time(received_ns)) refuse(place, fmt::format("a time of {} ns", received_ns));
    visitor_.take(topic, {received_ns, unpacker_.unpacked(topic, bytes, place), place});
  }

  Database database_;
  std::string name_;
  std::uint64_t size_;
  geometry::WorkBudget steps_, unread_;
  MessageUnpacker unpacker_;
  const LogVisitor& visitor_;
};

[[noreturn]] void refuse_to_open(const std::string& name) {
  throw InputError({.file = name, .found = "cannot be opened as SQLite", .remedy = "copy it anew"});
}

/// Rows that were not put in the file itself yet: it was not closed, or was copied meanwhile.
std::uint64_t size_of_write_ahead_log(const fs::path& file) {
  std::error_code none;
  const std::uint64_t size = fs::file_size(fs::canonical(file).concat("-wal"), none);
  return none ? 0 : size;
}

/// Escaped as a URI needs it. Nothing is ever written beside the file: no locks, and the index of
/// a write-ahead log is in memory.
std::string uri_of(const fs::path& file, bool has_write_ahead_log) {
  std::string uri = "file:";
  for (const char sign : fs::absolute(file).string()) {
    if (sign == '%' || sign == '?' || sign == '#') {
      uri += fmt::format("%{:02X}", static_cast<unsigned char>(sign));
    } else {
      uri += sign;
    }
  }
  return uri + (has_write_ahead_log ? "?mode=ro&vfs=unix-none" : "?mode=ro&immutable=1");
}

}  // namespace

void read_bag_file(const fs::path& file, const LogVisitor& visitor) {
  const std::uint64_t ahead = size_of_write_ahead_log(file);
  sqlite3* made = nullptr;
  const int status = sqlite3_open_v2(uri_of(file, ahead > 0).c_str(), &made,
                                     SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
  Database database(made);
  if (status != SQLITE_OK) refuse_to_open(file.string());
  // Else a write-ahead log without whole transactions would be deleted.
  sqlite3_db_config(made, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
  sqlite3_exec(made, "pragma locking_mode = exclusive", nullptr, nullptr, nullptr);
  BagReader(std::move(database), file.string(), fs::file_size(file) + ahead, visitor).run();
}

void parse_bag(std::string_view bytes, const std::string& name, const LogVisitor& visitor) {
  sqlite3* made = nullptr;
  const int status = sqlite3_open(":memory:", &made);
  Database database(made);
  if (status != SQLITE_OK) throw std::bad_alloc();
  // Read only: SQLite's interface is older than const.
  auto* image = reinterpret_cast<unsigned char*>(const_cast<char*>(bytes.data()));
  const auto size = static_cast<sqlite3_int64>(bytes.size());
  if (sqlite3_deserialize(made, "main", image, size, size, SQLITE_DESERIALIZE_READONLY) !=
      SQLITE_OK) {
    refuse_to_open(name);
  }
  BagReader(std::move(database), name, bytes.size(), visitor).run();
}

}  // namespace roadbed::map::logs
