#pragma once

#include <memory>
#include <string>

namespace CLI {
class App;
class FormatterBase;
class Option;
}  // namespace CLI

namespace roadbed::tools::inline cli {

/// How helps look: lines of at most 100 columns, values named by what they are, limits and default
/// in words behind the explanation.
std::shared_ptr<CLI::FormatterBase> make_help_formatter();

/// How an option's value is called: "PATH", "NUMBER x 3", "TEXT ..."; empty for a flag.
std::string value_word(const CLI::Option& option);

/// What an option means, with its limits, its default, and what it excludes.
std::string explanation(const CLI::Option& option);

/// What follows a command's words: "[OPTIONS] MAP -o PATH".
std::string usage_of(const CLI::App& command);

}  // namespace roadbed::tools::cli
