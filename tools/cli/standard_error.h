#pragma once

#include <mutex>
#include <streambuf>
#include <string>
#include <string_view>

namespace roadbed::tools::inline cli {

/// Standard error in place of std::cerr's own buffer: whatever is said comes out at once as visible
/// text (map/files/visible_text.h), also by several threads. Progress bars go past it.
class StandardError : public std::streambuf {
 public:
  StandardError();
  ~StandardError() override;
  StandardError(const StandardError&) = delete;
  StandardError& operator=(const StandardError&) = delete;

 protected:
  int_type overflow(int_type sign) override;
  std::streamsize xsputn(const char* text, std::streamsize size) override;

 private:
  void write_whole(std::string_view text);

  std::mutex mutex_;
  std::string cut_;  // a character whose end is still to come
  std::streambuf* before_;
};

}  // namespace roadbed::tools::cli
