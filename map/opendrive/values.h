#pragma once

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/geometry/curves/piecewise_cubic.h"
#include "roadbed/map/elements/lane.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/xml.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/opendrive/document.h"

namespace roadbed::map::opendrive {

/// Longest road that is taken for one [m].
inline constexpr double kLongestRoadM = 1e6;

/// Reads attributes of elements, and goes on where they are broken: the first fault is kept, by
/// which the file is then no map.
class AttributeReader {
 public:
  explicit AttributeReader(const XmlDocument& document) : xml(document) {}

  /// A finite number; NaN, and a fault, where it is missing or broken.
  double number(pugi::xml_node node, const char* attribute);

  /// The same, looked for from `next` on, as XmlDocument does.
  double number(pugi::xml_node node, const char* attribute, pugi::xml_attribute& next);

  /// The same, `fallback` where the attribute is missing.
  double number_or(pugi::xml_node node, const char* attribute, double fallback);

  /// Where something is along a road [m]: a fault, too, where no road is so long.
  double station_m(pugi::xml_node node, const char* attribute);
  double station_m(pugi::xml_node node, const char* attribute, pugi::xml_attribute& next);

  /// None, and a fault, where it is missing or no whole number.
  std::optional<int> integer(pugi::xml_node node, const char* attribute);

  /// Empty, and a fault, where it is missing or empty.
  std::string text(pugi::xml_node node, const char* attribute);

  /// A fault at the element.
  void refuse(pugi::xml_node node, const std::string& found, const std::string& needed,
              const std::string& remedy);

  /// Does what `read` does; its faults are not the file's.
  /// @returns the first of them.
  template <typename Read>
  std::optional<InputError> set_aside(const Read& read) {
    std::optional<InputError> before = std::exchange(fault_, std::nullopt);
    read();
    return std::exchange(fault_, std::move(before));
  }

  /// A fault that another reader found.
  void keep(InputError fault) {
    if (!fault_) fault_ = std::move(fault);
  }

  const std::optional<InputError>& fault() const { return fault_; }

  const XmlDocument& xml;

 private:
  template <typename Read>
  void keep_fault_of(const Read& read);

  std::optional<InputError> fault_;
};

/// Attributes a, b, c, d with the station `s_attribute`, to which `s_add_m` is added.
geometry::CubicRecord read_cubic(AttributeReader& in, pugi::xml_node node, const char* s_attribute,
                                 double s_add_m);

/// All children of that name, as listed.
std::vector<CubicElement> read_cubics(AttributeReader& in, pugi::xml_node parent, const char* name,
                                      const char* s_attribute, double s_add_m);

/// Where a record begins; that of an element is a member of it.
template <typename Record>
auto& station_m(Record& record) {
  if constexpr (requires { record.record; }) {
    return record.record.s_m;
  } else {
    return record.s_m;
  }
}

/// Stations no farther apart than rounding puts them are one [m].
constexpr double kRoundingM = 1e-6;

/// In order of station; records of one station stay as they are listed, so that the last of them
/// holds. A step back that rounding may have made is none: the record begins where the one before
/// it does.
template <typename Record>
void sort_by_station(std::vector<Record>& records) {
  bool in_order = true;
  for (std::size_t i = 1; i < records.size(); ++i) {
    const double before_m = station_m(records[i - 1]);
    double& here_m = station_m(records[i]);
    if (here_m < before_m && before_m - here_m <= kRoundingM) here_m = before_m;
    in_order = in_order && !(here_m < before_m);
  }
  if (in_order) return;
  std::stable_sort(records.begin(), records.end(),
                   [](const Record& a, const Record& b) { return station_m(a) < station_m(b); });
}

/// Up to its first record a profile of a road is 0 (ASAM OpenDRIVE 10.5.1, 11.4), not what that
/// record would be there.
void begin_at_zero(std::vector<geometry::CubicRecord>& records);

/// max with its unit (m/s if there is none); infinite for "no limit", none for "undefined" or where
/// there is no max. A value or unit that nobody can read is remarked and counts as none: a missing
/// speed must not make a road unusable.
std::optional<double> read_speed(const XmlDocument& xml, pugi::xml_node speed,
                                 std::vector<ImportDiagnostic>& remarks);

/// Who may use a lane of that type where the file does not say.
Participants participants_of(LaneType type);

/// Whether the word is "true" or "1".
bool is_true(std::string_view word);

/// '+', '-', or 0 for everything else.
char orientation_of(std::string_view word);

/// <validity> children.
LaneRanges read_lane_ranges(AttributeReader& in, pugi::xml_node node);

/// Adds those attributes that the element has, as they stand.
void keep_attributes(pugi::xml_node node, std::initializer_list<const char*> names,
                     Attributes& attributes);

/// A remark that an element could not be read and is left out.
ImportDiagnostic left_out(const char* rule, const InputError& error);

/// Does what `read` does; a fault in it becomes a remark.
/// @returns whether there is one, so that the element is left out.
template <typename Read>
bool is_broken(AttributeReader& in, const char* rule, std::vector<ImportDiagnostic>& remarks,
               const Read& read) {
  const std::optional<InputError> fault = in.set_aside(read);
  if (fault) remarks.push_back(left_out(rule, *fault));
  return fault.has_value();
}

/// All attributes of an element in one line: "id 5, type limitline".
std::string described(pugi::xml_node node);

/// OpenDRIVE's name of a lane type; `other` if it is not known.
LaneType lane_type(std::string_view word);

}  // namespace roadbed::map::opendrive
