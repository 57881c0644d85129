#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "roadbed/tools/cli/arguments.h"

// Outputs that may go to standard output, which is named `-`: it has no suffix to tell the format
// by, and nothing else may be printed there.

namespace roadbed::tools::inline cli {

/// Declares `--format`, one of these suffixes without their dot.
Argument declare_format(Arguments& arguments, std::string& format,
                        const std::vector<std::string>& suffixes);

/// ".csv": what `--format` says, else the suffix of the output's name.
std::string suffix_of_output(const std::filesystem::path& output, const std::string& format);

/// What is wrong with an output that is `-`; nothing of any other.
/// @param needs_format  and what `--format` says.
/// @param prints        what else would be printed there, such as "--json"; empty if nothing.
std::string standard_output_fault(const std::filesystem::path& output, bool needs_format,
                                  const std::string& format, const std::string& prints);

/// How an output is called in notes: as the user named it, `standard output` for `-`.
std::string output_name(const std::filesystem::path& output);

}  // namespace roadbed::tools::cli
