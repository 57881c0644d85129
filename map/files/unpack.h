#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace roadbed::map::inline files {

/// The most bytes that a packed input may unpack to, and that are read of a stream: a few bytes can
/// unpack to any number, and a pipe need not end. What is larger has to be a plain file.
inline constexpr std::size_t kMostUnpackedBytes = std::size_t{1} << 30;

/// The same of maps.
constexpr std::size_t most_unpacked_of_maps(std::size_t) { return kMostUnpackedBytes; }

/// The same of what takes several times its own bytes once it is read, as clouds, octrees and
/// tables of rows do: text of 24 MB some 200 MB. Measured ones are packed to a third or a fifth.
constexpr std::size_t most_unpacked_of_rows(std::size_t packed_bytes) {
  return std::min(kMostUnpackedBytes, 24'000'000 + 8 * packed_bytes);
}

/// Whether bytes begin as gzip [RFC 1952] or Zstandard [RFC 8878] does; no format that roadbed
/// reads begins so.
bool is_packed(std::string_view bytes);

/// What packed bytes hold, all members or frames of them one after the other. No more
/// than twice `most` is in memory at once, and for Zstandard a window of up to 128 MiB.
/// @param name  stands for the file in messages.
/// @throws InputError if they are damaged, cut off, followed by something else, or hold more than
///         `most`.
std::string unpacked(std::string_view bytes, const std::string& name,
                     std::size_t most = kMostUnpackedBytes);

/// The first bytes of what packed bytes hold, at most `size`, as far as they can be told from
/// `start`, the first of the packed ones.
std::string unpacked_start(std::string_view start, std::size_t size);

}  // namespace roadbed::map::files
