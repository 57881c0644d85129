#pragma once

#include <cstddef>
#include <string>

namespace roadbed::tools::inline batch {

/// "1,234,567".
std::string with_commas(std::size_t number);

}  // namespace roadbed::tools
