#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <sys/types.h>

namespace roadbed::tools::inline batch {

/// "4GB", "4G", "512 MB", "65536": bytes, in powers of 1000. None if it is no such text, or 0.
std::optional<std::uint64_t> parse_memory_size(std::string_view text);

/// "2 GB", "1.5 MB": of parse_memory_size's units.
std::string memory_size_text(std::uint64_t bytes);

/// Memory of a process [bytes]; 0 if there is none.
struct ProcessMemory {
  std::uint64_t reserved = 0, resident = 0;
};
ProcessMemory memory_of_process(pid_t process);

/// Lets this process reserve so much more than it has now; what goes beyond throws std::bad_alloc.
void limit_memory(std::uint64_t bytes);

}  // namespace roadbed::tools
