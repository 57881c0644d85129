#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace roadbed::map::lanelet2 {

/// From an element's id in the file to its place in a list. Lookups cost O(log N) whatever the ids
/// are: a file cannot make them slow, as it could with a hash table.
class IdIndex {
 public:
  IdIndex() = default;

  /// @param ids  id and place; of equal ids the first place is kept.
  explicit IdIndex(std::vector<std::pair<std::int64_t, std::uint32_t>> ids)
      : entries_(std::move(ids)) {
    if (!std::is_sorted(entries_.begin(), entries_.end())) {
      std::sort(entries_.begin(), entries_.end());
    }
    const auto repeated =
        std::unique(entries_.begin(), entries_.end(),
                    [](const auto& a, const auto& b) { return a.first == b.first; });
    repeated_ = static_cast<std::size_t>(entries_.end() - repeated);
    entries_.erase(repeated, entries_.end());
  }

  std::optional<std::uint32_t> find(std::int64_t id) const {
    const auto found = std::lower_bound(entries_.begin(), entries_.end(), id,
                                        [](const auto& a, std::int64_t b) { return a.first < b; });
    if (found == entries_.end() || found->first != id) return {};
    return found->second;
  }

  /// The same, searched from about a place in the order of ids, which then is where it was found:
  /// quick for ids that follow each other.
  std::optional<std::uint32_t> find_near(std::int64_t id, std::size_t& near) const {
    const auto less = [](const auto& a, std::int64_t b) { return a.first < b; };
    // Away from the place in steps that double, until the id is between two of them.
    const std::size_t size = entries_.size();
    std::size_t low = std::min(near, size), high = low, step = 1;
    while (low > 0 && entries_[low - 1].first >= id) low -= std::min(low, step), step *= 2;
    while (high < size && entries_[high].first < id) high += std::min(size - high, step), step *= 2;
    const auto found =
        std::lower_bound(entries_.begin() + static_cast<std::ptrdiff_t>(low),
                         entries_.begin() + static_cast<std::ptrdiff_t>(high), id, less);
    if (found == entries_.end() || found->first != id) return {};
    near = static_cast<std::size_t>(found - entries_.begin());
    return found->second;
  }

  /// Entries that came after one of the same id.
  std::size_t repeated() const { return repeated_; }

 private:
  std::vector<std::pair<std::int64_t, std::uint32_t>> entries_;
  std::size_t repeated_ = 0;
};

}  // namespace roadbed::map::lanelet2
