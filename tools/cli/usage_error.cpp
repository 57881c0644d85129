#include "roadbed/tools/cli/usage_error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/map/files/visible_text.h"

namespace roadbed::tools::inline cli {
namespace {

/// How many letters have to be put in, left out or changed, by Levenshtein's table row by row.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

std::string suggestion(const std::string& word, const std::vector<std::string>& names) {
  constexpr std::size_t kMostSlips = 2;
  const auto distance = [&](const std::string& name) { return edit_distance(word, name); };
  const auto nearest = std::ranges::min_element(names, {}, distance);
  if (nearest == names.end() || distance(*nearest) > kMostSlips) return "";
  return fmt::format("; did you mean {}?", *nearest);
}

std::vector<std::string> names_of_commands(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> names_of_options(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* one = &app; one != nullptr; one = one->get_parent()) {
    for (const CLI::Option* option : one->get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
  }
  return names;
}

/// What is wrong with the first word that nothing takes: an option before all else.
std::string unknown_word(const CLI::App& app, std::vector<std::string> rest) {
  std::stable_partition(rest.begin(), rest.end(),
                        [](const std::string& word) { return word.starts_with('-'); });
  const std::string word = map::one_line(rest.front());
  if (word.starts_with('-')) {
    const std::string name = word.substr(0, word.find('='));
    return fmt::format("there is no option {}{}", name, suggestion(name, names_of_options(app)));
  }
  const std::vector<std::string> commands = names_of_commands(app);
  if (commands.empty()) return fmt::format("\"{}\" is one argument too many", word);
  return fmt::format("there is no command {}{}", word, suggestion(word, commands));
}

}  // namespace

std::string usage_message(const CLI::App* program, const CLI::Error& error) {
  const CLI::App* app = program;
  std::string line = program->get_name();
  while (!app->get_subcommands().empty()) {
    app = app->get_subcommands().front();
    line += ' ' + app->get_name();
  }
  std::string fault = error.what();
  map::make_one_line(fault);
  const std::vector<std::string> rest = program->remaining(true);
  const bool lacks_command = !app->get_subcommands({}).empty();
  if (!rest.empty() &&
      (lacks_command || error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError))) {
    fault = unknown_word(*app, rest);
  } else if (lacks_command && error.get_name() == "RequiredError") {
    fault = fmt::format("a command is required: {}", fmt::join(names_of_commands(*app), ", "));
  }
  return fmt::format("{}: {}{} see: {} --help\n", line, fault, fault.ends_with('?') ? "" : ";",
                     line);
}

}  // namespace roadbed::tools::cli
