#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace roadbed::map::inline logs {

/// How a block of a file is packed.
enum class BlockPacking { lz4, zstandard };

/// Unpacks a block whose size is known: an LZ4 frame, or Zstandard.
/// @param into  its size becomes `size`; kept by the caller so that memory is used again.
/// @returns what is wrong with the block; empty: it was unpacked, to just that size.
std::string unpack_block(std::string_view packed, BlockPacking packing, std::uint64_t size,
                         std::string& into);

/// The most bytes that a block of a file may unpack to, so that a claim takes no more memory than
/// a file of its size is worth.
constexpr std::uint64_t most_unpacked(std::uint64_t file_bytes) {
  return (std::uint64_t{128} << 20) + 4 * file_bytes;
}

/// The same of all blocks of a log, which are unpacked one after the other: time.
constexpr std::uint64_t most_unpacked_in_all(std::uint64_t file_bytes) {
  return most_unpacked(file_bytes) + 60 * file_bytes;
}

}  // namespace roadbed::map::logs
