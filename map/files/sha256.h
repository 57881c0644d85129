#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace roadbed::map::inline files {

/// SHA-256 [FIPS 180-4], for what trust rests on: that bytes are those that a proof or a result is
/// about, also where somebody would profit if they were others. (XXH3, which tells accidents, is
/// six times as fast.)
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void add(std::string_view bytes);

  /// The 64 hexadecimal digits of all that was added so far; begins anew after that.
  std::string take_hex();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

std::string sha256_of_bytes(std::string_view bytes);

}  // namespace roadbed::map::files
