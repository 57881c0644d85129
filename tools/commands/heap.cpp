#include "roadbed/tools/commands/heap.h"

#include <malloc.h>
#include <sys/mman.h>

#include <cstdint>
#include <cstdlib>
#include <system_error>

namespace roadbed::tools::inline commands {
namespace {

constexpr std::uintptr_t kHugePage = std::uintptr_t{1} << 21;
constexpr std::uintptr_t kMapPerFile = 8;  // of memory, a file's size of bytes
// Huge pages that the system has to find first cost more than they save.
constexpr std::uintptr_t kMostHugeBytes = std::uintptr_t{1} << 27;
// Of a larger file, lists that grew out of their place would be too much to keep.
constexpr std::uintmax_t kMostKeptBytes = std::uintmax_t{1} << 27;
constexpr int kTopPad = 1 << 24;  // grown by at once

}  // namespace

void keep_heap_in_huge_pages(const std::filesystem::path& input) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(input, error);
  if (error || size > kMostKeptBytes) return;
  // One heap that grows and is not given back; blocks of its own would be new memory each time.
  ::mallopt(M_MMAP_MAX, 0);
  ::mallopt(M_TRIM_THRESHOLD, -1);
  ::mallopt(M_TOP_PAD, kTopPad);
  if (size > kMostHugeBytes / kMapPerFile) return;
  const std::uintptr_t wanted = kMapPerFile * size + kHugePage;
  void* block = std::malloc(wanted);
  if (block == nullptr) return;
  const auto from = (reinterpret_cast<std::uintptr_t>(block) + kHugePage - 1) & ~(kHugePage - 1);
  const auto to = (reinterpret_cast<std::uintptr_t>(block) + wanted) & ~(kHugePage - 1);
  if (to > from) ::madvise(reinterpret_cast<void*>(from), to - from, MADV_HUGEPAGE);
  std::free(block);
}

}  // namespace roadbed::tools::commands
