#pragma once

#include <cstddef>
#include <stdexcept>

// The one place that says how much work an input may cause. Time and memory of every command grow
// nearly linearly with its inputs' size; where a few bytes can ask for more (a curve of endless
// points, roads that all cross each other, a cloud that unfolds), the reader or algorithm counts
// what it does and stops here, with an error that says so.
//
//     whole process    256 MB + 8 × the input's bytes      most_bytes; tests/stress measures it
//     what is read     half of it                          most_bytes_read
//     steps            100,000 + 500 × the input's parts   most_steps

namespace roadbed::geometry::inline primitives {

/// What the fixed parts are divided by: 1, but where millions of inputs of a few bytes are tried,
/// one in a hundred of which comes to a limit and takes longer than all others.
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
inline constexpr std::size_t kLimitDivisor = 32;
#else
inline constexpr std::size_t kLimitDivisor = 1;
#endif

/// Bytes of memory that an input may cause to be taken.
constexpr std::size_t most_bytes(std::size_t input_bytes) {
  return 256'000'000 / kLimitDivisor + 8 * input_bytes;
}

/// Those that what is read from it may take; the rest is for what is made of it.
constexpr std::size_t most_bytes_read(std::size_t input_bytes) {
  return most_bytes(input_bytes) / 2;
}

/// Steps that an algorithm may take for an input of so many parts (points, edges, lanes), beyond
/// those that any input of its size takes.
constexpr std::size_t most_steps(std::size_t input_parts) {
  return 100'000 / kLimitDivisor + 500 * input_parts;
}

/// An input asks for more steps than one of its size may; what() says which things are too many.
class TooMuchWork : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Counts steps up to a limit.
class WorkBudget {
 public:
  explicit WorkBudget(std::size_t steps) : left_(steps) {}

  /// Whether there were `steps` left; if not, there are none from now on.
  bool spend(std::size_t steps) {
    if (steps > left_) is_spent_ = true;
    left_ -= is_spent_ ? left_ : steps;
    return !is_spent_;
  }

  bool is_spent() const { return is_spent_; }

 private:
  std::size_t left_;
  bool is_spent_ = false;
};

}  // namespace roadbed::geometry::primitives
