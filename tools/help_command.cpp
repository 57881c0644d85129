#include "roadbed/tools/help_command.h"

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/files/visible_text.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/map/storage/output_folder.h"
#include "roadbed/tools/cli/command_page.h"
#include "roadbed/tools/cli/completion.h"
#include "roadbed/tools/cli/manual.h"

namespace roadbed::tools {
namespace {

namespace fs = std::filesystem;

void write_file(const fs::path& file, const std::string& text) {
  map::make_output_folder(file.parent_path(), true);
  map::write_output(file, text, true);
}

void write_manuals(const CommandPage& page, const CommandPage& program, const fs::path& folder) {
  write_file(folder / (manual_name(page.words) + ".1"), manual_page(page, program));
  for (const CommandPage& part : page.parts) write_manuals(part, program, folder);
}

class HelpCommand : public Command {
 public:
  explicit HelpCommand(const Arguments& program) : program_(program) {}

  void declare(Arguments& arguments) override {
    arguments.description("Show the help of a command, or of the program");
    arguments.add("COMMAND", words_, "The command, with its part if it has some");
    arguments.flag("--man", prints_manual_, "Print it as a manual page (roff)");
    arguments.add("--completion", shell_, "Print the completion of command lines for a shell")
        .one_of({"bash", "zsh", "fish"});
    arguments
        .add("--share", folder_,
             "Write all manual pages and completions below this folder, laid out as in /usr/share")
        .writes("");
    arguments.example(
        "  source <(roadbed help --completion bash)\n"
        "  roadbed help --man route | man -l -\n"
        "  roadbed help occupancy build");
  }

  Exit run(const Streams& streams, const CommonOptions& /*common*/) override {
    const CommandPage program = page_of(program_);
    if (!folder_.empty()) {
      write_share(program);
    } else if (!shell_.empty()) {
      streams.out << completion(program);
    } else {
      return show(streams, program);
    }
    return Exit::ok;
  }

 private:
  std::string completion(const CommandPage& program) const {
    if (shell_ == "bash") return bash_completion(program);
    return shell_ == "zsh" ? zsh_completion(program) : fish_completion(program);
  }

  Exit show(const Streams& streams, const CommandPage& program) const {
    const Arguments* command = &program_;
    const CommandPage* page = &program;
    std::string line = "roadbed";
    for (const std::string& word : words_) {
      const auto part = std::ranges::find(page->parts, word,
                                          [](const CommandPage& one) { return one.words.back(); });
      if (part == page->parts.end()) {
        fmt::print(streams.err, "roadbed: {} has no command {}; see: {} --help\n", line,
                   map::one_line(word), line);
        return Exit::usage;
      }
      command = &command->parts()[static_cast<std::size_t>(part - page->parts.begin())];
      page = &*part;
      line += ' ' + word;
    }
    streams.out << (prints_manual_ ? manual_page(*page, program) : command->help(line));
    return Exit::ok;
  }

  void write_share(const CommandPage& program) const {
    write_manuals(program, program, folder_ / "man/man1");
    write_file(folder_ / "bash-completion/completions/roadbed", bash_completion(program));
    write_file(folder_ / "zsh/site-functions/_roadbed", zsh_completion(program));
    write_file(folder_ / "fish/vendor_completions.d/roadbed.fish", fish_completion(program));
  }

  const Arguments& program_;
  std::vector<std::string> words_;
  bool prints_manual_ = false;
  std::string shell_;
  fs::path folder_;
};

}  // namespace

std::unique_ptr<Command> make_help_command(const Arguments& program) {
  return std::make_unique<HelpCommand>(program);
}

}  // namespace roadbed::tools
