#pragma once

#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

namespace roadbed::tools::inline cli {

/// Standard output in place of std::cout's own buffer, which forgets why it could not be written.
/// What fails once takes nothing more. On a terminal everything appears at once. Whatever is
/// printed comes out as visible text (map/files/visible_text.h).
class StandardOutput : public std::streambuf {
 public:
  StandardOutput();
  ~StandardOutput() override;
  StandardOutput(const StandardOutput&) = delete;
  StandardOutput& operator=(const StandardOutput&) = delete;

  /// Writes what is left. Returns whether all that was printed has been taken.
  bool finish();

  /// Why not, and what to do.
  std::string fault() const;

 protected:
  int_type overflow(int_type sign) override;
  std::streamsize xsputn(const char* text, std::streamsize size) override;
  int sync() override;

 private:
  bool write_pending(bool with_cut_character = false);
  void write(std::string_view text);

  std::vector<char> buffer_;
  std::string shown_;
  bool is_terminal_;
  std::streambuf* before_;
  int error_ = 0;  // errno of the first write that failed
};

/// Takes the places of closed standard streams, so that no file that is opened later gets one of
/// them and is printed into. Using them is an error as before.
void hold_closed_streams();

}  // namespace roadbed::tools::cli
