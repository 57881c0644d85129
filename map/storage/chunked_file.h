#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace roadbed::map::inline storage {

/// Named sections of bytes in one file, which are fetched and checked in chunks of 64 KiB when
/// something in them is first asked for. The picture is in map/README.md.
///
/// Bytes are read into memory of our own, never mapped: a file that shrinks or changes while it is
/// open gives an InputError, not a signal. Safe to read from several threads.
class ChunkedFile {
 public:
  static constexpr std::size_t kChunkSize = 64 * 1024;
  static constexpr std::string_view kMagic = "roadbed map v003";

  /// A section's place in the file's body.
  struct Section {
    std::array<char, 16> name{};
    std::uint64_t offset = 0, size = 0;
  };

  /// Reads and checks the header and the section table, and nothing else. O(size / 8192).
  /// @throws InputError if it cannot be read, or its header is damaged or of another version.
  static std::shared_ptr<const ChunkedFile> open(const std::filesystem::path& file);

  /// The same of bytes in memory; `name` stands for the file in messages.
  static std::shared_ptr<const ChunkedFile> from_bytes(std::string bytes, std::string name);

  ~ChunkedFile();
  ChunkedFile(const ChunkedFile&) = delete;
  ChunkedFile& operator=(const ChunkedFile&) = delete;

  bool has(std::string_view name) const;

  /// @throws InputError if there is no such section.
  const Section& section(std::string_view name) const;

  /// Where a section's bytes will be once ensure_loaded() has been called for them; aligned to 64
  /// bytes.
  const std::byte* data(const Section& section) const { return body_ + section.offset; }

  /// Fetches and checks the chunks that hold some bytes of a section.
  /// @throws InputError if the bytes are not in the section, or cannot be read, or are damaged.
  void ensure_loaded(const Section& section, std::uint64_t from, std::uint64_t size) const {
    if (size > section.size || from > section.size - size) refuse_range(section);
    if (size == 0) return;
    const std::uint64_t first = (section.offset + from) / kChunkSize;
    const std::uint64_t last = (section.offset + from + size - 1) / kChunkSize;
    for (std::uint64_t chunk = first; chunk <= last; ++chunk) {
      if (!checked_[chunk].load(std::memory_order_acquire)) fetch(chunk);
    }
  }

  /// Checks every chunk, a few in memory at once, and lets go of all; see evict_all().
  void check_all() const;

  std::size_t chunks() const { return hashes_.size(); }

  /// How many chunks have been fetched so far and are in memory.
  std::size_t chunks_in_memory() const { return fetched_.load(std::memory_order_relaxed); }

  /// Lets go of all chunks, which are fetched again when needed: for who goes through a file that
  /// memory does not hold. Whatever data() pointed to is gone; nobody may be reading meanwhile.
  void evict_all() const;

  /// The same where more are in memory than stand in the way of nobody.
  void evict_over_budget() const {
    if (chunks_in_memory() > kMany) evict_all();
  }
  const std::string& name() const { return name_; }

  /// Throws InputError that asks for the file to be compiled again.
  [[noreturn]] void refuse(const std::string& element, const std::string& found) const;

 private:
  class Source;
  ChunkedFile(std::unique_ptr<const Source> source, std::string name);

  static constexpr std::size_t kMany = 512;  // 32 MiB

  void read_header();
  void fetch(std::uint64_t chunk) const;
  [[noreturn]] void refuse_range(const Section& section) const;

  std::unique_ptr<const Source> source_;
  std::string name_;
  std::uint64_t body_offset_ = 0, body_size_ = 0;
  std::vector<Section> sections_;
  std::vector<std::uint64_t> hashes_;
  std::byte* body_ = nullptr;  // address space for the body; pages appear as chunks are fetched
  mutable std::mutex mutex_;
  mutable std::atomic<std::size_t> fetched_ = 0;
  std::unique_ptr<std::atomic<bool>[]> checked_;
};

/// Where the bytes of a file go, in any order.
class ByteSink {
 public:
  ByteSink() = default;
  ByteSink(const ByteSink&) = delete;
  ByteSink& operator=(const ByteSink&) = delete;
  virtual ~ByteSink() = default;

  /// Says how many bytes there will be, before the first are written.
  virtual void expect(std::uint64_t /*size*/) {}
  virtual void write(std::uint64_t offset, std::string_view bytes) = 0;
};

/// Puts such a file together chunk by chunk, so that it never stands in memory as a whole.
class ChunkedFileWriter {
 public:
  struct Part {
    std::string_view name;  ///< at most 16 letters, unlike all others
    std::uint64_t size = 0;
  };

  /// @param parts  the file's sections, in order.
  ChunkedFileWriter(ByteSink& sink, std::span<const Part> parts);

  /// Goes on to the next section.
  void begin_next();

  /// Puts bytes into the section that was begun last.
  void append(std::string_view bytes);

  /// The same in two steps: put bytes behind those that are there, then let them go on.
  std::string& pending() { return buffer_; }
  void flush();

  /// Ends the file, with what stands before its sections.
  /// @throws std::logic_error if the sections have other sizes than said.
  void finish();

 private:
  void write_chunk(std::string_view bytes);

  ByteSink& sink_;
  std::vector<ChunkedFile::Section> sections_;
  std::size_t begun_ = 0;
  std::uint64_t body_size_ = 0, body_offset_ = 0;
  std::vector<std::uint64_t> hashes_;  // of the chunks that were handed on
  std::string buffer_;                 // what comes after them
};

}  // namespace roadbed::map::storage
