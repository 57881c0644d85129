#include "roadbed/tools/cli/manual.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>
#include <string_view>

#include "roadbed/tools/cli/build_id.h"

namespace roadbed::tools::inline cli {
namespace {

constexpr std::size_t kLongestLine = 78;

/// A word that roff shows as it is: its hyphens can be searched for and copied.
std::string escaped(std::string_view text) {
  std::string roff;
  for (const char sign : text) {
    if (sign == '\\') {
      roff += "\\e";
    } else if (sign == '-') {
      roff += "\\-";
    } else {
      roff += sign;
    }
  }
  return roff;
}

/// Not taken for a request.
std::string as_line(std::string line) {
  return line.starts_with('.') || line.starts_with('\'') ? "\\&" + std::move(line) : line;
}

/// Words that are filled, in lines that end where a sentence does, and before they are too long.
std::string paragraph(const std::string& text) {
  std::string lines, line;
  const auto end_line = [&] {
    if (!line.empty()) lines += as_line(std::exchange(line, "")) + '\n';
  };
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::string roff = escaped(word);
    if (!line.empty() && line.size() + 1 + roff.size() > kLongestLine) end_line();
    line += (line.empty() ? "" : " ") + roff;
    if (word.ends_with('.') || word.ends_with('!') || word.ends_with('?')) end_line();
  }
  end_line();
  return lines;
}

/// Lines as they are.
std::string verbatim(const std::string& text) {
  std::string lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
    lines += as_line(escaped(line.substr(begin))) + '\n';
  }
  return ".nf\n.RS 4\n" + lines + ".RE\n.fi\n";
}

std::string bold(const std::string& text) { return "\\fB" + escaped(text) + "\\fR"; }

std::string tagged(const std::string& tag, const std::string& text) {
  return ".TP\n" + tag + '\n' + paragraph(text);
}

std::string command_line(const std::vector<std::string>& words) {
  return fmt::format("roadbed{}{}", words.empty() ? "" : " ", fmt::join(words, " "));
}

std::string entry(const PageOption& option) {
  std::string tag = option.short_name.empty() ? "" : bold(option.short_name) + ", ";
  tag += bold(option.name);
  if (!option.value.empty() && !option.is_positional) {
    tag += " \\fI" + escaped(option.value) + "\\fR";
  }
  return tagged(tag, option.text);
}

/// Sections of a page's options: first the arguments, then each heading in the order of the help.
std::string entries(const CommandPage& page) {
  std::string arguments;
  std::vector<std::pair<std::string, std::string>> sections;
  for (const PageOption& option : page.options) {
    if (option.is_positional) {
      arguments += entry(option);
      continue;
    }
    auto section =
        std::ranges::find(sections, option.heading, &std::pair<std::string, std::string>::first);
    if (section == sections.end()) section = sections.insert(section, {option.heading, ""});
    section->second += entry(option);
  }
  std::string roff = arguments.empty() ? "" : ".SH ARGUMENTS\n" + arguments;
  for (const auto& [heading, text] : sections) {
    roff += (heading == "Options" ? ".SH OPTIONS\n" : ".SS " + escaped(heading) + '\n') + text;
  }
  return roff;
}

std::string common_entries(const CommandPage& program) {
  std::string roff = ".SS Options of every command\n";
  for (const PageOption& option : program.options) {
    if (option.name != "--help" && option.name != "--version") roff += entry(option);
  }
  return roff;
}

std::string list_of_commands(const CommandPage& page) {
  std::string roff = ".SH COMMANDS\n";
  for (const CommandPage& part : page.parts) {
    roff += tagged(bold(manual_name(part.words)) + "(1)", part.description);
  }
  return roff;
}

std::string exit_status(const CommandPage& page, bool is_program) {
  const std::string no = is_program ? "The answer is no, as there is no route, or a conflict. Each "
                                      "command's page says when."
                                    : "The answer is no: " + page.no_means + ".";
  std::string roff = ".SH EXIT STATUS\n" + tagged("0", is_program ? "Yes, or done." : "Done.");
  if (is_program || !page.no_means.empty()) {
    roff += tagged("1", no + " The outputs are written.");
  }
  return roff + tagged("2", "The command line is wrong.") +
         tagged("3",
                "An input is unusable or missing, or an output cannot be written. No output is "
                "left behind.") +
         tagged("4", "The program is at fault, or out of memory. No output is left behind.");
}

/// The commands that a page's texts name.
std::vector<std::string> neighbours(const CommandPage& page, const CommandPage& program) {
  std::string text = page.description + '\n' + page.examples;
  for (const PageOption& option : page.options) text += '\n' + option.text;
  std::vector<std::string> names;
  for (const CommandPage& other : program.parts) {
    if (!page.words.empty() && other.words.front() == page.words.front()) continue;
    if (page.words.empty() || text.find(command_line(other.words) + ' ') != std::string::npos) {
      names.push_back(manual_name(other.words));
    }
  }
  return names;
}

std::string see_also(const CommandPage& page, const CommandPage& program) {
  std::vector<std::string> names;
  if (!page.words.empty()) names.emplace_back("roadbed");
  if (page.words.size() > 1) names.push_back(manual_name({page.words.front()}));
  for (const CommandPage& part : page.words.empty() ? std::vector<CommandPage>{} : page.parts) {
    names.push_back(manual_name(part.words));
  }
  for (std::string& name : neighbours(page, program)) names.push_back(std::move(name));
  std::string roff = ".SH SEE ALSO\n";
  for (const std::string& name : names) {
    roff += ".BR " + escaped(name) + " (1)" + (name == names.back() ? "" : ",") + '\n';
  }
  return roff;
}

}  // namespace

std::string manual_name(const std::vector<std::string>& words) {
  return fmt::format("roadbed{}{}", words.empty() ? "" : "-", fmt::join(words, "-"));
}

std::string manual_page(const CommandPage& command, const CommandPage& program) {
  const bool is_program = command.words.empty();
  const std::string name = manual_name(command.words);
  std::string title = name;
  std::ranges::transform(title, title.begin(), [](char sign) {
    return sign >= 'a' && sign <= 'z' ? static_cast<char>(sign - 'a' + 'A') : sign;
  });
  std::string roff = fmt::format(".TH {} 1 {} \"{}\" \"User Commands\"\n", escaped(title),
                                 release_date(), name_and_version());
  roff += ".SH NAME\n" + escaped(name) + " \\- " + escaped(command.description) + '\n';
  roff += ".SH SYNOPSIS\n" + bold(command_line(command.words)) + '\n' + paragraph(command.usage);
  roff += ".SH DESCRIPTION\n" + paragraph(command.description + ".");
  if (!command.parts.empty()) roff += list_of_commands(command);
  roff += entries(command);
  if (!is_program) roff += common_entries(program);
  if (is_program || command.parts.empty()) roff += exit_status(command, is_program);
  if (!command.examples.empty()) roff += ".SH EXAMPLES\n" + verbatim(command.examples);
  return roff + see_also(command, program);
}

}  // namespace roadbed::tools::cli
