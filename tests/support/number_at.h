#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <string>

namespace roadbed::tests {

/// The number that lies at a place of some bytes, little-endian, as the machines that run this.
template <class Number>
Number number_at(const std::string& bytes, std::size_t place) {
  Number number{};
  EXPECT_EQ(bytes.copy(reinterpret_cast<char*>(&number), sizeof number, place), sizeof number);
  return number;
}

}  // namespace roadbed::tests
