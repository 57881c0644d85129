// Manual pages and completions against the helps, and in the shells themselves.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "roadbed/tests/support/program_commands.h"
#include "roadbed/tests/support/program_run.h"

namespace roadbed::tests {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::UnorderedElementsAre;

using Words = std::vector<std::string>;

std::string joined(const Words& words, const char* sign) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : sign) + word;
  return text;
}

/// The names of a command's options, "-o" and "--output", as its help lists them.
Words options_of(const Words& command) {
  Words names;
  for (const std::string& line : help_lines(command)) {
    if (line == "Example:") break;
    if (!line.starts_with("  -")) continue;
    std::istringstream list(line.substr(2, line.find(' ', 2) - 2));
    for (std::string name; std::getline(list, name, ',');) names.push_back(name);
  }
  return names;
}

/// Whether a program is installed, by the shell's own look-up.
bool is_installed(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null").c_str()) == 0;
}

class Share : public testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(run_roadbed({"help", "--share", share()}).status, 0); }

  std::string share() const { return folder_ / "share"; }

  std::string manual(const Words& command) const {
    return bytes_of(share() + "/man/man1/" + joined(command, "-") + ".1");
  }

  /// The lines that a shell's script prints.
  Words lines_of(const std::string& shell, const std::string& script) const {
    const std::string file = folder_.write("script", script), out = folder_ / "out";
    const std::string line = "cd " + folder_.path().string() +
                             " && PATH=" + program_file().parent_path().string() + ":$PATH " +
                             shell + " " + file + " > " + out + " 2>&1 < /dev/null";
    EXPECT_EQ(std::system(line.c_str()), 0) << bytes_of(out);
    Words lines;
    std::istringstream stream(bytes_of(out));
    for (std::string text; std::getline(stream, text);) lines.push_back(text);
    return lines;
  }

  /// What bash offers for the last of these words.
  Words offered_by_bash(const Words& words) const {
    std::string quoted;
    for (const std::string& word : words) quoted += " '" + word + "'";
    return lines_of("bash", "source " + share() + "/bash-completion/completions/roadbed\n" +
                                "COMP_WORDS=(" + quoted +
                                ")\nCOMP_CWORD=" + std::to_string(words.size() - 1) +
                                "\n_roadbed\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n");
  }

  Words offered_by_fish(const std::string& line) const {
    Words offered = lines_of("fish --no-config", "source " + share() +
                                                     "/fish/vendor_completions.d/roadbed.fish\n" +
                                                     "complete -C '" + line + "'\n");
    for (std::string& text : offered) text = text.substr(0, text.find('\t'));
    return offered;
  }

  /// What zsh shows when each of the lines is typed and then Tab: on a terminal of its own, as it
  /// completes on one only. A key of our own says when it has shown all. Both words are printed
  /// while its line editor has the terminal: outside of it keys would be lost.
  Words shown_by_zsh(const Words& lines) const {
    std::string script = R"(zmodload zsh/zpty
zpty z 'TERM=dumb zsh -f -i'
zpty -w z 'stty cols 200 rows 200; PS1=; setopt no_auto_menu; LISTMAX=1000'
zpty -w z 'fpath=(SHARE/zsh/site-functions $fpath); autoload -Uz compinit; compinit -D -u'
zpty -w z 'all() { print A""LL >$TTY }; zle -N all; bindkey "^X^X" all'
zpty -w z 'zle-line-init() { print REA""DY >$TTY }; zle -N zle-line-init'
zpty -r z text '*READY*'
)";
    script.replace(script.find("SHARE"), 5, share());
    for (const std::string& line : lines) {
      script += "zpty -w -n z $'\\C-U'" + ("'" + line + "'") + "$'\\t\\t\\C-X\\C-X'\n" +
                "zpty -r z text '*ALL*'\nprint -r -- $text\nprint NEXT\n";
    }
    Words shown{""};
    for (const std::string& text : lines_of("zsh -f", script + "zpty -d z\n")) {
      text == "NEXT" ? shown.emplace_back() : shown.back() += text + "\n";
    }
    return shown;
  }

  TemporaryFolder folder_;
};

TEST_F(Share, HasAManualPageForEveryCommandWithEveryOptionAndItsExitStatus) {
  std::set<std::string> expected{"roadbed.1"};
  for (Words command : all_commands()) {
    const Words options = options_of(command);
    command.insert(command.begin(), "roadbed");
    expected.insert(joined(command, "-") + ".1");
    const std::string page = manual(command);
    for (std::string name : options) {
      for (std::size_t at = 0; (at = name.find('-', at)) != std::string::npos; at += 2) {
        name.insert(at, "\\");
      }
      EXPECT_THAT(page, HasSubstr("\\fB" + name + "\\fR")) << joined(command, " ");
    }
    for (const char* section : {"NAME", "SYNOPSIS", "DESCRIPTION", "SEE ALSO"}) {
      EXPECT_THAT(page, HasSubstr(std::string(".SH ") + section + "\n")) << joined(command, " ");
    }
  }
  for (const Words& command : commands_that_run()) {
    Words words = command;
    words.insert(words.begin(), "roadbed");
    EXPECT_THAT(manual(words), AllOf(HasSubstr(".SH EXIT STATUS\n"), HasSubstr(".SH EXAMPLES\n")));
  }
  std::set<std::string> written;
  for (const std::string& name : files_below(share() + "/man/man1")) written.insert(name);
  EXPECT_EQ(written, expected);
}

TEST_F(Share, HasManualPagesThatManReadsWithoutAWarning) {
  if (!is_installed("man")) GTEST_SKIP() << "man is not installed (tools/setup --tests)";
  for (const std::string& name : files_below(share() + "/man/man1")) {
    const Words said = lines_of("sh",
                                "LC_ALL=C.UTF-8 MANROFFSEQ= MANWIDTH=80 man --warnings -E UTF-8 -l "
                                "-Tutf8 -Z " +
                                    share() + "/man/man1/" + name + " > /dev/null\n");
    EXPECT_EQ(joined(said, "\n"), "") << name;
  }
}

TEST_F(Share, HasManualPagesThatMandocFindsNoFaultIn) {
  if (!is_installed("mandoc")) GTEST_SKIP() << "mandoc is not installed (tools/setup --tests)";
  EXPECT_EQ(
      joined(lines_of("sh", "mandoc -T lint -W warning " + share() + "/man/man1/*.1\n"), "\n"), "");
}

TEST_F(Share, LetsBashCompleteEveryCommandAndOption) {
  EXPECT_THAT(offered_by_bash({"roadbed", ""}), IsSupersetOf(commands_in(help_lines({}))));
  EXPECT_THAT(offered_by_bash({"roadbed", "occupancy", ""}),
              UnorderedElementsAre("build", "crop", "diff", "export", "info", "merge", "objects"));
  for (const Words& command : all_commands()) {
    Words words = command;
    words.insert(words.begin(), "roadbed");
    words.emplace_back("-");
    EXPECT_THAT(offered_by_bash(words), IsSupersetOf(options_of(command))) << joined(words, " ");
  }
}

TEST_F(Share, LetsBashCompleteWordsAndFilesByWhatAnOptionReads) {
  for (const char* name : {"a town.xodr", "town.osm.gz", "town.txt", "street.bt"}) {
    folder_.write(name, "");
  }
  EXPECT_THAT(offered_by_bash({"roadbed", "validate", "--fail-on", ""}),
              UnorderedElementsAre("error", "warning", "info"));
  EXPECT_THAT(offered_by_bash({"roadbed", "--threads", "2", "-q", "info", ""}),
              UnorderedElementsAre("a town.xodr", "town.osm.gz", "share"));
  EXPECT_THAT(offered_by_bash({"roadbed", "audit", "--occupancy", "st"}),
              UnorderedElementsAre("street.bt"));
  EXPECT_THAT(offered_by_bash({"roadbed", "export", "town.osm", "-o", "town"}),
              IsSupersetOf({"town.txt", "town.osm.gz"}));
  EXPECT_THAT(offered_by_bash({"roadbed", "route", "--from", ""}), UnorderedElementsAre(""));
}

TEST_F(Share, LetsFishComplete) {
  if (!is_installed("fish")) GTEST_SKIP() << "fish is not installed (tools/setup --tests)";
  folder_.write("town.xodr", "");
  folder_.write("town.txt", "");
  EXPECT_THAT(offered_by_fish("roadbed "), IsSupersetOf(commands_in(help_lines({}))));
  EXPECT_THAT(offered_by_fish("roadbed occupancy "),
              UnorderedElementsAre("build", "crop", "diff", "export", "info", "merge", "objects"));
  for (const Words& command : all_commands()) {
    const Words offered = offered_by_fish("roadbed " + joined(command, " ") + " --");
    for (const std::string& name : options_of(command)) {
      if (!name.starts_with("--")) continue;
      EXPECT_THAT(offered, Contains(name)) << joined(command, " ");
    }
  }
  EXPECT_THAT(offered_by_fish("roadbed validate --fail-on "),
              UnorderedElementsAre("error", "warning", "info"));
  EXPECT_THAT(offered_by_fish("roadbed --threads 2 info town"), UnorderedElementsAre("town.xodr"));
}

TEST_F(Share, LetsZshComplete) {
  if (!is_installed("zsh")) GTEST_SKIP() << "zsh is not installed (tools/setup --tests)";
  folder_.write("town.xodr", "");
  folder_.write("town.txt", "");
  const std::vector<Words> commands = all_commands();
  Words lines{"roadbed ", "roadbed validate --fail-on ", "roadbed info t"};
  for (const Words& command : commands) lines.push_back("roadbed " + joined(command, " ") + " --");
  const Words shown = shown_by_zsh(lines);
  ASSERT_EQ(shown.size(), lines.size() + 1);
  for (const std::string& name : commands_in(help_lines({}))) {
    EXPECT_THAT(shown[0], HasSubstr("\n" + name)) << name;
  }
  EXPECT_THAT(shown[1], AllOf(HasSubstr("error"), HasSubstr("warning")));
  EXPECT_THAT(shown[2], HasSubstr("roadbed info town.xodr"));
  for (std::size_t i = 0; i < commands.size(); ++i) {
    Words names = options_of(commands[i]);
    std::erase_if(names, [](const std::string& name) { return !name.starts_with("--"); });
    const auto shows = [](const std::string& text) {
      return [&text](const std::string& name) { return text.find(name) != std::string::npos; };
    };
    // Keys that reach a busy machine's zsh while it draws are lost: such a line is typed again.
    std::string text = shown[i + 3];
    for (int tries = 0; tries < 4 && !std::ranges::all_of(names, shows(text)); ++tries) {
      text = shown_by_zsh({lines[i + 3]}).front();
    }
    for (const std::string& name : names) EXPECT_THAT(text, HasSubstr(name)) << lines[i + 3];
  }
}

}  // namespace
}  // namespace roadbed::tests
