#pragma once

#include <string>
#include <vector>

#include "roadbed/map/files/xml.h"
#include "roadbed/map/validation/rule.h"

// Rules about the text of a file: they see what a reader mends or refuses.

namespace roadbed::map {

/// Every fault of a document of a known format; places are in the source's coordinates.
std::vector<validation::Finding> check_source(const XmlDocument& xml,
                                              const validation::ValidateOptions& options);

/// Lines of the elements of a document of a known format.
validation::ElementLines element_lines(const XmlDocument& xml);

/// Whether bytes that are not even XML are meant to be of a known format.
bool names_known_format(const std::string& bytes);

/// For bytes that are no XML; `message` is what the parser said of the file `name`.
validation::Finding not_well_formed(const std::string& name, const std::string& message);

/// What all rules about sources are for.
std::vector<validation::RuleInfo> source_rule_infos();

}  // namespace roadbed::map
