#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <optional>
#include <string>

namespace roadbed::tools::inline batch {

/// Lines of a file of jobs or results, one after the other, with bounded memory.
class JobLines {
 public:
  static constexpr std::size_t kLongest = std::size_t{1} << 24;

  /// @param input    lives as long as this.
  /// @param longest  of a line that is kept, in bytes.
  explicit JobLines(std::istream& input, std::size_t longest = kLongest)
      : input_(input), longest_(longest) {}

  struct Line {
    std::size_t number;   ///< from 1
    std::uint64_t begin;  ///< byte at which it begins
    std::string text;     ///< without its end; of one that is too long, its beginning
    bool is_too_long;
    bool is_whole;  ///< whether the line ends: the last one of a file may be torn
  };

  /// The next line that is not blank; none at the end.
  std::optional<Line> next();

 private:
  std::optional<Line> read();

  std::istream& input_;
  std::size_t longest_, number_ = 0;
  std::uint64_t bytes_ = 0;  // taken so far
};

}  // namespace roadbed::tools::batch
