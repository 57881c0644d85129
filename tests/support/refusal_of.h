#pragma once

#include <string>

#include "roadbed/map/files/input_error.h"

namespace roadbed::tests {

/// Why a call refuses its input: what its InputError says; "accepted" if it throws none.
template <class Call>
std::string refusal_of(const Call& call) {
  try {
    call();
  } catch (const map::InputError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace roadbed::tests
