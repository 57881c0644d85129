#include <vector>

#include "roadbed/map/occupancy/laz/integer_decoder.h"
#include "roadbed/map/occupancy/laz/packed_item.h"

namespace roadbed::map::inline occupancy::inline laz {
namespace {

class Rgb final : public SteppedItem<Rgb> {
 public:
  ROADBED_INLINE void changes(ArithmeticDecoder& from) {
    changed_ = from.symbol(changes_);
    if ((changed_ & 64) == 0) changed_ &= 3u;  // green and blue are red
  }
  template <std::uint32_t kByte>
  ROADBED_INLINE void byte(ArithmeticDecoder& from) {
    if ((changed_ & 1u << kByte) != 0) from.symbol(bytes_[kByte]);
  }
  using Point = Steps<&Rgb::changes, &Rgb::byte<0>, &Rgb::byte<1>, &Rgb::byte<2>, &Rgb::byte<4>,
                      &Rgb::byte<3>, &Rgb::byte<5>>;

 private:
  std::uint32_t changed_ = 0;
  SymbolModel<128> changes_;
  std::array<SymbolModel<256>, 6> bytes_;
};

class RgbVersion1 final : public SteppedItem<RgbVersion1> {
 public:
  void all(ArithmeticDecoder& from) {
    const std::uint32_t changed = from.symbol(changed_);
    for (std::uint32_t byte = 0; byte < 6; ++byte) {
      if ((changed & 1u << byte) != 0) bytes_.decode(from, 0, byte);
    }
  }
  using Point = Steps<&RgbVersion1::all>;

 private:
  SymbolModel<64> changed_;
  IntegerDecoder<8> bytes_{6};
};

class WavePacket final : public SteppedItem<WavePacket> {
 public:
  void all(ArithmeticDecoder& from) {
    from.symbol(descriptor_);
    offset_kind_ = from.symbol(offset_kinds_[offset_kind_]);
    if (offset_kind_ == 2) offset_.decode(from, 0);
    if (offset_kind_ == 3) from.raw_64();
    size_.decode(from, 0);
    return_point_.decode(from, 0);
    for (std::uint32_t axis = 0; axis < 3; ++axis) direction_.decode(from, 0, axis);
  }
  using Point = Steps<&WavePacket::all>;

 private:
  SymbolModel<256> descriptor_;
  std::array<SymbolModel<4>, 4> offset_kinds_;
  std::uint32_t offset_kind_ = 0;
  IntegerDecoder<32> offset_, size_, return_point_, direction_{3};
};

class ExtraBytes final : public SteppedItem<ExtraBytes> {
 public:
  explicit ExtraBytes(std::size_t count) : bytes_(count) {}

  void all(ArithmeticDecoder& from) {
    for (SymbolModel<256>& byte : bytes_) from.symbol(byte);
  }
  using Point = Steps<&ExtraBytes::all>;

 private:
  std::vector<SymbolModel<256>> bytes_;
};

class ExtraBytesVersion1 final : public SteppedItem<ExtraBytesVersion1> {
 public:
  explicit ExtraBytesVersion1(std::size_t count)
      : count_(static_cast<std::uint32_t>(count)), bytes_(count_) {}

  void all(ArithmeticDecoder& from) {
    for (std::uint32_t byte = 0; byte < count_; ++byte) bytes_.decode(from, 0, byte);
  }
  using Point = Steps<&ExtraBytesVersion1::all>;

 private:
  std::uint32_t count_;
  IntegerDecoder<8> bytes_;
};

}  // namespace

std::unique_ptr<PackedItem> make_rgb(unsigned version) {
  if (version == 1) return std::make_unique<RgbVersion1>();
  return std::make_unique<Rgb>();
}

std::unique_ptr<PackedItem> make_wave_packet() { return std::make_unique<WavePacket>(); }

std::unique_ptr<PackedItem> make_extra_bytes(std::size_t count, unsigned version) {
  if (version == 1) return std::make_unique<ExtraBytesVersion1>(count);
  return std::make_unique<ExtraBytes>(count);
}

}  // namespace roadbed::map::occupancy::laz
