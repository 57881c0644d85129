#pragma once

#include <map>
#include <string>
#include <vector>

#include "roadbed/map/formats/xml.h"
#include "roadbed/map/validation/rule.h"
#include "roadbed/map/validation/validate.h"

// Rules about the text of a file: they see what a reader mends or refuses.

namespace roadbed::map::rules {

/// Line of each element that findings name: "road 12", "lane 12/0/-1", "lanelet 4".
using ElementLines = std::map<std::string, long, std::less<>>;

/// Every fault of a document of a known format; places are in the source's coordinates.
std::vector<Finding> check_source(const XmlDocument& xml, const ValidateOptions& options);

/// Lines of the elements of a document of a known format.
ElementLines element_lines(const XmlDocument& xml);

/// Whether bytes that are not even XML are meant to be of a known format.
bool names_known_format(const std::string& bytes);

/// For bytes that are no XML; `message` is what the parser said of the file `name`.
Finding not_well_formed(const std::string& name, const std::string& message);

/// What all rules about sources are for.
std::vector<RuleInfo> source_rule_infos();

}  // namespace roadbed::map::rules
