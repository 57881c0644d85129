#pragma once

#include <string>
#include <string_view>

namespace roadbed::tools {

/// XXH3 (128 bits) of bytes, as 32 hexadecimal digits. It tells contents apart, and is no defence
/// against those who want two to be the same.
std::string hash_text(std::string_view bytes);

}  // namespace roadbed::tools
