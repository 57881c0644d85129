#pragma once

#include <atomic>
#include <compare>
#include <cstddef>
#include <cstdlib>
#include <deque>
#include <functional>
#include <iterator>
#include <memory>
#include <mutex>
#include <new>
#include <stdexcept>
#include <utility>
#include <vector>

namespace roadbed::map::inline storage {

/// A list that never changes and whose elements are all there, or are made when first touched and
/// kept from then on: reads like a `const std::vector<T>`. References stay valid as long as a copy
/// of the list lives; copies are cheap and share the elements. Safe to read from several threads.
template <typename T>
class LazyList {
 public:
  class Iterator;
  using value_type = T;
  using const_iterator = Iterator;

  LazyList() : LazyList(std::vector<T>()) {}

  LazyList(std::vector<T> items)  // NOLINT(google-explicit-constructor): it is the same list
      : size_(items.size()), state_(std::make_shared<State>(std::move(items))) {
    whole_ = state_->whole.data();
  }

  /// @param make  makes element i; called again if it throws, and by several threads at once.
  LazyList(std::size_t size, std::function<T(std::size_t)> make)
      : size_(size), state_(std::make_shared<State>(size, std::move(make))) {}

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }

  /// @param index  less than size().
  const T& operator[](std::size_t index) const {
    return whole_ != nullptr ? whole_[index] : state_->touch(index);
  }

  /// @throws std::out_of_range if there is no such element.
  const T& at(std::size_t index) const {
    if (index >= size_) throw std::out_of_range("LazyList: no such element");
    return (*this)[index];
  }

  const T& front() const { return (*this)[0]; }
  const T& back() const { return (*this)[size_ - 1]; }
  Iterator begin() const { return {this, 0}; }
  Iterator end() const { return {this, static_cast<std::ptrdiff_t>(size_)}; }

 private:
  struct Free {
    void operator()(void* memory) const { std::free(memory); }
  };

  // Slots come from calloc, so that a list of millions costs nothing until it is touched.
  struct State {
    explicit State(std::vector<T> items) : whole(std::move(items)) {}
    State(std::size_t size, std::function<T(std::size_t)> maker)
        : make(std::move(maker)),
          slots(static_cast<const T**>(std::calloc(size + 1, sizeof(const T*)))) {
      if (!slots) throw std::bad_alloc();
    }

    const T& touch(std::size_t index) {
      std::atomic_ref<const T*> slot(slots.get()[index]);
      if (const T* there = slot.load(std::memory_order_acquire)) return *there;
      T item = make(index);
      const std::lock_guard lock(mutex);
      if (const T* there = slot.load(std::memory_order_relaxed)) return *there;
      made.push_back(std::move(item));
      slot.store(&made.back(), std::memory_order_release);
      return made.back();
    }

    std::vector<T> whole;
    std::function<T(std::size_t)> make;
    std::unique_ptr<const T*, Free> slots;
    std::mutex mutex;
    std::deque<T> made;
  };

  std::size_t size_ = 0;
  const T* whole_ = nullptr;  // null where elements are made
  std::shared_ptr<State> state_;
};

template <typename T>
class LazyList<T>::Iterator {
 public:
  using iterator_category = std::random_access_iterator_tag;
  using value_type = T;
  using difference_type = std::ptrdiff_t;
  using pointer = const T*;
  using reference = const T&;

  Iterator() = default;
  Iterator(const LazyList* list, difference_type at) : list_(list), at_(at) {}

  reference operator*() const { return (*list_)[static_cast<std::size_t>(at_)]; }
  pointer operator->() const { return &**this; }
  reference operator[](difference_type step) const { return *(*this + step); }

  Iterator& operator+=(difference_type step) {
    at_ += step;
    return *this;
  }
  Iterator& operator-=(difference_type step) { return *this += -step; }
  Iterator& operator++() { return *this += 1; }
  Iterator& operator--() { return *this += -1; }
  Iterator operator++(int) { return {list_, at_++}; }
  Iterator operator--(int) { return {list_, at_--}; }
  Iterator operator+(difference_type step) const { return {list_, at_ + step}; }
  Iterator operator-(difference_type step) const { return {list_, at_ - step}; }
  friend Iterator operator+(difference_type step, const Iterator& it) { return it + step; }
  difference_type operator-(const Iterator& other) const { return at_ - other.at_; }
  bool operator==(const Iterator& other) const { return at_ == other.at_; }
  auto operator<=>(const Iterator& other) const { return at_ <=> other.at_; }

 private:
  const LazyList* list_ = nullptr;
  difference_type at_ = 0;
};

}  // namespace roadbed::map::storage
