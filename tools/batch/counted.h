#pragma once

#include <cstddef>
#include <string>

namespace roadbed::tools {

/// "1,234,567".
std::string with_commas(std::size_t number);

}  // namespace roadbed::tools
