#include "roadbed/map/page/column.h"

namespace roadbed::map::inline page {

void Column::add(std::int64_t number) {
  auto rest = (static_cast<std::uint64_t>(number) << 1U) ^
              (number < 0 ? ~std::uint64_t{0} : std::uint64_t{0});
  while (rest > 127) {
    bytes_ += static_cast<char>(static_cast<unsigned char>((rest & 127U) | 128U));
    rest >>= 7U;
  }
  bytes_ += static_cast<char>(static_cast<unsigned char>(rest));
}

void Column::add_step(std::int64_t number) {
  add(number - last_);
  last_ = number;
}

std::string Column::text() const { return base64(bytes_); }

std::string base64(std::string_view bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) {
      return i + k < bytes.size() ? unsigned{static_cast<unsigned char>(bytes[i + k])} : 0U;
    };
    const unsigned group = byte(0) << 16U | byte(1) << 8U | byte(2);
    text += kDigits[group >> 18U];
    text += kDigits[group >> 12U & 63U];
    text += i + 1 < bytes.size() ? kDigits[group >> 6U & 63U] : '=';
    text += i + 2 < bytes.size() ? kDigits[group & 63U] : '=';
  }
  return text;
}

}  // namespace roadbed::map::page
