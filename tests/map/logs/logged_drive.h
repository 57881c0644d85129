#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "roadbed/map/logs/log.h"
#include "roadbed/map/logs/log_drive.h"
#include "roadbed/tests/support/made_log.h"
#include "roadbed/tests/support/refusal_of.h"

// The drive in a log, given as its bytes or as what was recorded.
namespace roadbed::map {

inline constexpr std::int64_t kStart_ns = 1'700'000'000'123'456'789;

inline LogDrive drive_in(const std::string& bytes, const std::string& topic = {}) {
  return drive_of_log([&](const LogVisitor& visitor) { parse_log(bytes, "a log", visitor); },
                      "a log", topic);
}

inline LogDrive drive_in(const std::vector<tests::Recorded>& log, const std::string& topic = {}) {
  return drive_of_log(tests::through(log, kStart_ns), "a log", topic);
}

// Why there is none; "accepted" if there is one.
template <class Log>
std::string fault_of(const Log& log, const std::string& topic = {}) {
  return tests::refusal_of([&] { drive_in(log, topic); });
}

}  // namespace roadbed::map
