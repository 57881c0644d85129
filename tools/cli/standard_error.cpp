#include "roadbed/tools/cli/standard_error.h"

#include <cstdio>
#include <iostream>

#include "roadbed/map/files/visible_text.h"

namespace roadbed::tools::inline cli {

StandardError::StandardError() : before_(std::cerr.rdbuf(this)) {}

StandardError::~StandardError() {
  std::cerr.rdbuf(before_);
  write_whole(cut_);
}

StandardError::int_type StandardError::overflow(int_type sign) {
  if (traits_type::eq_int_type(sign, traits_type::eof())) return traits_type::not_eof(sign);
  const char letter = traits_type::to_char_type(sign);
  return xsputn(&letter, 1) == 1 ? sign : traits_type::eof();
}

std::streamsize StandardError::xsputn(const char* text, std::streamsize size) {
  const std::scoped_lock lock(mutex_);
  cut_.append(text, static_cast<std::size_t>(size));
  const std::size_t whole = map::size_of_whole_characters(cut_);
  write_whole(std::string_view(cut_).substr(0, whole));
  cut_.erase(0, whole);
  return size;
}

// What cannot be said is nothing that could be told anyone.
void StandardError::write_whole(std::string_view text) {
  const std::string shown = map::visible_text(text);
  static_cast<void>(std::fwrite(shown.data(), 1, shown.size(), stderr));
}

}  // namespace roadbed::tools::cli
