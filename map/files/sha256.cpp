#include "roadbed/map/files/sha256.h"

#include <fmt/format.h>
#include <nettle/sha2.h>

#include <array>
#include <cstdint>
#include <fstream>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"

namespace roadbed::map::inline files {

struct Sha256::State {
  sha256_ctx context;
};

Sha256::Sha256() : state_(std::make_unique<State>()) { sha256_init(&state_->context); }

Sha256::~Sha256() = default;

void Sha256::add(std::string_view bytes) {
  sha256_update(&state_->context, bytes.size(),
                reinterpret_cast<const std::uint8_t*>(bytes.data()));
}

std::string Sha256::take_hex() {
  std::array<std::uint8_t, SHA256_DIGEST_SIZE> digest;
  sha256_digest(&state_->context, digest.size(), digest.data());
  return fmt::format("{:02x}", fmt::join(digest, ""));
}

std::string sha256_of_bytes(std::string_view bytes) {
  Sha256 hash;
  hash.add(bytes);
  return hash.take_hex();
}

// A map may be larger than memory.
std::string sha256_of_file(const std::filesystem::path& file) {
  constexpr std::size_t kPiece = std::size_t{1} << 18;
  std::string piece = read_file_start(file, kPiece);  // refuses what is no file of bytes
  std::ifstream stream(file, std::ios::binary);
  Sha256 hash;
  while (stream) {
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    hash.add(std::string_view(piece).substr(0, static_cast<std::size_t>(stream.gcount())));
  }
  if (!stream.eof()) {
    throw InputError({.file = file.string(),
                      .found = "cannot be read to its end",
                      .remedy = "check the disk, or copy the file to another one"});
  }
  return hash.take_hex();
}

}  // namespace roadbed::map::files
