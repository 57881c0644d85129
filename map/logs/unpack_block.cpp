#include "roadbed/map/logs/unpack_block.h"

#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include <memory>
#include <new>

namespace roadbed::map::inline logs {
namespace {

constexpr const char* kOtherSize = "is not of the size that it says";

// As far as that can be told before any memory is taken for it.
bool may_hold(std::string_view packed, BlockPacking packing, std::uint64_t size) {
  if (packing == BlockPacking::lz4) {
    constexpr std::uint64_t most_per_byte = 255;  // [LZ4 block format, matches]
    return size / most_per_byte <= packed.size();
  }
  const auto held = ZSTD_getFrameContentSize(packed.data(), packed.size());
  return held == ZSTD_CONTENTSIZE_UNKNOWN || held == ZSTD_CONTENTSIZE_ERROR || held == size ||
         ZSTD_findFrameCompressedSize(packed.data(), packed.size()) < packed.size();
}

struct FreeContext {
  void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
};

std::string unpack_lz4(std::string_view packed, std::string& into) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0) {
    throw std::bad_alloc();
  }
  const std::unique_ptr<LZ4F_dctx, FreeContext> context(made);
  std::size_t taken = 0, given = 0, hint = 1;
  while (hint != 0) {
    std::size_t from = packed.size() - taken, room = into.size() - given;
    hint = LZ4F_decompress(context.get(), into.data() + given, &room, packed.data() + taken, &from,
                           nullptr);
    if (LZ4F_isError(hint) != 0) return LZ4F_getErrorName(hint);
    taken += from;
    given += room;
    if (from == 0 && room == 0) break;
  }
  if (hint != 0) return given == into.size() ? "holds more than it says" : "ends within its data";
  return given == into.size() && taken == packed.size() ? "" : kOtherSize;
}

std::string unpack_zstandard(std::string_view packed, std::string& into) {
  const std::size_t given = ZSTD_decompress(into.data(), into.size(), packed.data(), packed.size());
  if (ZSTD_isError(given) != 0) return ZSTD_getErrorName(given);
  return given == into.size() ? "" : kOtherSize;
}

}  // namespace

std::string unpack_block(std::string_view packed, BlockPacking packing, std::uint64_t size,
                         std::string& into) {
  if (!may_hold(packed, packing, size)) return kOtherSize;
  into.resize(size);
  return packing == BlockPacking::lz4 ? unpack_lz4(packed, into) : unpack_zstandard(packed, into);
}

}  // namespace roadbed::map::logs
