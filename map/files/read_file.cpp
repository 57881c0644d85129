#include "roadbed/map/files/read_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <limits>
#include <map>
#include <mutex>
#include <string_view>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/sha256.h"
#include "roadbed/map/files/unpack.h"

namespace roadbed::map::inline files {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& file, const std::string& found,
                         const std::string& remedy) {
  throw InputError({.file = input_name(file), .found = found, .remedy = remedy});
}

/// An input while it is read.
class Opened {
 public:
  explicit Opened(const fs::path& file) : file_(file) {
    if (is_standard_stream(file)) {
      descriptor_ = STDIN_FILENO;
    } else {
      check_kind();
      descriptor_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    }
    if (descriptor_ < 0 || ::fstat(descriptor_, &status_) != 0) {
      refuse(file, std::string("cannot be opened: ") + std::strerror(errno), "check its rights");
    }
    if (!is_standard_stream(file) && !S_ISREG(status_.st_mode) && !is_pipe()) {
      refuse(file, "is not a file or a pipe", "name a file");
    }
  }
  ~Opened() {
    if (descriptor_ > STDIN_FILENO) ::close(descriptor_);
  }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;

  bool is_regular() const { return S_ISREG(status_.st_mode); }
  bool is_pipe() const { return S_ISFIFO(status_.st_mode) || S_ISSOCK(status_.st_mode); }
  std::size_t size() const { return static_cast<std::size_t>(status_.st_size); }

  /// Up to `size` bytes more; fewer only at the end.
  std::size_t read(char* into, std::size_t size) const {
    std::size_t there = 0;
    while (there < size) {
      const ssize_t got = ::read(descriptor_, into + there, size - there);
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) {
        refuse(file_, std::string("cannot be read to its end: ") + std::strerror(errno),
               "check the disk");
      }
      if (got == 0) break;
      there += static_cast<std::size_t>(got);
    }
    return there;
  }

 private:
  // Before it is opened: that may have effects, and waits where nobody writes to a pipe.
  void check_kind() const {
    std::error_code error;
    const fs::file_status status = fs::status(file_, error);
    if (!fs::exists(status)) refuse(file_, "no such file", "check the path");
    if (fs::is_directory(status)) refuse(file_, "is a folder", "name a file in it");
    if (fs::is_character_file(status) || fs::is_block_file(status)) {
      refuse(file_, "is a device", "name a file, or - for standard input");
    }
  }

  const fs::path& file_;
  int descriptor_ = -1;
  struct stat status_ {};
};

/// Of a regular file, which may be cut while it is read.
std::string first_bytes(const fs::path& file, std::size_t size) {
  const Opened opened(file);
  std::string bytes(std::min(size, opened.size()), '\0');
  if (opened.read(bytes.data(), bytes.size()) < bytes.size()) {
    refuse(file, "cannot be read to its end", "check the disk");
  }
  if (bytes.empty()) refuse(file, "is empty", "check how it was made");
  return bytes;
}

/// What a stream gave.
struct StreamBytes {
  std::string stored, sha256;
};

StreamBytes all_of_stream(const fs::path& file) {
  const Opened opened(file);
  std::string bytes;
  std::size_t there = 0;
  do {
    bytes.resize(std::max<std::size_t>(std::size_t{1} << 16, there + there / 2));
    there += opened.read(bytes.data() + there, bytes.size() - there);
    if (there > kMostUnpackedBytes) {
      refuse(file, fmt::format("is a stream of more than {} bytes", kMostUnpackedBytes),
             "write it to a file first");
    }
  } while (there == bytes.size());
  bytes.resize(there);
  std::string sha256 = sha256_of_bytes(bytes);
  if (bytes.empty()) refuse(file, "is empty", "check how it was made");
  bytes.shrink_to_fit();
  return {std::move(bytes), std::move(sha256)};
}

std::atomic<bool> streams_are_refused = false;

/// Read when first asked for, and kept.
const StreamBytes& stream_bytes(const fs::path& file) {
  static std::mutex mutex;
  static std::map<std::string, StreamBytes> kept;
  const std::lock_guard lock(mutex);
  const auto found = kept.find(file.native());
  if (found != kept.end()) return found->second;
  if (streams_are_refused) {
    refuse(file, "is a stream, which can be read once only", "write it to a file first");
  }
  return kept.emplace(file.native(), all_of_stream(file)).first->second;
}

std::string stored_bytes(const fs::path& file, std::size_t size) {
  return is_stream(file) ? stream_bytes(file).stored.substr(0, size) : first_bytes(file, size);
}

}  // namespace

std::string read_file(const fs::path& file, std::size_t (*most_unpacked)(std::size_t)) {
  std::string bytes = stored_bytes(file, std::numeric_limits<std::size_t>::max());
  if (!is_packed(bytes)) return bytes;
  bytes = unpacked(bytes, input_name(file), most_unpacked(bytes.size()));
  if (bytes.empty()) refuse(file, "is empty when unpacked", "check how it was made");
  return bytes;
}

std::string read_file_start(const fs::path& file, std::size_t size) {
  std::string start = stored_bytes(file, size);
  if (!is_packed(start)) return start;
  constexpr std::size_t most_stored = std::size_t{1} << 18;  // a block of Zstandard and its headers
  return unpacked_start(stored_bytes(file, std::max(size, most_stored)), size);
}

std::string stored_start(const fs::path& file, std::size_t size) {
  return is_stream(file) ? std::string() : first_bytes(file, size);
}

std::string sha256_of_file(const fs::path& file) {
  if (is_stream(file)) {
    throw InputError({.file = input_name(file),
                      .found = "is a stream, whose bytes cannot be hashed again later",
                      .needed = "a file",
                      .remedy = "write it to a file first"});
  }
  const Opened opened(file);
  if (opened.size() == 0) refuse(file, "is empty", "check how it was made");
  std::string piece(std::size_t{1} << 18, '\0');  // a map may be larger than memory
  Sha256 hash;
  std::size_t got = 0;
  do {
    got = opened.read(piece.data(), piece.size());
    hash.add(std::string_view(piece).substr(0, got));
  } while (got == piece.size());
  return hash.take_hex();
}

std::string stream_sha256(const fs::path& file) { return stream_bytes(file).sha256; }

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

bool is_stream(const fs::path& file) {
  if (is_standard_stream(file)) return true;
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  return fs::is_fifo(status) || fs::is_socket(status);
}

bool is_standard_stream(const fs::path& file) { return file == "-"; }

std::string input_name(const fs::path& file) {
  return is_standard_stream(file) ? "standard input" : file.string();
}

std::string suffix_of_input(const fs::path& file) {
  const std::string suffix = file.extension().string();
  return suffix == ".gz" || suffix == ".zst" ? file.stem().extension().string() : suffix;
}

void refuse_streams() { streams_are_refused = true; }

}  // namespace roadbed::map::files
