#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace roadbed::planning::inline route {

/// Lists of one kind of thing, one behind the other in a single array: group i is
/// items[first[i]] … items[first[i + 1]].
template <typename T>
struct CsrLists {
  std::vector<std::uint32_t> first{0};
  std::vector<T> items;

  std::size_t groups() const { return first.size() - 1; }
  std::span<const T> of(std::size_t group) const {
    return {items.data() + first[group], items.data() + first[group + 1]};
  }
  /// What was appended to `items` since the last call becomes the next group.
  void end_list() { first.push_back(static_cast<std::uint32_t>(items.size())); }
};

}  // namespace roadbed::planning::route
