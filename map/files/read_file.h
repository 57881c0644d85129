#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "roadbed/map/files/unpack.h"

namespace roadbed::map::inline files {

/// The bytes of an input: a regular file, a pipe, or standard input, which is named `-`. Of what
/// is packed by gzip or Zstandard, told by content, what it holds (map/files/unpack.h).
///
/// A stream, which can be read once only, is kept as long as the process runs, so that an input
/// may be looked at before it is read, and read again. Safe to call from several threads.
/// @throws InputError if it is missing, a folder or a device, unreadable or empty; if it is packed
///         and damaged, or holds more than `most_unpacked` says; if a stream is larger than
///         kMostUnpackedBytes.
/// @param most_unpacked  of this many packed bytes.
std::string read_file(const std::filesystem::path& file,
                      std::size_t (*most_unpacked)(std::size_t) = most_unpacked_of_maps);

/// Its first bytes, at most `size`; fewer of what is packed, where it cannot be told.
/// @throws InputError as read_file does.
std::string read_file_start(const std::filesystem::path& file, std::size_t size);

/// The first bytes of a regular file as they are stored, packed or not; none of a stream.
/// @throws InputError as read_file does.
std::string stored_start(const std::filesystem::path& file, std::size_t size);

/// SHA-256 of the bytes of a regular file as they are stored, read piece by piece.
/// @throws InputError as read_file does, and for a stream, which nobody could hash again.
std::string sha256_of_file(const std::filesystem::path& file);

/// SHA-256 of the bytes that a stream gave, packed as they were, in hexadecimal digits.
/// @throws InputError as read_file does.
std::string stream_sha256(const std::filesystem::path& file);

/// Whether it can be read once only: standard input as `-`, a pipe or a socket.
bool is_stream(const std::filesystem::path& file);

/// Whether there is something, a folder, or a regular file, behind links. False also where that
/// cannot be looked at (a loop of links, a name that is too long): whoever opens it says why.
bool is_there(const std::filesystem::path& path);
bool is_folder(const std::filesystem::path& path);
bool is_file(const std::filesystem::path& path);

/// Whether it is standard input or output: `-`.
bool is_standard_stream(const std::filesystem::path& file);

/// How an input is called in messages: as the user named it, `standard input` for `-`.
std::string input_name(const std::filesystem::path& file);

/// What its name ends in: ".xyz" for scan.xyz and, without how it is packed, scan.xyz.gz.
std::string suffix_of_input(const std::filesystem::path& file);

/// From now on streams are no inputs, but for those that have been read: who runs many jobs, each
/// known by the bytes that it reads, takes none that cannot be read again, and may have another use
/// for standard input.
void refuse_streams();

}  // namespace roadbed::map::files
