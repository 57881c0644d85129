#pragma once

#include <cstddef>
#include <functional>
#include <iterator>
#include <list>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace roadbed::tools::inline batch {

/// Values by name, at most so many: those that were used last. Values stay where they are. One
/// thread uses it at a time.
template <class Value>
class RecentlyUsed {
 public:
  explicit RecentlyUsed(std::size_t most) : most_(most) {}

  /// Null if there is none.
  Value* find(const std::string& name) {
    const auto found = by_name_.find(name);
    if (found == by_name_.end()) return nullptr;
    values_.splice(values_.begin(), values_, found->second);
    return &values_.front().second;
  }

  /// Adds it, or puts it in the place of another.
  Value& put(const std::string& name, Value value) {
    if (Value* const known = find(name)) return *known = std::move(value);
    values_.emplace_front(name, std::move(value));
    by_name_.emplace(values_.front().first, values_.begin());
    if (values_.size() > most_) drop(std::prev(values_.end()));
    return values_.front().second;
  }

  /// Drops the one that was used least recently of those that may go; false: there is none.
  bool drop_one(const std::function<bool(const Value&)>& may_go) {
    for (auto at = values_.end(); at != values_.begin();) {
      --at;
      if (!may_go(at->second)) continue;
      drop(at);
      return true;
    }
    return false;
  }

  std::size_t size() const { return values_.size(); }

 private:
  using Values = std::list<std::pair<std::string, Value>>;  // the last used first

  void drop(typename Values::iterator at) {
    by_name_.erase(at->first);
    values_.erase(at);
  }

  std::size_t most_;
  Values values_;
  std::unordered_map<std::string_view, typename Values::iterator> by_name_;  // names of `values_`
};

}  // namespace roadbed::tools::batch
