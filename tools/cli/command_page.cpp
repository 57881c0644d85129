#include "roadbed/tools/cli/command_page.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "roadbed/tools/cli/help_text.h"

namespace roadbed::tools::inline cli {
namespace {

/// "Start: X,Y in the map's coordinates" is "Start".
std::string beginning_of(const std::string& text) {
  std::size_t end = text.size();
  for (const char* sign : {": ", "; ", ", ", " ("}) end = std::min(end, text.find(sign));
  return text.substr(0, end);
}

PageOption page_of_option(const CLI::Option& option, const std::deque<ArgumentInfo>& declared) {
  PageOption page{.name = option.get_positional() ? option.get_name(true) : "",
                  .value = value_word(option),
                  .text = explanation(option),
                  .summary = beginning_of(option.get_description()),
                  .heading = option.get_group(),
                  .is_positional = option.get_positional(),
                  .may_repeat = option.get_expected_max() > 1};
  if (!option.get_lnames().empty()) page.name = "--" + option.get_lnames().front();
  if (!option.get_snames().empty()) page.short_name = "-" + option.get_snames().front();
  const auto info = std::ranges::find(declared, option.get_single_name(), &ArgumentInfo::name);
  if (info != declared.end()) {  // not so --help, which every command has
    page.choices = info->choices;
    page.endings = info->endings;
    page.is_path = info->kind == ArgumentInfo::Kind::path;
  }
  return page;
}

}  // namespace

CommandPage page_of(const Arguments& arguments, const std::vector<std::string>& words) {
  const CLI::App& app = arguments.app();
  CommandPage page{.words = words,
                   .description = app.get_description(),
                   .usage = usage_of(app),
                   .options = {},
                   .no_means = arguments.no_means(),
                   .examples = arguments.examples(),
                   .parts = {}};
  for (const CLI::Option* option : app.get_options()) {
    page.options.push_back(page_of_option(*option, arguments.declared()));
  }
  for (const Arguments& part : arguments.parts()) {
    std::vector<std::string> words_of_part = words;
    words_of_part.push_back(part.app().get_name());
    page.parts.push_back(page_of(part, words_of_part));
  }
  return page;
}

}  // namespace roadbed::tools::cli
