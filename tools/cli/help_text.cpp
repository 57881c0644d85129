#include "roadbed/tools/cli/help_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace roadbed::tools::inline cli {
namespace {

constexpr std::size_t kWidth_columns = 100, kExplanationAt = 30;
/// An option that excludes more than this says so itself.
constexpr std::size_t kFew = 3;

/// Words in lines of at most kWidth_columns; all but the first are indented.
std::string wrapped(std::string_view text, std::size_t column, std::size_t indent) {
  std::string lines;
  bool is_first = true;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(text.size(), word.size() + 1));
    if (!is_first && column + 1 + word.size() > kWidth_columns) {
      lines += '\n' + std::string(indent, ' ');
      column = indent;
    } else if (!is_first) {
      lines += ' ';
      ++column;
    }
    lines += word;
    column += word.size();
    is_first = false;
  }
  return lines;
}

std::string line(const std::string& name, const std::string& explanation) {
  std::string text = "  " + name;
  if (text.size() + 2 > kExplanationAt) {
    text += '\n' + std::string(kExplanationAt, ' ');
  } else {
    text.resize(kExplanationAt, ' ');
  }
  return text + wrapped(explanation, kExplanationAt, kExplanationAt) + '\n';
}

/// What CLI11 writes behind a type, as "FLOAT in [0.1 - 1000]" or "{a,b}".
std::string limits(std::string_view check) {
  if (check.starts_with('{') && check.ends_with('}')) {
    return CLI::detail::find_and_replace(std::string(check.substr(1, check.size() - 2)), ",", ", ");
  }
  if (check == "POSITIVE") return "above 0";
  if (check == "NONNEGATIVE") return "0 or more";
  const std::size_t open = check.find(" in ["), dash = check.find(" - ");
  if (open == std::string_view::npos || dash == std::string_view::npos) return std::string(check);
  const std::string_view least = check.substr(open + 5, dash - open - 5);
  const std::string_view most = check.substr(dash + 3, check.size() - dash - 4);
  return fmt::format("{} to {}", least, most);
}

std::string type_word(std::string_view type) {
  if (type == "FLOAT" || type == "INT" || type == "UINT") return "NUMBER";
  return std::string(type);
}

/// "FLOAT:FLOAT in [0.1 - 1000]" in its two parts.
std::pair<std::string, std::string> type_and_check(const CLI::Option& option) {
  const std::string name = option.get_type_name();
  const std::size_t colon = name.find(':');
  if (colon == std::string::npos) return {name, ""};
  return {name.substr(0, colon), name.substr(colon + 1)};
}

/// What narrows an option's use: "0.1 to 1000; default 30; not with --poses".
std::string narrowing(const CLI::Option& option) {
  std::vector<std::string> notes;
  if (option.get_option_text().empty()) {
    const std::string check = type_and_check(option).second;
    if (!check.empty()) notes.push_back(limits(check));
    if (!option.get_default_str().empty()) notes.push_back("default " + option.get_default_str());
  }
  if (option.get_required() && option.nonpositional()) notes.emplace_back("required");
  std::vector<std::string> others;
  for (const CLI::Option* other : option.get_excludes()) {
    if (other->get_excludes().size() <= kFew) others.push_back(other->get_name());
  }
  if (!others.empty() && others.size() <= kFew) {
    std::sort(others.begin(), others.end());  // a set of pointers has no order of its own
    notes.push_back(fmt::format("not with {}", fmt::join(others, ", ")));
  }
  return notes.empty() ? "" : fmt::format(" ({})", fmt::join(notes, "; "));
}

class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override {
    const std::string help = make_description(app) + make_usage(app, std::move(name)) +
                             make_positionals(app) + make_groups(app, mode) + common_options(app) +
                             make_subcommands(app, mode) + '\n' + make_footer(app);
    return CLI::detail::find_and_replace(help, "\n\n\n", "\n\n");
  }

  std::string make_usage(const CLI::App* app, std::string name) const override {
    return fmt::format("Usage: {} {}\n", name, usage_of(*app));
  }

  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    const std::string value = value_word(*option);
    return line(make_option_name(option, is_positional) + (value.empty() ? "" : ' ' + value),
                explanation(*option));
  }

  std::string make_subcommand(const CLI::App* command) const override {
    return line(command->get_name(), command->get_description());
  }

  std::string make_description(const CLI::App* app) const override {
    const std::string description = app->get_description();
    return description.empty() ? "" : wrapped(description, 0, 0) + '\n';
  }

 private:
  // Those of the program, which may stand behind a command's words too.
  std::string common_options(const CLI::App* app) const {
    if (app->get_parent() == nullptr) return "";
    const CLI::App* program = app;
    while (program->get_parent() != nullptr) program = program->get_parent();
    const auto is_common = [&](const CLI::Option* option) {
      return option != program->get_help_ptr() && option->get_single_name() != "version";
    };
    return make_group("Options of every command", false, program->get_options(is_common));
  }
};

// "IN", "[MAP]", "CLOUDS...", "-o PATH"
std::string usage_word(const CLI::Option& option) {
  if (option.nonpositional()) {
    const std::string name = option.get_snames().empty() ? "--" + option.get_lnames().front()
                                                         : "-" + option.get_snames().front();
    return name + ' ' + value_word(option);
  }
  const char* more =
      option.get_expected_max() == CLI::detail::expected_max_vector_size ? "..." : "";
  return fmt::format(fmt::runtime(option.get_required() ? "{}{}" : "[{}{}]"), option.get_name(true),
                     more);
}

}  // namespace

std::string value_word(const CLI::Option& option) {
  if (!option.get_option_text().empty()) return option.get_option_text();
  if (option.get_type_size() == 0) return "";
  const std::string word = type_word(type_and_check(option).first);
  if (option.get_expected_max() == CLI::detail::expected_max_vector_size) return word + " ...";
  if (option.get_expected_min() > 1) return fmt::format("{} x {}", word, option.get_expected());
  return word;
}

std::string explanation(const CLI::Option& option) {
  return option.get_description() + narrowing(option);
}

std::string usage_of(const CLI::App& command) {
  std::string usage = "[OPTIONS]";
  for (const bool is_positional : {true, false}) {
    for (const CLI::Option* option : command.get_options()) {
      if (option->get_positional() != is_positional) continue;
      if (is_positional || option->get_required()) usage += ' ' + usage_word(*option);
    }
  }
  if (!command.get_subcommands({}).empty()) usage += " SUBCOMMAND";
  return usage;
}

std::shared_ptr<CLI::FormatterBase> make_help_formatter() {
  return std::make_shared<HelpFormatter>();
}

}  // namespace roadbed::tools::cli
