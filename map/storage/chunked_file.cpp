#include "roadbed/map/storage/chunked_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <new>
#include <stdexcept>
#include <utility>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline storage {
namespace {

static_assert(std::endian::native == std::endian::little);

// The file: magic, XXH3 of all between this field and the body, counts, section table, XXH3 of
// each chunk of the body, body. Numbers are little-endian.
struct Header {
  std::array<char, 16> magic{};
  std::uint64_t hash = 0;
  std::uint64_t sections = 0;
  std::uint64_t body_offset = 0;
  std::uint64_t body_size = 0;
};
static_assert(sizeof(Header) == 48 && sizeof(ChunkedFile::Section) == 32);
constexpr std::size_t kHashedFrom = 24;
constexpr std::size_t kAlignment = 64;
constexpr std::uint64_t kMostSections = 1024;

std::uint64_t chunk_count(std::uint64_t body_size) {
  return body_size / ChunkedFile::kChunkSize + (body_size % ChunkedFile::kChunkSize != 0);
}

std::string_view text(const std::array<char, 16>& name) {
  return {name.data(),
          static_cast<std::size_t>(std::find(name.begin(), name.end(), '\0') - name.begin())};
}

template <typename T>
void append_items(std::string& bytes, std::span<const T> items) {
  bytes.append(reinterpret_cast<const char*>(items.data()), items.size_bytes());
}

}  // namespace

/// What chunks are read from: an open file, or bytes.
class ChunkedFile::Source {
 public:
  explicit Source(int descriptor) : descriptor_(descriptor) {}
  explicit Source(std::string bytes) : bytes_(std::move(bytes)) {}
  ~Source() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  std::uint64_t size() const {
    if (descriptor_ < 0) return bytes_.size();
    struct stat status {};
    return ::fstat(descriptor_, &status) == 0 ? static_cast<std::uint64_t>(status.st_size) : 0;
  }

  /// @return what went wrong, or nothing.
  std::string read(std::uint64_t offset, void* into, std::size_t size) const {
    if (descriptor_ < 0) return copy(offset, into, size);
    auto* at = static_cast<char*>(into);
    while (size > 0) {
      const ssize_t got = ::pread(descriptor_, at, size, static_cast<off_t>(offset));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) return std::string("cannot be read: ") + std::strerror(errno);
      if (got == 0) return fmt::format("ends at byte {}", offset);
      at += got;
      offset += static_cast<std::uint64_t>(got);
      size -= static_cast<std::size_t>(got);
    }
    return {};
  }

 private:
  std::string copy(std::uint64_t offset, void* into, std::size_t size) const {
    if (offset > bytes_.size() || size > bytes_.size() - offset) {
      return fmt::format("ends at byte {}", bytes_.size());
    }
    std::memcpy(into, bytes_.data() + offset, size);
    return {};
  }

  int descriptor_ = -1;
  std::string bytes_;
};

std::shared_ptr<const ChunkedFile> ChunkedFile::open(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    throw InputError({.file = file.string(),
                      .found = std::string("cannot be opened: ") + std::strerror(errno),
                      .remedy = "check the path and its rights"});
  }
  return std::shared_ptr<const ChunkedFile>(
      new ChunkedFile(std::make_unique<const Source>(descriptor), file.string()));
}

std::shared_ptr<const ChunkedFile> ChunkedFile::from_bytes(std::string bytes, std::string name) {
  return std::shared_ptr<const ChunkedFile>(
      new ChunkedFile(std::make_unique<const Source>(std::move(bytes)), std::move(name)));
}

ChunkedFile::ChunkedFile(std::unique_ptr<const Source> source, std::string name)
    : source_(std::move(source)), name_(std::move(name)) {
  read_header();
  if (body_size_ == 0) return;
  void* space = ::mmap(nullptr, body_size_, PROT_READ | PROT_WRITE,
                       MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (space == MAP_FAILED) throw std::bad_alloc();
  body_ = static_cast<std::byte*>(space);
}

ChunkedFile::~ChunkedFile() {
  if (body_ != nullptr) ::munmap(body_, body_size_);
}

void ChunkedFile::read_header() {
  Header header;
  const std::uint64_t size = source_->size();
  const std::size_t there = std::min<std::uint64_t>(size, sizeof header);
  if (const std::string fault = source_->read(0, &header, there); !fault.empty()) refuse({}, fault);
  if (text(header.magic) != kMagic) {
    refuse({}, fmt::format("version \"{}\"", text(header.magic)));
  }
  if (there < sizeof header || header.sections > kMostSections || header.body_offset > size ||
      header.body_size != size - header.body_offset) {
    refuse({}, fmt::format("{} bytes that its header does not fit", size));
  }
  body_offset_ = header.body_offset;
  body_size_ = header.body_size;
  const std::uint64_t tables =
      header.sections * sizeof(Section) + chunk_count(body_size_) * sizeof(std::uint64_t);
  if (body_offset_ != sizeof header + tables) refuse({}, "a damaged header");

  std::string hashed(sizeof header - kHashedFrom + tables, '\0');
  if (const std::string fault = source_->read(kHashedFrom, hashed.data(), hashed.size());
      !fault.empty()) {
    refuse({}, fault);
  }
  if (XXH3_64bits(hashed.data(), hashed.size()) != header.hash) {
    refuse("header", "its checksum is wrong");
  }
  sections_.resize(header.sections);
  hashes_.resize(chunk_count(body_size_));
  const char* at = hashed.data() + sizeof header - kHashedFrom;
  std::copy_n(at, sections_.size() * sizeof(Section), reinterpret_cast<char*>(sections_.data()));
  at += sections_.size() * sizeof(Section);
  std::copy_n(at, hashes_.size() * sizeof(std::uint64_t), reinterpret_cast<char*>(hashes_.data()));
  checked_ = std::make_unique<std::atomic<bool>[]>(hashes_.size());
}

bool ChunkedFile::has(std::string_view name) const {
  return std::any_of(sections_.begin(), sections_.end(),
                     [&](const Section& section) { return text(section.name) == name; });
}

const ChunkedFile::Section& ChunkedFile::section(std::string_view name) const {
  for (const Section& section : sections_) {
    if (text(section.name) != name) continue;
    const bool inside = section.size <= body_size_ && section.offset <= body_size_ - section.size;
    if (!inside || section.offset % kAlignment != 0) {
      refuse(std::string(name), "a section beyond the file's end");
    }
    return section;
  }
  refuse(std::string(name), "no such section");
}

void ChunkedFile::fetch(std::uint64_t chunk) const {
  const std::lock_guard lock(mutex_);
  if (checked_[chunk].load(std::memory_order_relaxed)) return;
  const std::uint64_t from = chunk * kChunkSize;
  const std::size_t size = std::min<std::uint64_t>(kChunkSize, body_size_ - from);
  const std::string fault = source_->read(body_offset_ + from, body_ + from, size);
  if (!fault.empty()) refuse(fmt::format("chunk {}", chunk), fault);
  if (XXH3_64bits(body_ + from, size) != hashes_[chunk]) {
    refuse(fmt::format("chunk {}", chunk), "its checksum is wrong");
  }
  fetched_.fetch_add(1, std::memory_order_relaxed);
  checked_[chunk].store(true, std::memory_order_release);
}

void ChunkedFile::evict_all() const {
  const std::lock_guard lock(mutex_);
  for (std::uint64_t chunk = 0; chunk < hashes_.size(); ++chunk) {
    checked_[chunk].store(false, std::memory_order_relaxed);
  }
  fetched_ = 0;
  if (body_ != nullptr) ::madvise(body_, body_size_, MADV_DONTNEED);
}

void ChunkedFile::check_all() const {
  for (std::uint64_t chunk = 0; chunk < hashes_.size(); ++chunk) {
    if (!checked_[chunk].load(std::memory_order_acquire)) fetch(chunk);
    evict_over_budget();
  }
  evict_all();
}

void ChunkedFile::refuse(const std::string& element, const std::string& found) const {
  throw InputError({.file = name_,
                    .element = element,
                    .found = found,
                    .needed = "a whole compiled map of this version",
                    .remedy = "compile it again with roadbed import"});
}

void ChunkedFile::refuse_range(const Section& section) const {
  refuse(std::string(text(section.name)), "a place beyond the section's end");
}

ChunkedFileWriter::ChunkedFileWriter(ByteSink& sink, std::span<const Part> parts) : sink_(sink) {
  for (const Part& part : parts) {
    ChunkedFile::Section& section = sections_.emplace_back();
    if (part.name.size() > section.name.size()) {
      throw std::invalid_argument(fmt::format("ChunkedFileWriter: \"{}\" is too long", part.name));
    }
    std::copy(part.name.begin(), part.name.end(), section.name.begin());
    section.offset = body_size_ + (kAlignment - body_size_ % kAlignment) % kAlignment;
    section.size = part.size;
    body_size_ = section.offset + section.size;
  }
  body_offset_ = sizeof(Header) + sections_.size() * sizeof(ChunkedFile::Section) +
                 chunk_count(body_size_) * sizeof(std::uint64_t);
  sink_.expect(body_offset_ + body_size_);
}

void ChunkedFileWriter::begin_next() {
  const std::uint64_t written = hashes_.size() * ChunkedFile::kChunkSize + buffer_.size();
  buffer_.append(sections_.at(begun_++).offset - written, '\0');
}

void ChunkedFileWriter::append(std::string_view bytes) {
  if (!buffer_.empty()) {
    const std::size_t missing = ChunkedFile::kChunkSize - buffer_.size() % ChunkedFile::kChunkSize;
    buffer_ += bytes.substr(0, missing);
    bytes.remove_prefix(std::min(missing, bytes.size()));
    flush();
  }
  for (; bytes.size() >= ChunkedFile::kChunkSize; bytes.remove_prefix(ChunkedFile::kChunkSize)) {
    write_chunk(bytes.substr(0, ChunkedFile::kChunkSize));
  }
  buffer_ += bytes;
}

void ChunkedFileWriter::flush() {
  std::string_view bytes = buffer_;
  for (; bytes.size() >= ChunkedFile::kChunkSize; bytes.remove_prefix(ChunkedFile::kChunkSize)) {
    write_chunk(bytes.substr(0, ChunkedFile::kChunkSize));
  }
  if (bytes.size() < buffer_.size()) buffer_.erase(0, buffer_.size() - bytes.size());
}

void ChunkedFileWriter::write_chunk(std::string_view bytes) {
  sink_.write(body_offset_ + hashes_.size() * ChunkedFile::kChunkSize, bytes);
  hashes_.push_back(XXH3_64bits(bytes.data(), bytes.size()));
}

void ChunkedFileWriter::finish() {
  flush();
  const std::uint64_t written = hashes_.size() * ChunkedFile::kChunkSize + buffer_.size();
  if (begun_ != sections_.size() || written != body_size_) {
    throw std::logic_error(fmt::format("ChunkedFileWriter: {} sections of {} with {} bytes of {}",
                                       begun_, sections_.size(), written, body_size_));
  }
  if (!buffer_.empty()) write_chunk(buffer_);
  Header header;
  std::copy(ChunkedFile::kMagic.begin(), ChunkedFile::kMagic.end(), header.magic.begin());
  header.sections = sections_.size();
  header.body_size = body_size_;
  header.body_offset = body_offset_;
  std::string bytes;
  append_items(bytes, std::span<const Header>(&header, 1));
  append_items(bytes, std::span<const ChunkedFile::Section>(sections_));
  append_items(bytes, std::span<const std::uint64_t>(hashes_));
  const std::uint64_t hash = XXH3_64bits(bytes.data() + kHashedFrom, bytes.size() - kHashedFrom);
  std::memcpy(bytes.data() + sizeof header.magic, &hash, sizeof hash);
  sink_.write(0, bytes);
}

}  // namespace roadbed::map::storage
