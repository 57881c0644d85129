#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace roadbed::planning::inline route {

/// Lanes of a network in a row. Most rows hold one lane: up to three take no memory of their own.
class LaneList {
 public:
  LaneList() = default;
  explicit LaneList(std::uint32_t lane) : size_(1), inside_{lane} {}
  LaneList(std::span<const std::uint32_t> lanes) : size_(lanes.size()) {
    if (size_ > inside_.size()) {
      outside_.assign(lanes.begin(), lanes.end());
    } else {
      std::copy(lanes.begin(), lanes.end(), inside_.begin());
    }
  }
  LaneList(const std::vector<std::uint32_t>& lanes) : LaneList(std::span(lanes)) {}

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const std::uint32_t* data() const {
    return size_ > inside_.size() ? outside_.data() : inside_.data();
  }
  const std::uint32_t* begin() const { return data(); }
  const std::uint32_t* end() const { return data() + size_; }
  std::uint32_t operator[](std::size_t i) const { return data()[i]; }
  std::uint32_t front() const { return *begin(); }
  std::uint32_t back() const { return *(end() - 1); }

 private:
  std::size_t size_ = 0;
  std::array<std::uint32_t, 3> inside_{};
  std::vector<std::uint32_t> outside_;  ///< all of them where they are more
};

}  // namespace roadbed::planning::route
