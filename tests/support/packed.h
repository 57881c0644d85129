#pragma once

#include <string>
#include <string_view>

namespace roadbed::tests {

/// One gzip member, by zlib.
std::string gzipped(std::string_view bytes);

/// One frame of Zstandard with a checksum, by libzstd.
std::string zstandard(std::string_view bytes);

}  // namespace roadbed::tests
