#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <string>

namespace roadbed::map::inline edit {

/// The whole number that an id is; none if it is something else.
std::optional<std::int64_t> number_of(const std::string& id);

/// Numbers that are no id yet.
class FreshIds {
 public:
  void take(const std::string& id);
  std::string fresh();

 private:
  std::int64_t next_ = 1;
};

/// What ids become.
using NameChanges = std::map<std::string, std::string>;

/// New ids of what one file of OpenDRIVE holds, by kind.
struct NewIds {
  NameChanges roads, junctions, groups, stations, controllers, signals, objects;

  /// Gives them to the elements, and to all that names these.
  void apply(pugi::xml_node root) const;

  /// The same of one element of the root.
  void apply_to(pugi::xml_node element) const;

 private:
  void apply_to_road(pugi::xml_node road) const;
};

/// Whether the elements of a kind stand in order of their numbers.
bool is_in_order(pugi::xml_node root, const char* kind);
void put_in_order(pugi::xml_node root, const char* kind);

}  // namespace roadbed::map::edit
