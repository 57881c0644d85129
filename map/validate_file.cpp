#include "roadbed/map/validate_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "roadbed/map/compiled/compiled_map.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/files/xml_characters.h"
#include "roadbed/map/formats.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/suppressions.h"
#include "roadbed/map/validation/validate.h"

namespace roadbed::map {
namespace {

namespace fs = std::filesystem;

using Findings = std::vector<validation::Finding>;

void append(Findings& to, Findings from) {
  std::move(from.begin(), from.end(), std::back_inserter(to));
}

void sort_by_rule(Findings& findings) {
  std::stable_sort(
      findings.begin(), findings.end(),
      [](const validation::Finding& a, const validation::Finding& b) { return a.rule < b.rule; });
}

/// A rule of ASAM's that a finding about the text names need not be named again for what the map
/// shows of the same element.
void drop_told(Findings& of_map, const Findings& of_text) {
  std::set<std::pair<std::string_view, std::string_view>> told;
  for (const validation::Finding& finding : of_text) {
    if (!finding.asam_rule.empty()) told.emplace(finding.asam_rule, finding.element);
  }
  std::erase_if(of_map, [&](const validation::Finding& finding) {
    return told.contains({finding.asam_rule, finding.element});
  });
}

void add_lines(Findings& findings, const validation::ElementLines& lines) {
  for (validation::Finding& finding : findings) {
    if (finding.line > 0) continue;
    const auto found = lines.find(finding.element);
    if (found != lines.end()) finding.line = found->second;
  }
}

JudgedFile judge(std::string bytes, const std::string& name,
                 const validation::ValidateOptions& options) {
  if (looks_like_xml(bytes) && format_of(bytes) == nullptr) {
    if (auto judged = judge_unknown_root(bytes, name)) return *std::move(judged);
  }
  MapBytes map = map_bytes(std::move(bytes), name);
  if (map.format.judge != nullptr) return map.format.judge(std::move(map.bytes), name, options);
  JudgedFile judged;
  judged.road_map =
      map.format.read(std::move(map.bytes), name, {.max_error_m = options.max_error_m});
  return judged;
}

/// Files of formats with rules of their own that bear the map's name, beside it or in the working
/// folder.
std::vector<fs::path> files_of_its_name(const fs::path& compiled, std::uint64_t most_bytes) {
  const std::string begin = compiled.stem().string() + ".";
  std::set<fs::path> found;
  for (const fs::path& folder : {compiled.parent_path(), fs::path()}) {
    std::error_code error;
    for (fs::directory_iterator entry(folder.empty() ? "." : folder, error), end;
         !error && entry != end; entry.increment(error)) {
      const fs::path file = folder / entry->path().filename();
      if (!file.filename().string().starts_with(begin)) continue;
      if (!entry->is_regular_file(error) || entry->file_size(error) > most_bytes) continue;
      const Format* format = format_of(file);
      if (format != nullptr && format->judge != nullptr) found.insert(file);
    }
  }
  return {found.begin(), found.end()};
}

/// The text that a compiled map was made from, as it is judged; none if it is not found.
/// @param named  where the user says that it is; may be empty.
/// @throws InputError if it is not there.
std::optional<JudgedFile> judge_source(const fs::path& compiled, const fs::path& named,
                                       const validation::ValidateOptions& options) {
  const std::optional<MapSource> source = source_of_compiled_map(compiled);
  if (!source && named.empty()) return {};
  const std::vector<fs::path> places =
      named.empty() ? files_of_its_name(compiled, source->bytes) : std::vector{named};
  for (const fs::path& place : places) {
    std::string bytes = read_file(place);
    if (source_of_content(bytes) == source) {
      return judge(std::move(bytes), input_name(place), options);
    }
  }
  if (named.empty()) return {};
  throw InputError({.file = input_name(named),
                    .found = fmt::format("not what {} was made from", input_name(compiled)),
                    .needed = "that file, unchanged",
                    .remedy = "import it again"});
}

/// What a judged text and the map that it makes, or that was compiled from it, show.
Validation findings_of_both(JudgedFile judged, const validation::ValidateOptions& options) {
  Validation validation{.road_map = std::move(judged.road_map),
                        .refusal = std::move(judged.refusal),
                        .findings = std::move(judged.findings),
                        .lines = std::move(judged.lines)};
  if (validation.road_map) {
    for (validation::Finding& finding : validation.findings) {
      if (finding.in_map) finding.in_map = validation.road_map->to_map(*finding.in_map);
    }
    Findings of_map = validation::validate(*validation.road_map, options);
    drop_told(of_map, validation.findings);
    add_lines(of_map, validation.lines);
    append(validation.findings, std::move(of_map));
  }
  options.choice.apply(validation.findings);
  validation.suppressed = take_suppressed(validation.findings, judged.suppressions);
  sort_by_rule(validation.findings);
  return validation;
}

Validation of_map_alone(RoadMap road_map, const validation::ValidateOptions& options) {
  JudgedFile alone;
  alone.road_map = std::move(road_map);
  return findings_of_both(std::move(alone), options);
}

bool has_rules_of_text(const std::string& map_format) {
  return std::ranges::any_of(formats(), [&](const Format& format) {
    return format.judge != nullptr && map_format.starts_with(format.name);
  });
}

/// A compiled map with the findings about its source's text. The reader's remarks are those of the
/// text, which leaves out what rules say.
Validation validate_compiled(const fs::path& file, const fs::path& named,
                             const validation::ValidateOptions& options) {
  RoadMap road_map = open_compiled_map(file);
  if (!has_rules_of_text(road_map.format())) {
    if (named.empty()) return of_map_alone(std::move(road_map), options);
    throw InputError({.file = input_name(named),
                      .found = "is of " + road_map.format() + ", whose text no rule looks at",
                      .remedy = "leave out --source"});
  }
  std::optional<JudgedFile> source = judge_source(file, named, options);
  if (!source || !source->road_map) {
    Validation validation = of_map_alone(std::move(road_map), options);
    validation.note = fmt::format(
        "what {} was made from is not beside it: no line numbers, and no rules about its text; "
        "name it with --source",
        input_name(file));
    return validation;
  }
  RoadMapParts parts = road_map.parts();
  parts.remarks = source->road_map->parts().remarks;
  source->road_map.emplace(std::move(parts));
  return findings_of_both(*std::move(source), options);
}

}  // namespace

std::vector<validation::RuleInfo> rule_catalogue() {
  std::vector<validation::RuleInfo> catalogue = file_rules();
  for (const Format& format : formats()) {
    if (format.rules == nullptr) continue;
    for (const validation::RuleInfo& rule : format.rules()) catalogue.push_back(rule);
  }
  for (const validation::MapRule& rule : validation::map_rules()) catalogue.push_back(rule.info);
  for (const validation::RuleInfo& rule : validation::import_rules()) catalogue.push_back(rule);
  std::sort(
      catalogue.begin(), catalogue.end(),
      [](const validation::RuleInfo& a, const validation::RuleInfo& b) { return a.id < b.id; });
  return catalogue;
}

Validation validate_bytes(std::string bytes, const std::string& name,
                          const validation::ValidateOptions& options) {
  return findings_of_both(judge(std::move(bytes), name, options), options);
}

Validation validate_file(const std::filesystem::path& file,
                         const validation::ValidateOptions& options,
                         const std::filesystem::path& source) {
  if (is_compiled_map(stored_start(file, 16))) return validate_compiled(file, source, options);
  if (!source.empty()) {
    throw InputError({.file = input_name(file),
                      .found = "no compiled map",
                      .needed = "one, as only those have a source",
                      .remedy = "leave out --source"});
  }
  return validate_bytes(read_file(file), input_name(file), options);
}

}  // namespace roadbed::map
