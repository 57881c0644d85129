#include "roadbed/tools/cli/output_format.h"

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/files/visible_text.h"
#include "roadbed/map/formats.h"

namespace roadbed::tools::inline cli {

Argument declare_format(Arguments& arguments, std::string& format,
                        const std::vector<std::string>& suffixes) {
  std::vector<std::string> words;
  for (const std::string& suffix : suffixes) words.push_back(suffix.substr(1));
  return arguments
      .add("--format", format,
           "Format of the output, in place of its suffix; needed for standard output, -o -")
      .one_of(words);
}

std::string suffix_of_output(const std::filesystem::path& output, const std::string& format) {
  return format.empty() ? map::format_suffix(output) : "." + format;
}

std::string standard_output_fault(const std::filesystem::path& output, bool needs_format,
                                  const std::string& format, const std::string& prints) {
  if (!map::is_standard_stream(output)) return {};
  if (needs_format && format.empty()) return "-o - needs --format";
  if (!prints.empty())
    return prints + " and -o - exclude each other, as both go to standard output";
  return {};
}

std::string output_name(const std::filesystem::path& output) {
  return map::is_standard_stream(output) ? "standard output" : map::one_line(output.string());
}

}  // namespace roadbed::tools::cli
