#include "roadbed/tools/program.h"

int main(int argc, char** argv) { return roadbed::tools::run_program(argc, argv); }
