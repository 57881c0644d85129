#include "roadbed/map/files/wkt_units.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <span>
#include <vector>

namespace roadbed::map::inline files {
namespace {

constexpr std::array<std::string_view, 2> kProjected{"PROJCS", "PROJCRS"};
constexpr std::array<std::string_view, 4> kGeographic{"GEOGCS", "GEOGCRS", "GEODCRS",
                                                      "GEOGRAPHICCRS"};
constexpr std::array<std::string_view, 3> kVertical{"VERT_CS", "VERTCRS", "VERTICALCRS"};
constexpr std::array<std::string_view, 2> kUnits{"UNIT", "LENGTHUNIT"};

bool is_any(std::string_view word, std::span<const std::string_view> words) {
  return std::ranges::find(words, word) != words.end();
}

/// The words before the brackets that a place of the text is in, and what it passes of them.
class UnitsReader {
 public:
  explicit UnitsReader(std::string_view text) : text_(text) {}

  CrsUnits read() {
    std::size_t word_begin = 0;
    for (std::size_t at = 0; at < text_.size(); ++at) {
      const char sign = text_[at];
      if (sign == '"') {
        at = std::min(text_.find('"', at + 1), text_.size());
        word_begin = at + 1;
      } else if (sign == '[' || sign == '(') {
        open(text_.substr(word_begin, at - word_begin), text_.substr(at + 1));
        word_begin = at + 1;
      } else if (sign == ']' || sign == ')') {
        if (!open_.empty()) open_.pop_back();
        word_begin = at + 1;
      } else if (!std::isalnum(static_cast<unsigned char>(sign)) && sign != '_') {
        word_begin = at + 1;
      }
    }
    if (units_.horizontal_m) units_.is_in_degrees = false;  // those of a bound system's target
    return units_;
  }

 private:
  void open(std::string_view word, std::string_view inside) {
    if (is_any(word, kUnits)) take(factor_of(inside));
    const bool is_geographic = is_any(word, kGeographic) && !is_in(kProjected);
    units_.is_in_degrees = units_.is_in_degrees || is_geographic;
    open_.push_back(word);
  }

  // Those of parameters, datums and the geographic system below a projected one are inside others.
  void take(std::optional<double> factor) {
    if (open_.empty()) return;
    const bool of_axis = open_.back() == "AXIS" && open_.size() > 1;
    const std::string_view system = of_axis ? open_[open_.size() - 2] : open_.back();
    if (is_any(system, kProjected)) units_.horizontal_m = factor;
    if (is_any(system, kVertical)) units_.vertical_m = factor;
  }

  // Of "metre",1.
  static std::optional<double> factor_of(std::string_view inside) {
    const std::size_t name_end = inside.find('"', 1), comma = inside.find(',', name_end);
    if (name_end == std::string_view::npos || comma == std::string_view::npos) return {};
    double factor = 0.0;
    const char* begin = inside.data() + comma + 1;
    const auto [rest, fault] = std::from_chars(begin, inside.data() + inside.size(), factor);
    if (fault != std::errc() || !(factor > 0.0)) return {};
    return factor;
  }

  bool is_in(std::span<const std::string_view> words) const {
    return std::ranges::any_of(open_, [&](std::string_view word) { return is_any(word, words); });
  }

  std::string_view text_;
  std::vector<std::string_view> open_;
  CrsUnits units_;
};

}  // namespace

CrsUnits units_of_wkt(std::string_view text) { return UnitsReader(text).read(); }

}  // namespace roadbed::map::files
