#include "roadbed/tools/batch/serve_process.h"

#include <utility>
#include <vector>

namespace roadbed::tools::inline batch {
namespace {

LineProcess::Program server(const std::filesystem::path& folder, const std::string& job_memory,
                            const std::string& memory) {
  std::vector<std::string> words{"roadbed", "batch", "--serve", "--quiet", "-o", folder.string()};
  if (!job_memory.empty()) words.insert(words.end(), {"--job-memory", job_memory});
  if (!memory.empty()) words.insert(words.end(), {"--memory", memory});
  return {.file = "/proc/self/exe",
          .words = std::move(words),
          .what = "a process of its own for jobs",
          .remedy = "run with fewer --threads, or without --isolate",
          .restarts = true};
}

}  // namespace

ServeProcess::ServeProcess(const std::filesystem::path& folder, const std::string& job_memory,
                           const std::string& memory)
    : LineProcess(server(folder, job_memory, memory)) {}

}  // namespace roadbed::tools::batch
