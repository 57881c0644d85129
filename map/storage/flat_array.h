#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "roadbed/map/storage/chunked_file.h"

namespace roadbed::map::inline storage {

/// Plain records side by side, in memory or in a section of a file, where they are fetched and
/// checked when first asked for. Every access is checked against the array's end, once per span.
template <typename T>
class FlatArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  FlatArray() = default;

  explicit FlatArray(std::vector<T> items)
      : items_(std::move(items)), data_(items_.data()), size_(items_.size()) {}

  /// @throws InputError if the section is not there or not a whole number of records.
  FlatArray(std::shared_ptr<const ChunkedFile> file, std::string_view section)
      : file_(std::move(file)), section_(file_->section(section)) {
    if (section_.size % sizeof(T) != 0) file_->refuse(std::string(section), "half a record");
    data_ = reinterpret_cast<const T*>(file_->data(section_));
    size_ = section_.size / sizeof(T);
  }

  FlatArray(FlatArray&&) noexcept = default;
  FlatArray& operator=(FlatArray&&) noexcept = default;

  std::uint64_t size() const { return size_; }

  /// The records from `first` on.
  /// @throws InputError if they are not there, cannot be read or are damaged.
  const T* span(std::uint64_t first, std::uint64_t count) const {
    if (count > size_ || first > size_ - count) refuse();
    if (file_) file_->ensure_loaded(section_, first * sizeof(T), count * sizeof(T));
    return data_ + first;
  }

  const T& operator[](std::uint64_t index) const { return *span(index, 1); }

  /// Says that what a record holds cannot be.
  [[noreturn]] void refuse(const std::string& found) const {
    if (file_) file_->refuse(section_.name.data(), found);
    throw std::logic_error("FlatArray: " + found);
  }

  /// The file that it is a section of, null in memory.
  const ChunkedFile* file() const { return file_.get(); }

  /// All bytes, for writing.
  std::string_view bytes() const {
    return {reinterpret_cast<const char*>(span(0, size_)), size_ * sizeof(T)};
  }

 private:
  [[noreturn]] void refuse() const {
    if (file_) file_->ensure_loaded(section_, section_.size, 1);  // says which section, and throws
    throw std::logic_error("FlatArray: a place beyond the end");
  }

  std::vector<T> items_;
  std::shared_ptr<const ChunkedFile> file_;
  ChunkedFile::Section section_;
  const T* data_ = nullptr;
  std::uint64_t size_ = 0;
};

}  // namespace roadbed::map::storage
