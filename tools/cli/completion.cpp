#include "roadbed/tools/cli/completion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace roadbed::tools::inline cli {
namespace {

using Words = std::vector<std::string>;

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
    text.replace(at, from.size(), to);
    at += to.size();
  }
  return text;
}

std::string joined(const Words& words, const char* sign = " ") {
  return fmt::format("{}", fmt::join(words, sign));
}

/// A text between single quotes of a POSIX shell.
std::string quoted(const std::string& text) { return '\'' + replaced(text, "'", "'\\''") + '\''; }

/// One of the program that answers in place of a command.
bool is_alone(const PageOption& option) {
  return option.name == "--help" || option.name == "--version";
}

/// "-o --output"
Words names_of(const PageOption& option) {
  return option.short_name.empty() ? Words{option.name} : Words{option.short_name, option.name};
}

/// Endings of files: as they are, and packed.
Words endings_of(std::string_view endings) {
  Words list;
  std::istringstream words{std::string(endings)};
  for (std::string ending; words >> ending;) {
    list.insert(list.end(), {ending, ending + ".gz", ending + ".zst"});
  }
  return list;
}

/// Every page below, and itself, first to last.
void for_each_page(const CommandPage& page, const std::function<void(const CommandPage&)>& use) {
  use(page);
  for (const CommandPage& part : page.parts) for_each_page(part, use);
}

/// The program's own options that take a value, which may stand before a command.
Words names_with_value(const CommandPage& program) {
  Words names;
  for (const PageOption& option : program.options) {
    if (option.value.empty()) continue;
    for (const std::string& name : names_of(option)) names.push_back(name);
  }
  return names;
}

Words names_of_parts(const CommandPage& page) {
  Words names;
  for (const CommandPage& part : page.parts) names.push_back(part.words.back());
  return names;
}

// ------------------------------------------------------------------------------------------ bash

/// What stands in COMPREPLY for a value: its words, files, or nothing that could be known.
std::string bash_value(const PageOption& option) {
  if (!option.choices.empty()) return "words=" + quoted(joined(option.choices));
  if (!option.is_path) return ":";
  return option.endings.empty() ? "_roadbed_files"
                                : "_roadbed_files " + joined(endings_of(option.endings));
}

std::string bash_case(const CommandPage& page, const CommandPage& program) {
  std::string values, positional = ":";
  Words options;
  for (const CommandPage* of : {&page, &program}) {
    if (of == &program && page.words.empty()) break;
    for (const PageOption& option : of->options) {
      if (option.is_positional) {
        positional = bash_value(option);
        continue;
      }
      if (of != &page && is_alone(option)) continue;
      for (const std::string& name : names_of(option)) options.push_back(name);
      if (option.value.empty()) continue;
      values +=
          fmt::format("        {}) {} ;;\n", joined(names_of(option), " | "), bash_value(option));
    }
  }
  const Words parts = names_of_parts(page);
  if (!parts.empty()) positional = "words=" + quoted(joined(parts));
  return fmt::format(
      "    {})\n      options={}\n      case $before in\n{}        *) is_value= ; {} ;;\n      "
      "esac ;;\n",
      quoted(joined(page.words)), quoted(joined(options)), values, positional);
}

constexpr std::string_view kBashStart =
    R"(# Completion of roadbed for bash; made by: roadbed help --completion bash

# Files and folders that go on as the word does; given endings, only files with one of them.
_roadbed_files() {
  local ending
  compopt -o filenames 2>/dev/null
  if (($# == 0)); then
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
    return
  fi
  mapfile -t COMPREPLY < <(compgen -d -- "$current")
  for ending; do
    mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -f -X "!*$ending" -- "$current")
  done
}

_roadbed() {
  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}
  local command= options= words= is_value=1 word i
  COMPREPLY=()
  # The command and its part: the words that come first, but for options of every command.
  for ((i = 1; i < COMP_CWORD; ++i)); do
    word=${COMP_WORDS[i]}
    case $word in
      )";

constexpr std::string_view kBashEnd = R"(  esac
  if [[ -n $is_value || $current != -* ]]; then
    [[ -z $words ]] || mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
  else
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current")
  fi
}

complete -F _roadbed roadbed
)";

// ------------------------------------------------------------------------------------------- zsh

/// Of a description in a specification of _arguments.
std::string zsh_text(std::string text) {
  for (const char* sign : {"\\", "[", "]", ":"}) {
    text = replaced(std::move(text), sign, '\\' + std::string(sign));
  }
  return text;
}

std::string zsh_value(const PageOption& option) {
  if (!option.choices.empty()) return '(' + joined(option.choices) + ')';
  if (!option.is_path) return " ";
  if (option.endings.empty()) return "_files";
  const std::string any = replaced(joined(endings_of(option.endings), "|"), ".", "");
  return "_files -g \"*.(" + any + ")\"";
}

std::string zsh_specification(const PageOption& option) {
  const std::string value =
      option.value.empty() ? "" : ':' + zsh_text(option.value) + ':' + zsh_value(option);
  if (option.is_positional) {
    return quoted((option.may_repeat ? "*:" : ":") + zsh_text(option.name) + ':' +
                  zsh_value(option));
  }
  const std::string names = option.may_repeat ? "*" : '(' + joined(names_of(option)) + ')';
  const std::string rest = '[' + zsh_text(option.summary) + ']' + value;
  if (option.short_name.empty()) return quoted(names + option.name + rest);
  return quoted(names) + '{' + joined(names_of(option), ",") + '}' + quoted(rest);
}

std::string zsh_function_name(const Words& words) {
  return "_roadbed" + std::string(words.empty() ? "" : "_") + joined(words, "_");
}

std::string zsh_function(const CommandPage& page) {
  std::string text = zsh_function_name(page.words) + "() {\n";
  if (page.words.empty()) {
    text += "  local -a _roadbed_common=(\n";
    for (const PageOption& option : page.options) {
      if (!is_alone(option)) text += "    " + zsh_specification(option) + '\n';
    }
    text += "  )\n";
  }
  if (!page.parts.empty())
    text += "  local context state state_descr line\n  typeset -A opt_args\n";
  text += page.parts.empty() ? "  _arguments -s" : "  _arguments -s -C";
  for (const PageOption& option : page.options) text += " \\\n    " + zsh_specification(option);
  if (!page.words.empty()) text += " \\\n    $_roadbed_common";
  if (page.parts.empty()) return text + "\n}\n\n";
  text +=
      " \\\n    ':command:->command' '*::argument:->argument'\n  case $state in\n    command)\n"
      "      local -a commands=(\n";
  for (const CommandPage& part : page.parts) {
    text += "        " + quoted(part.words.back() + ':' + part.description) + '\n';
  }
  text += "      )\n      _describe command commands ;;\n    argument)\n      case $words[1] in\n";
  for (const CommandPage& part : page.parts) {
    text += fmt::format("        {}) {} ;;\n", part.words.back(), zsh_function_name(part.words));
  }
  return text + "      esac ;;\n  esac\n}\n\n";
}

// ------------------------------------------------------------------------------------------ fish

std::string fish_quoted(const std::string& text) {
  return '\'' + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + '\'';
}

std::string fish_value(const PageOption& option) {
  if (!option.choices.empty()) return "-x -a " + fish_quoted(joined(option.choices));
  if (!option.is_path) return "-x";
  if (option.endings.empty()) return "-r -F";
  return "-x -k -a " + fish_quoted("(__roadbed_files " + joined(endings_of(option.endings)) + ")");
}

std::string fish_line(const PageOption& option, const std::string& condition) {
  std::string line = "complete -c roadbed" + condition;
  if (option.is_positional) {
    std::string value = fish_value(option);
    return line + ' ' + (value == "-r -F" ? "-F" : replaced(value, "-x ", "")) + '\n';
  }
  if (!option.short_name.empty()) line += " -s " + option.short_name.substr(1);
  line += " -l " + option.name.substr(2) + " -d " + fish_quoted(option.summary);
  return line + (option.value.empty() ? "" : ' ' + fish_value(option)) + '\n';
}

std::string fish_lines(const CommandPage& page) {
  const std::string condition = " -n " + fish_quoted("__roadbed_at " + joined(page.words));
  std::string text;
  for (const CommandPage& part : page.parts) {
    text += "complete -c roadbed" + condition + " -a " + fish_quoted(part.words.back()) + " -d " +
            fish_quoted(part.description) + '\n';
  }
  for (const PageOption& option : page.options) {
    // Those of the program itself may stand anywhere.
    const bool is_value = !option.is_positional || option.is_path || !option.choices.empty();
    if (is_value) text += fish_line(option, page.words.empty() ? "" : condition);
  }
  return text;
}

constexpr std::string_view kFishStart =
    R"(# Completion of roadbed for fish; made by: roadbed help --completion fish

# Whether the command and its part on the line are these words.
function __roadbed_at
  set -l words (commandline -opc)
  set -l found
  set -l is_value 0
  for word in $words[2..-1]
    if test $is_value = 1
      set is_value 0
    else if contains -- $word $__roadbed_with_value
      set is_value 1
    else if not string match -q -- '-*' $word
      set -a found $word
      contains -- "$found" $__roadbed_groups; or break
    end
  end
  test "$found" = "$argv"
end

# Folders and files that go on as the word does, with one of these endings.
function __roadbed_files
  set -l files (complete -C "__fish_command_without_completions "(commandline -ct))
  for ending in $argv
    string match -- "*$ending" $files
  end
  string match -- '*/' $files
end

)";

}  // namespace

std::string bash_completion(const CommandPage& program) {
  Words groups{"''"};
  std::string cases;
  for_each_page(program, [&](const CommandPage& page) {
    if (!page.parts.empty() && !page.words.empty()) groups.push_back(quoted(joined(page.words)));
    cases += bash_case(page, program);
  });
  return std::string(kBashStart) + joined(names_with_value(program), " | ") +
         ") ((++i)) ;;\n      -*) ;;\n      *) case $command in\n           " +
         joined(groups, " | ") +
         ") command+=${command:+ }$word ;;\n         esac ;;\n    esac\n  done\n  case $command "
         "in\n" +
         cases + std::string(kBashEnd);
}

std::string zsh_completion(const CommandPage& program) {
  std::string text =
      "#compdef roadbed\n# Completion of roadbed for zsh; made by: roadbed help --completion "
      "zsh\n\n";
  for_each_page(program, [&](const CommandPage& page) { text += zsh_function(page); });
  return text + "_roadbed \"$@\"\n";
}

std::string fish_completion(const CommandPage& program) {
  Words groups;
  std::string lines;
  for_each_page(program, [&](const CommandPage& page) {
    if (!page.parts.empty() && !page.words.empty())
      groups.push_back(fish_quoted(joined(page.words)));
    lines += fish_lines(page);
  });
  return std::string(kFishStart) + "set -g __roadbed_groups " + joined(groups) +
         "\nset -g __roadbed_with_value " + joined(names_with_value(program)) +
         "\ncomplete -c roadbed -f\n" + lines;
}

}  // namespace roadbed::tools::cli
