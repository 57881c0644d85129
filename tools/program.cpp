#include "roadbed/tools/program.h"

#include <fmt/ostream.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <functional>
#include <iostream>
#include <iterator>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/tools/cli/build_id.h"
#include "roadbed/tools/cli/help_text.h"
#include "roadbed/tools/cli/standard_error.h"
#include "roadbed/tools/cli/standard_output.h"
#include "roadbed/tools/cli/usage_error.h"
#include "roadbed/tools/commands/commands.h"
#include "roadbed/tools/help_command.h"

namespace roadbed::tools {
namespace {

struct Entry {
  const char* name;
  std::unique_ptr<Command> (*make)();
};

// In the order in which --help lists them.
// clang-format off: one a line, so that two new ones do not meet in a merge
constexpr Entry kCommands[] = {
    {"import", make_import_command},
    {"info", make_info_command},
    {"validate", make_validate_command},
    {"export", make_export_command},
    {"convert", make_convert_command},
    {"diff", make_diff_command},
    {"map", make_map_command},
    {"locate", make_locate_command},
    {"route", make_route_command},
    {"reach", make_reach_command},
    {"reference", make_reference_command},
    {"plan", make_plan_command},
    {"control", make_control_command},
    {"drive", make_drive_command},
    {"simulate", make_simulate_command},
    {"pilot", make_pilot_command},
    {"occupancy", make_occupancy_command},
    {"audit", make_audit_command},
    {"figures", make_figures_command},
    {"report", make_report_command},
    {"batch", make_batch_command},
    {"jobs", make_jobs_command},
};
// clang-format on

// Declaring the options of all commands takes longer than many an answer: a command that comes
// first is the only one that is needed.
std::span<const Entry> entries_for(int argc, char** argv) {
  if (argc < 2) return kCommands;
  const auto named =
      std::find_if(std::begin(kCommands), std::end(kCommands),
                   [&](const Entry& entry) { return std::string_view(argv[1]) == entry.name; });
  return named == std::end(kCommands) ? std::span<const Entry>(kCommands)
                                      : std::span<const Entry>(named, 1);
}

struct Registered {
  Arguments arguments;
  std::unique_ptr<Command> command;
};

Exit guarded(const std::function<Exit()>& run) {
  try {
    return run();
  } catch (const std::exception& error) {
    const Failure failure = failure_of(error);
    fmt::print(std::cerr, "roadbed: {}\n", failure.text);
    return failure.exit;
  }
}

Exit run_registered(const Registered& registered, CommonOptions& common) {
  common.input_files = registered.arguments.input_files();
  const std::string fault = registered.arguments.output_fault(common.input_files);
  if (!fault.empty()) {
    fmt::print(std::cerr, "roadbed: {}\n", fault);
    return Exit::usage;
  }
  return registered.command->run({std::cout, std::cerr}, common);
}

// The first line tells programs apart that may come to different results.
std::string version_text() {
  return name_and_version() + " (build " + build_id() + ", libraries " + libraries_id() +
         ")\n" ROADBED_LIBRARIES;
}

int run_command_line(int argc, char** argv) {
  CLI::App app("Digital road maps to exact lanes, routes, drives and collision audits");
  app.name("roadbed");
  app.formatter(make_help_formatter());
  app.set_version_flag("--version", version_text);
  app.fallthrough();
  app.failure_message(usage_message);

  CommonOptions common;
  Arguments program(app);
  program.flag("-q,--quiet", common.quiet, "No progress and no notes; errors are still printed");
  program
      .add("--threads", common.threads,
           "Threads to use; the output is the same for any (by default 1; import and export to "
           "OpenDRIVE: one for each processor, up to 4)")
      .checked([](const std::string& text) {
        int threads = 0;
        const bool is_count = CLI::detail::lexical_cast(text, threads) && threads > 0;
        return is_count ? std::string() : text + " is no whole number greater than 0";
      });

  std::vector<Registered> commands;
  const auto declare = [&](const char* name, std::unique_ptr<Command> command) {
    commands.push_back({program.part(name), std::move(command)});
    commands.back().command->declare(commands.back().arguments);
  };
  const std::span<const Entry> entries = entries_for(argc, argv);
  for (const Entry& entry : entries) declare(entry.name, entry.make());
  if (entries.size() > 1) declare("help", make_help_command(program));

  return static_cast<int>(guarded([&] {
    try {
      app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return app.exit(error) == 0 ? Exit::ok : Exit::usage;
    }
    for (const Registered& registered : commands) {
      if (registered.arguments.given()) return run_registered(registered, common);
    }
    return Exit::usage;
  }));
}

}  // namespace

int run_program(int argc, char** argv) {
  hold_closed_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error of writing
  StandardOutput standard_output;
  const StandardError standard_error;
  const int status = run_command_line(argc, argv);
  if (standard_output.finish()) return status;
  fmt::print(std::cerr, "roadbed: {}\n", standard_output.fault());
  return status <= static_cast<int>(Exit::no) ? static_cast<int>(Exit::unusable) : status;
}

}  // namespace roadbed::tools
