#pragma once

#include <string>
#include <vector>

#include "roadbed/tools/cli/command_page.h"

namespace roadbed::tools::inline cli {

/// Of a command's manual page: "roadbed-occupancy-build"; of the program "roadbed".
std::string manual_name(const std::vector<std::string>& words);

/// A command's manual page in section 1, for man(1): roff with man(7)'s macros, in lines of at most
/// 80 bytes.
/// @param program  of which the command is a part, or which itself is asked for: then its page.
std::string manual_page(const CommandPage& command, const CommandPage& program);

}  // namespace roadbed::tools::cli
