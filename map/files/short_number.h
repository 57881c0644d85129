#pragma once

#include <string>

namespace roadbed::map::inline files {

/// A length or coordinate, as short as it can be within half a micrometre.
std::string short_number(double value);

/// A number as short as it can be within a tolerance.
std::string number_within(double value, double tolerance);

}  // namespace roadbed::map::files
