#include "roadbed/map/files/sha256.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <string_view>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"

namespace roadbed::map {
namespace {

// Of FIPS 180-4's examples, as NIST publishes them.
TEST(Sha256, AgreesWithTheStandardsExamples) {
  EXPECT_EQ(sha256_of_bytes("abc"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of_bytes("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_of_bytes(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, OfAFileIsThatOfItsBytesWhateverItsPieces) {
  const std::string file = testing::TempDir() + "sha256_test.bytes";
  std::string bytes;
  for (unsigned i = 0; i < 700'000; ++i) bytes.push_back(static_cast<char>(i * 7919U >> 3));
  std::ofstream(file, std::ios::binary) << bytes;
  EXPECT_EQ(sha256_of_file(file), sha256_of_bytes(bytes));
  Sha256 in_parts;
  in_parts.add(std::string_view(bytes).substr(0, 64'001));
  in_parts.add(std::string_view(bytes).substr(64'001));
  EXPECT_EQ(in_parts.take_hex(), sha256_of_bytes(bytes));
}

TEST(Sha256, RefusesAFileThatIsMissing) {
  EXPECT_THROW(sha256_of_file("no_such_file"), InputError);
}

}  // namespace
}  // namespace roadbed::map
