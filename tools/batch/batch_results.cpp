#include "roadbed/tools/batch/batch_results.h"

#include <fmt/format.h>

#include <string>

#include "roadbed/tools/batch/batch_page.h"
#include "roadbed/tools/batch/buffered_output.h"
#include "roadbed/tools/batch/counted.h"
#include "roadbed/tools/files/output_file.h"

namespace roadbed::tools::inline batch {
namespace {

constexpr std::size_t kMostListed = 500;  // of each kind

}  // namespace

BatchSummary write_results(const ResultStore& store, const std::vector<LineResult>& order,
                           const std::filesystem::path& folder) {
  BatchSummary summary(kMostListed);
  BufferedOutput results(folder / "results.jsonl");
  for (const LineResult& job : order) {
    const std::string line = store.line(job.hash);
    results.add(fmt::format("{{\"line\":{},", job.line));
    results.add(std::string_view(line).substr(1));
    results.add("\n");
    summary.add(job.line, line);
  }
  results.commit();
  write_output(folder / "summary.json", summary.document(kMostInSummary));
  write_output(folder / "index.html",
               batch_page(summary, fmt::format("{} jobs", with_commas(order.size()))));
  return summary;
}

}  // namespace roadbed::tools
