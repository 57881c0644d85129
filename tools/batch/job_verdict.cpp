#include "roadbed/tools/batch/job_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

namespace roadbed::tools::inline batch {
namespace {

using nlohmann::json;

std::size_t count_where(const json& list, const char* key, const json& value) {
  return static_cast<std::size_t>(
      std::ranges::count_if(list, [&](const json& element) { return element.at(key) == value; }));
}

JobVerdict import_verdict(const json& document) {
  const double faults = document.at("faults").get<double>();
  return {
      fmt::format("{}, {} lanes, {} faults mended or left out",
                  document.at("format").get<std::string>(), document.at("lanes").dump(), faults),
      faults};
}

// Errors weigh more than any number of warnings, these more than notes.
JobVerdict validate_verdict(const json& document) {
  const json& findings = document.at("findings");
  const std::size_t errors = count_where(findings, "severity", "error");
  const std::size_t warnings = count_where(findings, "severity", "warning");
  const std::size_t notes = findings.size() - errors - warnings;
  constexpr double kMore = 1e6;
  return {fmt::format("{} errors, {} warnings, {} notes", errors, warnings, notes),
          (static_cast<double>(errors) * kMore + static_cast<double>(warnings)) * kMore +
              static_cast<double>(notes)};
}

JobVerdict route_verdict(const json& document) {
  if (document.contains("answers")) {
    const json& answers = document.at("answers");
    const std::size_t none = count_where(answers, "found", false);
    return {fmt::format("{} of {} pairs without a route", none, answers.size()),
            static_cast<double>(none)};
  }
  if (!document.at("found").get<bool>()) {
    return {"no route: " + document.at("reason").get<std::string>(), 0.0};
  }
  const double cost_s = document.at("cost_s").get<double>();
  return {fmt::format("{:.1f} s, {:.1f} m", cost_s, document.at("length_m").get<double>()), cost_s};
}

// Of two that reach their goal the later one is worse; of two that do not, the one that ends
// sooner.
JobVerdict simulate_verdict(const json& document) {
  if (document.contains("drives")) {
    const json& drives = document.at("drives");
    const std::size_t missed = drives.size() - count_where(drives, "outcome", "goal reached");
    return {fmt::format("{} of {} do not reach their goal", missed, drives.size()),
            static_cast<double>(missed)};
  }
  const double duration_s = document.at("duration_s").get<double>();
  const bool is_reached = document.at("goal_reached").get<bool>();
  return {document.at("text").get<std::string>(), is_reached ? duration_s : -duration_s};
}

JobVerdict audit_verdict(const json& document) {
  if (document.contains("holds")) {
    const bool holds = document.at("holds").get<bool>();
    return {holds ? "the certificate holds" : "the certificate does not hold", holds ? 0.0 : 1.0};
  }
  const auto verdict = document.at("verdict").get<std::string>();
  if (document.contains("counts")) {
    const std::size_t drives = document.at("audits").size();
    const auto clear = document.at("counts").at("clear").get<std::size_t>();
    return {fmt::format("{}, {} of {} drives are not clear", verdict, drives - clear, drives),
            static_cast<double>(drives - clear)};
  }
  const bool has_occupancy = document.contains("least_clearance_m");
  const double least_m = has_occupancy ? document.at("least_clearance_m").get<double>()
                                       : document.at("surface").at("least_margin_m").get<double>();
  return {fmt::format("{}, least {} {:.3f} m", verdict, has_occupancy ? "clearance" : "margin",
                      least_m),
          -least_m};
}

using Reader = JobVerdict (*)(const json& document);

Reader reader_of(std::string_view kind) {
  constexpr std::array<std::pair<std::string_view, Reader>, 5> readers{{
      {"import", import_verdict},
      {"validate", validate_verdict},
      {"route", route_verdict},
      {"simulate", simulate_verdict},
      {"audit", audit_verdict},
  }};
  const auto* const found = std::ranges::find(readers, kind, &decltype(readers)::value_type::first);
  if (found == readers.end()) {
    throw std::invalid_argument(fmt::format("verdict_of: no job is called \"{}\"", kind));
  }
  return found->second;
}

}  // namespace

JobVerdict verdict_of(std::string_view kind, const json& document) {
  const Reader read = reader_of(kind);
  try {
    return read(document);
  } catch (const json::exception& error) {
    throw std::invalid_argument(
        fmt::format("verdict_of: no document of {}: {}", kind, error.what()));
  }
}

}  // namespace roadbed::tools::batch
