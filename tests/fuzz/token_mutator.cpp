// Changes of XML and JSON that leave them well-formed more often than changed bytes do: numbers and
// words become others, elements and members are left out, put twice or put elsewhere. Every other
// change is libFuzzer's own.
#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <string_view>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

struct Span {
  std::size_t begin = 0, size = 0;
};

class Changes {
 public:
  Changes(std::string& text, unsigned int seed) : text_(text), random_(seed) {}

  /// @returns whether there was something to change.
  bool make() {
    switch (below(6)) {
      case 0:
        return replace(any_token(), token_text());
      case 1:
        return replace(any_token(), number());
      case 2:
        return replace(any_number(), number());
      case 3:
        return replace(any_block(), "");
      case 4:
        return replace(any_block(), block_text());
      default:
        return insert(any_block(), block_text());
    }
  }

 private:
  std::size_t below(std::size_t count) { return count == 0 ? 0 : random_() % count; }

  static bool is_word(char sign) {
    return std::isalnum(static_cast<unsigned char>(sign)) != 0 || std::strchr("_.+-:", sign);
  }

  /// The word around a random place, or the next one behind it.
  Span any_token() {
    std::size_t at = below(text_.size());
    while (at < text_.size() && !is_word(text_[at])) ++at;
    std::size_t begin = at, end = at;
    while (begin > 0 && is_word(text_[begin - 1])) --begin;
    while (end < text_.size() && is_word(text_[end])) ++end;
    return {begin, end - begin};
  }

  Span any_number() {
    for (int tries = 0; tries < 8; ++tries) {
      const Span token = any_token();
      const std::string_view text = std::string_view(text_).substr(token.begin, token.size);
      if (text.find_first_of("0123456789") < 2) return token;
    }
    return {};
  }

  /// An element with its end, or what brackets hold with its key and comma.
  Span any_block() {
    const std::size_t at = below(text_.size());
    return text_.starts_with('<') ? element(text_.find('<', at)) : member(at);
  }

  Span element(std::size_t begin) const {
    if (begin == std::string::npos || begin + 1 >= text_.size()) return {};
    if (!std::isalpha(static_cast<unsigned char>(text_[begin + 1]))) return {};
    int depth = 0;
    for (std::size_t at = begin; at < text_.size();) {
      const std::size_t end = text_.find('>', at);
      if (end == std::string::npos) return {};
      const bool closes = text_[at + 1] == '/', is_empty = text_[end - 1] == '/';
      const bool is_tag = closes || std::isalpha(static_cast<unsigned char>(text_[at + 1]));
      if (is_tag && !is_empty) depth += closes ? -1 : 1;
      if (depth <= 0) return {begin, end + 1 - begin};
      at = text_.find('<', end);
    }
    return {};
  }

  Span member(std::size_t at) const {
    std::size_t begin = text_.find_first_of("{[,", at);
    if (begin == std::string::npos) return {};
    if (text_[begin] != ',') ++begin;
    int depth = 0;
    for (std::size_t end = begin + 1; end < text_.size(); ++end) {
      const char sign = text_[end];
      if (depth == 0 && std::strchr(",}]", sign)) return {begin, end - begin};
      depth += sign == '{' || sign == '[' ? 1 : sign == '}' || sign == ']' ? -1 : 0;
    }
    return {};
  }

  std::string text_of(Span span) const { return text_.substr(span.begin, span.size); }
  std::string token_text() { return text_of(any_token()); }
  std::string block_text() { return text_of(any_block()); }

  std::string number() {
    static const std::vector<std::string> numbers{
        "0",   "1",    "-1",  "2",     "0.5",    "-0.5", "10",         "100",
        "1e9", "-1e9", "nan", "1e300", "1e-300", "-inf", "4294967296", "3.14",
        "0.1", "1e-9", "90",  "5",     "true",   "false"};
    return numbers[below(numbers.size())];
  }

  bool replace(Span span, const std::string& by) {
    if (span.size == 0) return false;
    text_.replace(span.begin, span.size, by);
    return true;
  }

  bool insert(Span before, const std::string& what) {
    if (before.size == 0) return false;
    text_.insert(before.begin, what);
    return true;
  }

  std::string& text_;
  std::minstd_rand random_;
};

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned int seed) {
  std::string text(reinterpret_cast<const char*>(data), size);
  if (seed % 2 == 0 || !Changes(text, seed).make() || text.size() > most) {
    return LLVMFuzzerMutate(data, size, most);
  }
  std::copy(text.begin(), text.end(), data);
  return text.size();
}
