#include <malloc.h>

#include "roadbed/tools/program.h"

int main(int argc, char** argv) {
  // Memory is taken from the system in large steps and not given back before the end: a command
  // makes one large thing, and steps of a page cost a sixth of an import.
  ::mallopt(M_TOP_PAD, 64 << 20);
  ::mallopt(M_TRIM_THRESHOLD, 1 << 30);
  ::mallopt(M_MMAP_THRESHOLD, 1 << 30);
  return roadbed::tools::run_program(argc, argv);
}
