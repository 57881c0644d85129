#pragma once

#include <string>

#include "roadbed/tools/cli/command_page.h"

namespace roadbed::tools::inline cli {

/// Scripts by which shells complete a command line: commands and parts, options, the words that an
/// option takes, and files by what an option reads. They start no program.
std::string bash_completion(const CommandPage& program);
std::string zsh_completion(const CommandPage& program);
std::string fish_completion(const CommandPage& program);

}  // namespace roadbed::tools::cli
