#include "roadbed/tools/cli/arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <system_error>
#include <utility>

#include "roadbed/map/files/read_file.h"

namespace roadbed::tools::inline cli {
namespace {

namespace fs = std::filesystem;

/// Whether two paths lead to one file, which need not be there.
bool are_one(const fs::path& a, const fs::path& b) {
  std::error_code error;
  const auto is_device = [&](const fs::path& path) {
    return fs::is_character_file(path, error) || fs::is_fifo(path, error);
  };
  if (is_device(a)) return false;
  if (fs::equivalent(a, b, error)) return true;
  const auto place_of = [&](const fs::path& path) {
    return fs::weakly_canonical(fs::absolute(path, error), error);
  };
  return place_of(a) == place_of(b);
}

std::string refuse_nan(const std::string& text) {
  double number = 0.0;
  const bool is_nan = CLI::detail::lexical_cast(text, number) && std::isnan(number);
  return is_nan ? "is not a number" : "";
}

// CLI11's own checks name limits with six digits, and the greatest number that there is.
template <typename Fits>
auto refuse_unless(Fits fits, const std::string& rule) {
  return [fits, rule](const std::string& text) {
    double number = 0.0;
    return CLI::detail::lexical_cast(text, number) && fits(number) ? "" : text + " is not " + rule;
  };
}

}  // namespace

Argument& Argument::required() {
  option_->required();
  info_->is_required = true;
  return *this;
}

Argument& Argument::with_default() {
  option_->capture_default_str();
  return *this;
}

Argument& Argument::within(double least, double most) {
  option_->check(refuse_nan);  // which is neither below a range nor above it
  option_->check(refuse_unless([=](double number) { return number >= least && number <= most; },
                               fmt::format("a number from {:g} to {:g}", least, most)),
                 fmt::format(" in [{:g} - {:g}]", least, most));
  return *this;
}

Argument& Argument::positive() {
  option_->check(refuse_nan);
  option_->check(refuse_unless([](double number) { return number > 0.0; }, "greater than 0"),
                 "POSITIVE");
  return *this;
}

Argument& Argument::not_negative() {
  option_->check(refuse_nan);
  option_->check(refuse_unless([](double number) { return number >= 0.0; }, "0 or more"),
                 "NONNEGATIVE");
  return *this;
}

Argument& Argument::values(int count) {
  option_->expected(count);
  return *this;
}

Argument& Argument::one_each() {
  option_->allow_extra_args(false);
  return *this;
}

Argument& Argument::separated_by(char sign) {
  option_->delimiter(sign);
  return *this;
}

Argument& Argument::one_of(const std::vector<std::string>& accepted) {
  info_->choices = accepted;
  option_->check(CLI::IsMember(accepted));
  return *this;
}

Argument& Argument::checked(std::function<std::string(const std::string&)> fault) {
  option_->check(std::move(fault));
  return *this;
}

bool Argument::given() const { return option_->count() > 0; }

Argument& Argument::excludes(const Argument& other) {
  option_->excludes(other.option_);
  return *this;
}

Argument& Argument::reads(FilesNamed named) {
  info_->use = ArgumentInfo::Use::input;
  info_->named = std::move(named);
  return *this;
}

Argument& Argument::may_read(FileInWords file_in) {
  info_->file_in = std::move(file_in);
  return *this;
}

Argument& Argument::writes(const std::string& suffix) {
  info_->use = ArgumentInfo::Use::output;
  info_->suffix = suffix;
  return *this;
}

Argument& Argument::ending(std::string_view endings) {
  info_->endings = endings;
  return *this;
}

Arguments::Arguments(CLI::App& app)
    : app_(&app),
      declared_(std::make_shared<std::deque<ArgumentInfo>>()),
      parts_(std::make_shared<std::vector<Arguments>>()),
      group_(std::make_shared<std::string>("Options")),
      no_means_(std::make_shared<std::string>()),
      examples_(std::make_shared<std::string>()) {}

void Arguments::description(const std::string& text) { app_->description(text); }

std::string Arguments::heading(const std::string& text) { return std::exchange(*group_, text); }

void Arguments::example(const std::string& lines) {
  *examples_ = lines;
  write_footer();
}

void Arguments::says_no_if(const std::string& text) {
  *no_means_ = text;
  write_footer();
}

void Arguments::write_footer() {
  const std::string status =
      no_means_->empty()
          ? ""
          : fmt::format("Exit status 1 if {}; for others: roadbed help\n\n", *no_means_);
  app_->footer(status + "Example:\n" + *examples_);
}

Argument Arguments::add(const std::string& names, std::string& value, const std::string& help) {
  return note(*app_->add_option(names, value, help), ArgumentInfo::Kind::value);
}

Argument Arguments::add(const std::string& names, std::filesystem::path& value,
                        const std::string& help) {
  return note(*app_->add_option(names, value, help), ArgumentInfo::Kind::path);
}

Argument Arguments::add(const std::string& names, double& value, const std::string& help) {
  return note(*app_->add_option(names, value, help), ArgumentInfo::Kind::value);
}

Argument Arguments::add(const std::string& names, int& value, const std::string& help) {
  return note(*app_->add_option(names, value, help), ArgumentInfo::Kind::value);
}

Argument Arguments::add(const std::string& names, std::size_t& value, const std::string& help) {
  return note(*app_->add_option(names, value, help), ArgumentInfo::Kind::value);
}

Argument Arguments::add(const std::string& names, std::optional<double>& value,
                        const std::string& help) {
  return note(*app_->add_option(names, value, help), ArgumentInfo::Kind::value);
}

Argument Arguments::add(const std::string& names, std::vector<double>& values,
                        const std::string& help) {
  return note(*app_->add_option(names, values, help), ArgumentInfo::Kind::value);
}

Argument Arguments::add(const std::string& names, std::vector<std::string>& values,
                        const std::string& help) {
  return note(*app_->add_option(names, values, help), ArgumentInfo::Kind::value);
}

Argument Arguments::add(const std::string& names, std::vector<std::filesystem::path>& values,
                        const std::string& help) {
  return note(*app_->add_option(names, values, help), ArgumentInfo::Kind::path);
}

Argument Arguments::flag(const std::string& names, bool& value, const std::string& help) {
  return note(*app_->add_flag(names, value, help), ArgumentInfo::Kind::flag);
}

Arguments Arguments::part(const std::string& name) {
  app_->require_subcommand(1);
  return parts_->emplace_back(*app_->add_subcommand(name));
}

bool Arguments::given() const { return app_->parsed(); }

std::vector<std::pair<std::string, fs::path>> Arguments::outputs() const {
  std::vector<std::pair<std::string, fs::path>> paths;
  for (const ArgumentInfo& argument : *declared_) {
    if (argument.use != ArgumentInfo::Use::output) continue;
    const std::string name = (argument.is_positional ? "" : "--") + argument.name;
    for (const std::string& path : argument.option->results()) {
      if (!map::is_standard_stream(path)) paths.emplace_back(name, path);
    }
  }
  for (const Arguments& part : *parts_) {
    if (part.given()) std::ranges::move(part.outputs(), std::back_inserter(paths));
  }
  return paths;
}

std::vector<fs::path> Arguments::input_files() const {
  std::vector<fs::path> files;
  for (const ArgumentInfo& argument : *declared_) {
    if (argument.file_in) {
      for (const std::string& words : argument.option->results()) {
        if (fs::path file = argument.file_in(words); !file.empty())
          files.push_back(std::move(file));
      }
    }
    if (argument.use != ArgumentInfo::Use::input) continue;
    for (const std::string& path : argument.option->results()) {
      if (map::is_standard_stream(path)) continue;
      files.emplace_back(path);
      if (argument.named) std::ranges::move(argument.named(path), std::back_inserter(files));
    }
  }
  for (const Arguments& part : *parts_) {
    if (part.given()) std::ranges::move(part.input_files(), std::back_inserter(files));
  }
  return files;
}

std::string Arguments::output_fault(const std::vector<fs::path>& inputs) const {
  const auto all = outputs();
  for (auto output = all.begin(); output != all.end(); ++output) {
    const auto is_same = [&](const fs::path& other) { return are_one(output->second, other); };
    if (const auto input = std::ranges::find_if(inputs, is_same); input != inputs.end()) {
      return fmt::format("{} {} is an input; choose another output", output->first,
                         output->second.string());
    }
    for (auto other = all.begin(); other != output; ++other) {
      if (!is_same(other->second)) continue;
      return fmt::format("{} and {} are both {}; give each a file of its own", other->first,
                         output->first, output->second.string());
    }
  }
  return {};
}

void Arguments::require(std::function<std::string()> fault) {
  app_->callback([fault = std::move(fault)] {
    const std::string missing = fault();
    if (!missing.empty()) throw CLI::ValidationError(missing);
  });
}

std::string Arguments::help(const std::string& line) const {
  return app_->get_formatter()->make_help(app_, line, CLI::AppFormatMode::Normal);
}

Argument Arguments::note(CLI::Option& option, ArgumentInfo::Kind kind) {
  if (kind == ArgumentInfo::Kind::path) option.type_name("PATH");
  option.group(*group_);
  declared_->push_back({.name = option.get_single_name(),
                        .kind = kind,
                        .is_positional = option.get_positional(),
                        .option = &option});
  return {option, declared_->back()};
}

Argument Arguments::choose(const std::string& names, const std::vector<std::string>& words,
                           const std::string& standing, std::function<void(std::size_t)> take,
                           const std::string& help) {
  const auto take_word = [words, take = std::move(take)](const std::string& word) {
    const auto found = std::find(words.begin(), words.end(), CLI::detail::to_lower(word));
    take(static_cast<std::size_t>(found - words.begin()));
  };
  CLI::Option* option = app_->add_option_function<std::string>(
      names, take_word, fmt::format("{} ({}; default {})", help, fmt::join(words, ", "), standing));
  option->check(CLI::IsMember(words, CLI::ignore_case));
  option->option_text("WORD");
  const Argument argument = note(*option, ArgumentInfo::Kind::value);
  declared_->back().choices = words;
  return argument;
}

ArgumentSet::ArgumentSet() : app_(std::make_unique<CLI::App>()), arguments_(*app_) {}

ArgumentSet::~ArgumentSet() = default;

std::string ArgumentSet::parse(std::vector<std::string> words) {
  std::reverse(words.begin(), words.end());  // as CLI11 wants them
  try {
    app_->parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    std::string fault = error.what();
    std::replace(fault.begin(), fault.end(), '\n', ' ');
    return fault.empty() ? "the options are wrong" : fault;
  }
  return {};
}

}  // namespace roadbed::tools::cli
