#pragma once

// Private to map/occupancy.

#include <optional>
#include <string>
#include <string_view>

namespace roadbed::map::inline occupancy::inline clouds {

/// Undoes LZF, the compression of `DATA binary_compressed`; none unless the bytes are whole and
/// give exactly `size` bytes. Three bytes give at most 264, so a larger `size` is refused before
/// anything is allocated. Format: LibLZF by Marc Lehmann, lzf_d.c.
std::optional<std::string> decompress_lzf(std::string_view compressed, std::size_t size);

}  // namespace roadbed::map::occupancy::clouds
