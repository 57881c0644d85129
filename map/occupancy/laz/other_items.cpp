#include "roadbed/map/occupancy/laz/integer_decoder.h"
#include "roadbed/map/occupancy/laz/packed_item.h"

namespace roadbed::map::inline occupancy::inline laz {
namespace {

class Rgb : public PackedItem {
 public:
  void next(ArithmeticDecoder& from, LazPoint&) override {
    const std::uint32_t changed = from.symbol(changed_);
    for (const std::uint32_t red : {0u, 1u}) {
      if ((changed & 1u << red) != 0) from.symbol(bytes_[red]);
    }
    if ((changed & 64) == 0) return;  // green and blue are red
    for (const std::uint32_t byte : {2u, 4u, 3u, 5u}) {
      if ((changed & 1u << byte) != 0) from.symbol(bytes_[byte]);
    }
  }

 private:
  SymbolModel changed_{128};
  std::vector<SymbolModel> bytes_ = std::vector<SymbolModel>(6, SymbolModel(256));
};

class RgbVersion1 : public PackedItem {
 public:
  void next(ArithmeticDecoder& from, LazPoint&) override {
    const std::uint32_t changed = from.symbol(changed_);
    for (std::uint32_t byte = 0; byte < 6; ++byte) {
      if ((changed & 1u << byte) != 0) bytes_.decode(from, 0, byte);
    }
  }

 private:
  SymbolModel changed_{64};
  IntegerDecoder bytes_{8, 6};
};

class WavePacket : public PackedItem {
 public:
  void next(ArithmeticDecoder& from, LazPoint&) override {
    from.symbol(descriptor_);
    offset_kind_ = from.symbol(offset_kinds_[offset_kind_]);
    if (offset_kind_ == 2) offset_.decode(from, 0);
    if (offset_kind_ == 3) from.raw_64();
    size_.decode(from, 0);
    return_point_.decode(from, 0);
    for (std::uint32_t axis = 0; axis < 3; ++axis) direction_.decode(from, 0, axis);
  }

 private:
  SymbolModel descriptor_{256};
  std::vector<SymbolModel> offset_kinds_ = std::vector<SymbolModel>(4, SymbolModel(4));
  std::uint32_t offset_kind_ = 0;
  IntegerDecoder offset_{32}, size_{32}, return_point_{32}, direction_{32, 3};
};

class ExtraBytes : public PackedItem {
 public:
  explicit ExtraBytes(std::size_t count) : bytes_(count, SymbolModel(256)) {}

  void next(ArithmeticDecoder& from, LazPoint&) override {
    for (SymbolModel& byte : bytes_) from.symbol(byte);
  }

 private:
  std::vector<SymbolModel> bytes_;
};

class ExtraBytesVersion1 : public PackedItem {
 public:
  explicit ExtraBytesVersion1(std::size_t count)
      : count_(static_cast<std::uint32_t>(count)), bytes_(8, count_) {}

  void next(ArithmeticDecoder& from, LazPoint&) override {
    for (std::uint32_t byte = 0; byte < count_; ++byte) bytes_.decode(from, 0, byte);
  }

 private:
  std::uint32_t count_;
  IntegerDecoder bytes_;
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
