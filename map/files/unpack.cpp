#include "roadbed/map/files/unpack.h"

#include <fmt/format.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <memory>
#include <new>
#include <optional>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline files {
namespace {

constexpr std::string_view kGzip = "\x1f\x8b\x08", kZstandard = "\x28\xb5\x2f\xfd";

/// What came of one step: how much was taken and given, and whether a member or frame ended.
struct Step {
  std::size_t taken = 0, given = 0;
  bool ends = false;
  std::string fault = {};
};

class Unpacker {
 public:
  virtual ~Unpacker() = default;
  /// Unpacks some of `from` into `size` bytes at `into`.
  virtual Step step(std::string_view from, char* into, std::size_t size) = 0;
  /// Makes ready for another member or frame.
  virtual void begin_next() = 0;
};

class GzipUnpacker : public Unpacker {
 public:
  GzipUnpacker() {
    constexpr int only_gzip = 16;
    if (inflateInit2(&stream_, MAX_WBITS + only_gzip) != Z_OK) throw std::bad_alloc();
  }
  ~GzipUnpacker() override { inflateEnd(&stream_); }
  GzipUnpacker(const GzipUnpacker&) = delete;
  GzipUnpacker& operator=(const GzipUnpacker&) = delete;

  Step step(std::string_view from, char* into, std::size_t size) override {
    constexpr std::size_t most = std::size_t{1} << 30;  // zlib counts in 32 bits
    const auto there = static_cast<uInt>(std::min(from.size(), most));
    const auto room = static_cast<uInt>(std::min(size, most));
    // zlib does not write to its input; its interface is older than const.
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(from.data()));
    stream_.avail_in = there;
    stream_.next_out = reinterpret_cast<Bytef*>(into);
    stream_.avail_out = room;
    const int code = inflate(&stream_, Z_NO_FLUSH);
    if (code == Z_MEM_ERROR) throw std::bad_alloc();
    Step step{there - stream_.avail_in, room - stream_.avail_out, code == Z_STREAM_END};
    if (code == Z_NEED_DICT || (code < 0 && code != Z_BUF_ERROR)) {
      step.fault = stream_.msg != nullptr ? stream_.msg : "damaged";
    }
    return step;
  }

  void begin_next() override { inflateReset(&stream_); }

 private:
  z_stream stream_{};
};

class ZstandardUnpacker : public Unpacker {
 public:
  ZstandardUnpacker() : context_(ZSTD_createDCtx()) {
    if (!context_) throw std::bad_alloc();
  }

  Step step(std::string_view from, char* into, std::size_t size) override {
    ZSTD_inBuffer in{from.data(), from.size(), 0};
    ZSTD_outBuffer out{into, size, 0};
    const std::size_t code = ZSTD_decompressStream(context_.get(), &out, &in);
    Step step{in.pos, out.pos, code == 0};
    if (ZSTD_isError(code) != 0) step.fault = ZSTD_getErrorName(code);
    return step;
  }

  void begin_next() override { ZSTD_DCtx_reset(context_.get(), ZSTD_reset_session_only); }

 private:
  struct Free {
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
  };
  std::unique_ptr<ZSTD_DCtx, Free> context_;
};

std::unique_ptr<Unpacker> unpacker_for(std::string_view bytes) {
  if (bytes.starts_with(kGzip)) return std::make_unique<GzipUnpacker>();
  return std::make_unique<ZstandardUnpacker>();
}

struct Unpacked {
  std::string bytes, fault;
  std::size_t at = 0;     ///< of the packed bytes, those that were taken
  bool is_whole = false;  ///< ended with a member or frame
};

/// At most `most` bytes of what is packed.
Unpacked unpack(std::string_view packed, std::size_t most) {
  Unpacked result;
  std::string& bytes = result.bytes;
  const auto unpacker = unpacker_for(packed);
  std::size_t given = 0;
  bytes.resize(std::min(most, std::max<std::size_t>(4 * packed.size(), 4096)));
  for (;;) {
    const Step step =
        unpacker->step(packed.substr(result.at), bytes.data() + given, bytes.size() - given);
    result.at += step.taken;
    given += step.given;
    result.fault = step.fault;
    if (!step.fault.empty()) break;
    if (step.ends) {
      result.is_whole = result.at == packed.size();
      if (result.is_whole) break;
      unpacker->begin_next();
    } else if (given == bytes.size()) {
      if (given == most) break;
      bytes.resize(given + std::min(most - given, std::max<std::size_t>(given / 2, 4096)));
    } else if (step.taken == 0 && step.given == 0) {
      break;  // wants more than there is
    }
  }
  bytes.resize(given);
  return result;
}

}  // namespace

bool is_packed(std::string_view bytes) {
  return bytes.starts_with(kGzip) || bytes.starts_with(kZstandard);
}

std::string unpacked(std::string_view bytes, const std::string& name, std::size_t most) {
  Unpacked result = unpack(bytes, most + 1);
  const char* format = bytes.starts_with(kGzip) ? "gzip" : "Zstandard";
  if (result.bytes.size() > most) {
    throw InputError({.file = name,
                      .found = fmt::format("unpacks to more than {} bytes", most),
                      .needed = fmt::format("no more for {} packed ones", bytes.size()),
                      .remedy = "unpack it to a file first, if it is no bomb"});
  }
  if (!result.is_whole) {
    throw InputError({.file = name,
                      .place = fmt::format("byte {}", result.at),
                      .found = result.fault.empty() ? fmt::format("ends within its {} data", format)
                                                    : fmt::format("cannot be unpacked as {}: {}",
                                                                  format, result.fault),
                      .needed = fmt::format("whole {} data and nothing behind", format),
                      .remedy = "copy or pack it anew"});
  }
  return std::move(result.bytes);
}

std::string unpacked_start(std::string_view start, std::size_t size) {
  return unpack(start, size).bytes;
}

}  // namespace roadbed::map::files
