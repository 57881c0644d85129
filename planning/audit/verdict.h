#pragma once

#include <string_view>

namespace roadbed::planning::inline audit {

enum class Verdict { clear, conflict, unknown, undecided };
std::string_view to_string(Verdict verdict);

/// The verdict that stretches of a report, or of a certificate, lead to: a conflict counts before
/// what is unknown, and that before what the proof cannot tell.
template <typename Found>
Verdict verdict_of(const Found& found) {
  if (!found.conflicts.empty()) return Verdict::conflict;
  if (!found.unknown.empty()) return Verdict::unknown;
  return found.undecided.empty() ? Verdict::clear : Verdict::undecided;
}

}  // namespace roadbed::planning::audit
