#include "roadbed/tools/cli/freed_memory.h"

#include <malloc.h>

namespace roadbed::tools::inline cli {

void keep_freed_memory() {
  constexpr int grown_by_at_once = 1 << 24;
  ::mallopt(M_MMAP_MAX, 0);  // blocks of their own would be new memory each time
  ::mallopt(M_TRIM_THRESHOLD, -1);
  ::mallopt(M_TOP_PAD, grown_by_at_once);
}

}  // namespace roadbed::tools::cli
