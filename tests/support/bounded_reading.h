#pragma once

#include <string>

namespace roadbed::tests {

/// Fails unless reading the bytes as a map, in a process of its own, ends in an outcome with that
/// text ("read 2 lanes", or a refusal) and takes at most 256 MB and 8 times the bytes of memory.
/// Under sanitizers, whose memory is their own, the outcome alone counts.
void expect_read_in_bounds(const std::string& bytes, const std::string& outcome);

/// The same for validating them; the outcome is "3 findings", or a refusal.
void expect_validated_in_bounds(const std::string& bytes, const std::string& outcome);

/// A text several times over.
std::string repeated(int times, const std::string& text);

}  // namespace roadbed::tests
