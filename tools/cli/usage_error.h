#pragma once

#include <string>

namespace CLI {
class App;
class Error;
}  // namespace CLI

namespace roadbed::tools::inline cli {

/// What is said of a wrong command line, in one line: which command, what is wrong, for a name that
/// there is not the nearest one that there is, and where to read on.
std::string usage_message(const CLI::App* program, const CLI::Error& error);

}  // namespace roadbed::tools::cli
