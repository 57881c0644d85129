#include "roadbed/map/occupancy/clouds/lzf.h"

namespace roadbed::map::inline occupancy::inline clouds {
namespace {

constexpr std::size_t kMostPerByte = 88;  // a reference of 3 bytes copies 264

class Decoder {
 public:
  Decoder(std::string_view in, std::size_t size) : in_(in), size_(size) { out_.reserve(size); }

  std::optional<std::string> run() {
    while (!in_.empty()) {
      const unsigned control = take();
      if (!(control < 32 ? copy_literals(control + 1) : copy_reference(control))) {
        return std::nullopt;
      }
    }
    if (out_.size() != size_) return std::nullopt;
    return std::move(out_);
  }

 private:
  unsigned take() {
    const auto byte = static_cast<unsigned char>(in_.front());
    in_.remove_prefix(1);
    return byte;
  }

  bool copy_literals(std::size_t count) {
    if (count > in_.size() || count > size_ - out_.size()) return false;
    out_.append(in_.substr(0, count));
    in_.remove_prefix(count);
    return true;
  }

  bool copy_reference(unsigned control) {
    std::size_t length = control >> 5;
    if (in_.size() < (length == 7 ? 2u : 1u)) return false;
    if (length == 7) length += take();
    length += 2;
    const std::size_t back = ((control & 0x1fu) << 8 | take()) + 1u;
    if (back > out_.size() || length > size_ - out_.size()) return false;
    // Source and target may overlap: byte by byte, so that a run repeats itself.
    for (std::size_t from = out_.size() - back; length > 0; --length) out_ += out_[from++];
    return true;
  }

  std::string_view in_;
  std::size_t size_;
  std::string out_;
};

}  // namespace

std::optional<std::string> decompress_lzf(std::string_view compressed, std::size_t size) {
  if (size / kMostPerByte > compressed.size()) return std::nullopt;
  return Decoder(compressed, size).run();
}

}  // namespace roadbed::map::occupancy::clouds
