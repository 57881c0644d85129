#pragma once

#include <xxhash.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

#include "roadbed/map/storage/chunked_file.h"

namespace roadbed::tests {

/// Gives changed bytes of a compiled map right sizes and checksums again, so that what is tried is
/// what lies behind them. Bytes too few for a header stay as they are.
inline void reseal(std::string& bytes) {
  constexpr std::size_t header = 48, section = sizeof(map::ChunkedFile::Section);
  if (bytes.size() < header) return;
  const auto get = [&](std::size_t at) {
    std::uint64_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  };
  const auto put = [&](std::size_t at, std::uint64_t value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
  };
  const std::uint64_t sections = std::min(get(24), (bytes.size() - header) / section);
  const std::uint64_t behind = bytes.size() - header - sections * section;
  // Of the bytes behind the section table, eight per begun chunk are hashes.
  std::uint64_t chunks = 0;
  while (behind > chunks * (map::ChunkedFile::kChunkSize + 8)) ++chunks;
  if (chunks * 8 > behind) return;
  const std::uint64_t body = header + sections * section + chunks * 8;
  std::copy(map::ChunkedFile::kMagic.begin(), map::ChunkedFile::kMagic.end(), bytes.begin());
  put(24, sections);
  put(32, body);
  put(40, bytes.size() - body);
  for (std::uint64_t i = 0; i < chunks; ++i) {
    const std::size_t from = body + i * map::ChunkedFile::kChunkSize;
    const std::size_t size = std::min(map::ChunkedFile::kChunkSize, bytes.size() - from);
    put(body - (chunks - i) * 8, XXH3_64bits(bytes.data() + from, size));
  }
  put(16, XXH3_64bits(bytes.data() + 24, body - 24));
}

}  // namespace roadbed::tests
