#include "roadbed/map/logs/feather.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/tests/support/number_at.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

using tests::number_at;

void put(std::string& bytes, std::size_t place, std::uint32_t number) {
  std::memcpy(bytes.data() + place, &number, sizeof number);
}

/// A file whose footer names its first batch of rows many times.
std::string with_repeated_batch(const std::string& bytes, std::uint32_t times) {
  constexpr std::size_t tail = 10, block = 24, batches = 3;
  const std::size_t end = bytes.size() - tail;
  const std::size_t begin = end - number_at<std::uint32_t>(bytes, end);
  std::string footer = bytes.substr(begin, end - begin);
  const std::size_t table = number_at<std::uint32_t>(footer, 0);
  const std::size_t fields =
      table - static_cast<std::size_t>(number_at<std::int32_t>(footer, table));
  const std::size_t place = table + number_at<std::uint16_t>(footer, fields + 4 + 2 * batches);
  const std::string first =
      footer.substr(place + number_at<std::uint32_t>(footer, place) + 4, block);
  put(footer, place, static_cast<std::uint32_t>(footer.size() - place));
  footer += std::string(4, '\0');
  put(footer, footer.size() - 4, times);
  for (std::uint32_t i = 0; i < times; ++i) footer += first;
  std::string made = bytes.substr(0, begin) + footer + bytes.substr(end);
  put(made, begin + footer.size(), static_cast<std::uint32_t>(footer.size()));
  return made;
}

std::size_t rows_of(const std::string& bytes) {
  return parse_feather(bytes, "f", {"timestamp_ns", "tx_m", "ty_m", "tz_m"})[0].wholes.size();
}

TEST(Feather, RefusesBatchesThatTogetherHaveMoreRowsThanItsBytesAreWorth) {
  const std::string bytes = read_file(tests::data_folder() / "argoverse_log/annotations.feather");
  EXPECT_EQ(rows_of(with_repeated_batch(bytes, 3)), 3 * rows_of(bytes));
  try {
    rows_of(with_repeated_batch(bytes, 400'000));
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("with those before too many"));
  }
}

}  // namespace
}  // namespace roadbed::map
