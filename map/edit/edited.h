#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace roadbed::map::inline edit {

/// How many of something: "roads cut", 3.
using Count = std::pair<std::string, std::size_t>;

/// What became of a map.
struct Edited {
  std::string bytes;               ///< of the file; empty: nothing is left of it
  std::string reason;              ///< why nothing is left
  std::vector<Count> counts;       ///< what was done, or left out, for the user, none 0
  std::vector<std::string> notes;  ///< what else the user should know, a line each

  void count(const std::string& what, std::size_t many) {
    if (many > 0) counts.emplace_back(what, many);
  }
};

}  // namespace roadbed::map::edit
