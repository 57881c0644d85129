#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace roadbed::tools::inline cli {

/// Files that a file names in turn, so that a command which is given it reads them too; none if it
/// cannot be read.
using FilesNamed =
    std::function<std::vector<std::filesystem::path>(const std::filesystem::path& file)>;

/// The file that a text of words names, "area:town.geojson"; empty if it names none.
using FileInWords = std::function<std::filesystem::path(const std::string& text)>;

/// What is known of a declared argument beside its value.
struct ArgumentInfo {
  enum class Kind { value, flag, path };
  enum class Use { none, input, output };

  std::string name;  ///< the long name of an option, without dashes; of a positional its own
  Kind kind = Kind::value;
  bool is_positional = false, is_required = false;
  Use use = Use::none;                    ///< of a path; declared by `reads` and `writes`
  FilesNamed named = {};                  ///< of an input
  FileInWords file_in = {};               ///< of a value that may name an input
  std::string suffix = {};                ///< of an output: see Argument::writes
  std::vector<std::string> choices = {};  ///< the only words that it takes; empty: any
  std::string_view endings = {};          ///< of a path: see Argument::ending
  CLI::Option* option = nullptr;
};

/// What files of a kind end in, for Argument::ending.
inline constexpr std::string_view kMapEndings = ".xodr .osm .xml .geojson .rbm",
                                  kScenarioEndings = ".json .xml",
                                  kCloudEndings = ".pcd .ply .las .laz .xyz .bt .ot",
                                  kOctreeEndings = ".bt .ot";

/// One option or positional argument of a command; its functions narrow what is accepted.
class Argument {
 public:
  Argument(CLI::Option& option, ArgumentInfo& info) : option_(&option), info_(&info) {}

  Argument& required();
  /// Shows the value that stands now as the default in the help.
  Argument& with_default();
  /// Number from `least` to `most`, both allowed.
  Argument& within(double least, double most);
  Argument& positive();
  Argument& not_negative();
  /// Takes just so many values.
  Argument& values(int count);
  /// Takes one value each time that it is given, so that what stands behind is no other one.
  Argument& one_each();
  /// Takes its values as one text, with this sign between them.
  Argument& separated_by(char sign);
  Argument& one_of(const std::vector<std::string>& accepted);
  /// `fault` says what is wrong with a text, and nothing if it is fine.
  Argument& checked(std::function<std::string(const std::string& text)> fault);
  /// May not stand beside another.
  Argument& excludes(const Argument& other);
  /// Whether the command line has it.
  bool given() const;
  /// Names a file or folder that the command reads, with those that `named` finds in it.
  Argument& reads(FilesNamed named = {});
  /// Its words may name a file that the command reads.
  Argument& may_read(FileInWords file_in);
  /// Names a file or folder that the command writes.
  /// @param suffix  what a name ends in that is chosen for the user: ".json", or "/" for a folder;
  ///                empty: what is written differs from run to run, and is not chosen for him.
  Argument& writes(const std::string& suffix);
  /// What the names of files that it takes mostly end in, blanks between, for shells to offer;
  /// lives as long as the program.
  Argument& ending(std::string_view endings);

 private:
  CLI::Option* option_;
  ArgumentInfo* info_;
};

/// Declares the arguments of one command. It hides CLI11, whose templates cost the compiler ten
/// seconds in every file that sees them. Names are as in CLI11: "MAP" for a positional, "--at" or
/// "-o,--output" for an option. The variables are set while the command line is parsed, and must
/// live until then.
class Arguments {
 public:
  explicit Arguments(CLI::App& app);

  void description(const std::string& text);
  /// Under which the help lists what is declared from now on. Returns the one before.
  std::string heading(const std::string& text);
  /// Command lines that a reader of the help can copy.
  void example(const std::string& lines);
  /// When the exit status is 1: "there is no route"; empty where the command never says no.
  void says_no_if(const std::string& text);

  Argument add(const std::string& names, std::string& value, const std::string& help);
  Argument add(const std::string& names, std::filesystem::path& value, const std::string& help);
  Argument add(const std::string& names, double& value, const std::string& help);
  Argument add(const std::string& names, int& value, const std::string& help);
  Argument add(const std::string& names, std::size_t& value, const std::string& help);
  Argument add(const std::string& names, std::optional<double>& value, const std::string& help);
  Argument add(const std::string& names, std::vector<double>& values, const std::string& help);
  Argument add(const std::string& names, std::vector<std::string>& values, const std::string& help);
  Argument add(const std::string& names, std::vector<std::filesystem::path>& values,
               const std::string& help);
  Argument flag(const std::string& names, bool& value, const std::string& help);

  /// One of several words, in any case; the one whose meaning `value` has is the default.
  template <class Meaning>
  Argument choice(const std::string& names, Meaning& value,
                  const std::vector<std::pair<std::string, Meaning>>& choices,
                  const std::string& help) {
    std::vector<std::string> words;
    std::string standing;
    for (const auto& [word, meaning] : choices) {
      words.push_back(word);
      if (meaning == value) standing = word;
    }
    const auto take = [choices, &value](std::size_t index) { value = choices[index].second; };
    return choose(names, words, standing, take, help);
  }

  /// A part of the command, as `design` of `control design`; just one must be given.
  Arguments part(const std::string& name);
  const std::vector<Arguments>& parts() const { return *parts_; }
  /// Whether the command line names this command or part.
  bool given() const;

  /// Files and folders that the command line names as inputs, and those that these name.
  std::vector<std::filesystem::path> input_files() const;
  /// Of two outputs that are one file, or an output that is an input, what is wrong; else nothing.
  /// @param inputs  all of them.
  std::string output_fault(const std::vector<std::filesystem::path>& inputs) const;

  /// Looks at all arguments together; `fault` says what is missing, and nothing if all is there.
  void require(std::function<std::string()> fault);

  /// All that was declared, in that order, without those of parts.
  const std::deque<ArgumentInfo>& declared() const { return *declared_; }

  /// What `--help` says; `line` is the command's, from the program's name on.
  std::string help(const std::string& line) const;

  const CLI::App& app() const { return *app_; }
  const std::string& no_means() const { return *no_means_; }
  const std::string& examples() const { return *examples_; }

 private:
  Argument note(CLI::Option& option, ArgumentInfo::Kind kind);
  /// The outputs that the command line names, each with the name of its argument.
  std::vector<std::pair<std::string, std::filesystem::path>> outputs() const;
  Argument choose(const std::string& names, const std::vector<std::string>& words,
                  const std::string& standing, std::function<void(std::size_t)> take,
                  const std::string& help);

  void write_footer();

  CLI::App* app_;
  std::shared_ptr<std::deque<ArgumentInfo>> declared_;  // elements stay where they are
  std::shared_ptr<std::vector<Arguments>> parts_;
  std::shared_ptr<std::string> group_, no_means_, examples_;
};

/// Arguments whose words come from elsewhere than the program's command line.
class ArgumentSet {
 public:
  ArgumentSet();
  ~ArgumentSet();
  ArgumentSet(const ArgumentSet&) = delete;
  ArgumentSet& operator=(const ArgumentSet&) = delete;

  /// To declare them on.
  Arguments& arguments() { return arguments_; }

  /// Sets the variables. Returns what is wrong with the words, in one line; nothing if all is well.
  std::string parse(std::vector<std::string> words);

 private:
  std::unique_ptr<CLI::App> app_;
  Arguments arguments_;
};

}  // namespace roadbed::tools::cli
