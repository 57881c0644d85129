#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "roadbed/tools/cli/arguments.h"

namespace roadbed::tools::inline cli {

/// An option or positional argument, as a reader sees it.
struct PageOption {
  std::string name;                       ///< "--output"; of a positional "MAP"
  std::string short_name = {};            ///< "-o", if it has one
  std::string value = {};                 ///< "PATH", "TEXT ..."; empty of a flag
  std::string text = {};                  ///< what it means, with its limits and default
  std::string summary = {};               ///< the beginning of it
  std::string heading = {};               ///< under which it stands
  std::vector<std::string> choices = {};  ///< the only words that it takes; empty: any
  std::string_view endings = {};          ///< of files that it takes; empty: any
  bool is_positional = false, is_path = false, may_repeat = false;
};

/// All that a command declares, for helps, manual pages and completions.
struct CommandPage {
  std::vector<std::string> words;  ///< without the program's name
  std::string description;
  std::string usage;  ///< what follows the words: "[OPTIONS] MAP"
  std::vector<PageOption> options;
  std::string no_means;  ///< when the exit status is 1; empty: never
  std::string examples;  ///< lines
  std::vector<CommandPage> parts;
};

/// @param words  those of the command.
CommandPage page_of(const Arguments& arguments, const std::vector<std::string>& words = {});

}  // namespace roadbed::tools::cli
