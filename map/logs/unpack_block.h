#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "roadbed/map/files/unpack.h"

namespace roadbed::map::inline logs {

/// How a block of a file is packed.
enum class BlockPacking { lz4, zstandard };

/// Unpacks a block whose size is known: an LZ4 frame, or Zstandard.
/// @param into  its size becomes `size`; kept by the caller so that memory is used again.
/// @returns what is wrong with the block; empty: it was unpacked, to just that size.
std::string unpack_block(std::string_view packed, BlockPacking packing, std::uint64_t size,
                         std::string& into);

/// The most bytes that all blocks of a file may unpack to, one after the other: time. One of them
/// may have as many as any packed input of rows (files::most_unpacked_of_rows): memory.
constexpr std::uint64_t most_unpacked_in_all(std::uint64_t file_bytes) {
  return files::most_unpacked_of_rows(file_bytes) + 60 * file_bytes;
}

}  // namespace roadbed::map::logs
