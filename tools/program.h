#pragma once

namespace roadbed::tools {

/// The whole program: parses the command line, runs the command, turns errors into one line on
/// stderr and an exit status.
int run_program(int argc, char** argv);

}  // namespace roadbed::tools
