#include "roadbed/map/repair/repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <tuple>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/repair/proposals.h"
#include "roadbed/map/validate_file.h"

namespace roadbed::map::inline repair {
namespace {

// Findings of each rule.
using RuleCounts = std::map<std::string, std::size_t>;

RuleCounts by_rule(const std::vector<validation::Finding>& findings) {
  RuleCounts counts;
  for (const validation::Finding& finding : findings) ++counts[finding.rule];
  return counts;
}

using Propose = std::vector<Repair> (*)(const std::string&, const std::string&,
                                        const RepairOptions&);

Propose proposals_of(const Format& format, const std::string& name) {
  if (format.name == "OpenDRIVE") return propose_open_drive;
  if (format.name == "Lanelet2") return propose_lanelet2;
  if (format.name == "CommonRoad") return propose_common_road;
  throw InputError({.file = name,
                    .found = fmt::format("{}, which is not mended", format.name),
                    .needed = "an OpenDRIVE, Lanelet2 or CommonRoad file",
                    .remedy = "mend the file that it was made from"});
}

class Mender {
 public:
  Mender(std::string bytes, const std::string& name, const RepairOptions& options)
      : name_(name), options_(options) {
    MapBytes map = map_bytes(std::move(bytes), name);
    propose_ = proposals_of(map.format, name);
    file_.bytes = std::move(map.bytes);
  }

  RepairedFile mend() {
    const Validation validation = validate_bytes(file_.bytes, name_, options_.validate);
    if (!validation.road_map) {
      throw InputError({.file = name_,
                        .found = "cannot be read as a map: " + validation.refusal,
                        .remedy = "correct that first"});
    }
    file_.before = file_.after = count(validation.findings);
    rules_ = by_rule(validation.findings);
    while (left_ > 0) {
      const std::vector<Repair> proposed = fresh();
      if (proposed.empty() || !make_some(proposed)) break;
    }
    return std::move(file_);
  }

 private:
  static constexpr int kMostValidations = 64;
  using Key = std::tuple<std::string, std::string, std::string>;

  static Key key_of(const Repair& repair) { return {repair.rule, repair.element, repair.what}; }

  std::vector<Repair> proposed() const {
    try {
      return propose_(file_.bytes, name_, options_);
    } catch (const InputError& error) {  // of an element, who reads it knows no file
      InputError::Parts parts = error.parts();
      parts.file = name_;
      throw InputError(parts);
    }
  }

  /// Proposals that have not been tried and do not overlap.
  std::vector<Repair> fresh() const {
    std::vector<Repair> kept;
    std::set<std::pair<std::size_t, std::size_t>> taken;  // end and start of what is replaced
    std::set<std::size_t> places;                         // of what is put in
    const auto is_free = [&](const TextEdit& edit) {
      if (edit.size == 0) {
        const auto around = taken.upper_bound({edit.at, std::string::npos});
        return around == taken.end() || around->second >= edit.at;
      }
      const auto next = taken.upper_bound({edit.at, std::string::npos});
      if (next != taken.end() && next->second < edit.at + edit.size) return false;
      const auto place = places.upper_bound(edit.at);
      return place == places.end() || *place >= edit.at + edit.size;
    };
    for (Repair& repair : proposed()) {
      if (tried_.contains(key_of(repair))) continue;
      if (!std::ranges::all_of(repair.edits, is_free)) continue;
      for (const TextEdit& edit : repair.edits) {
        if (edit.size == 0) places.insert(edit.at);
        if (edit.size > 0) taken.emplace(edit.at + edit.size, edit.at);
      }
      kept.push_back(std::move(repair));
    }
    return kept;
  }

  /// Makes the repairs if that is better, else some of them; false if none.
  bool make_some(std::span<const Repair> proposed) {
    if (left_-- <= 0) return false;
    std::vector<TextEdit> edits;
    for (const Repair& repair : proposed) {
      edits.insert(edits.end(), repair.edits.begin(), repair.edits.end());
    }
    std::string bytes = edited(file_.bytes, std::move(edits));
    const Validation validation = validate_bytes(bytes, name_, options_.validate);
    const FindingCounts counts = count(validation.findings);
    if (validation.road_map && counts < file_.after) {
      file_.bytes = std::move(bytes);
      file_.after = counts;
      rules_ = by_rule(validation.findings);
      for (const Repair& repair : proposed) {
        tried_.insert(key_of(repair));
        file_.repairs.push_back(repair);
      }
      return true;
    }
    if (proposed.size() == 1) {
      tried_.insert(key_of(proposed.front()));
      return false;
    }
    if (validation.road_map) {
      const std::vector<Repair> rest = effective(proposed, by_rule(validation.findings));
      if (rest.size() < proposed.size()) return !rest.empty() && make_some(rest);
    }
    const std::size_t half = proposed.size() / 2;
    // What stands in the text behind the first half has moved if any of that was made.
    return make_some(proposed.first(half)) || make_some(proposed.subspan(half));
  }

  // Without those of rules that find no less when all are made, which are not tried again.
  std::vector<Repair> effective(std::span<const Repair> proposed, RuleCounts now) {
    std::vector<Repair> rest;
    for (const Repair& repair : proposed) {
      if (now[repair.rule] < rules_[repair.rule]) {
        rest.push_back(repair);
      } else {
        tried_.insert(key_of(repair));
      }
    }
    return rest;
  }

  const std::string& name_;
  const RepairOptions& options_;
  Propose propose_ = nullptr;
  RepairedFile file_;
  RuleCounts rules_;  // of the file as it is now
  std::set<Key> tried_;
  int left_ = kMostValidations;
};

}  // namespace

FindingCounts count(const std::vector<validation::Finding>& findings) {
  FindingCounts counts;
  for (const validation::Finding& finding : findings) {
    if (finding.severity == validation::Severity::error) ++counts.errors;
    if (finding.severity == validation::Severity::warning) ++counts.warnings;
    if (finding.severity == validation::Severity::info) ++counts.infos;
  }
  return counts;
}

RepairedFile repair_file(std::string bytes, const std::string& name, const RepairOptions& options) {
  return Mender(std::move(bytes), name, options).mend();
}

}  // namespace roadbed::map::repair
