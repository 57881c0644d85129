// Lines of jobs and of journals: what `batch` reads that others may have written.

#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/tools/batch/job.h"
#include "roadbed/tools/batch/job_lines.h"
#include "roadbed/tools/batch/job_result.h"
#include "roadbed/tools/commands/commands.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roadbed;
  const tools::JobKinds& kinds = tools::job_kinds();
  constexpr std::size_t longest = 4096;
  std::istringstream stream(std::string(reinterpret_cast<const char*>(data), size));
  tools::JobLines lines(stream, longest);
  while (const auto line = lines.next()) {
    tools::read_head(line->text);
    try {
      const tools::Job job = tools::parse_job(line->text, kinds);
      tools::words_of_options(job);
      tools::inputs_of(job);
    } catch (const map::InputError&) {
      continue;  // refused, as it should be
    }
  }
  return 0;
}
