#pragma once

#include <memory>
#include <stdexcept>
#include <string>

namespace roadbed::map::inline files {

/// An input that cannot be used. Its message is one line for the user:
/// `town.xodr:4182: lane 17: left border has 1 point, needs at least 2; remove the lane`.
class InputError : public std::runtime_error {
 public:
  /// What the message is made of; empty parts are left out.
  struct Parts {
    std::string file = {};     ///< as the user named it
    std::string place = {};    ///< line number, "byte 1234", or empty
    std::string element = {};  ///< "road 12, lane -1"
    std::string found = {};    ///< what is there
    std::string needed = {};   ///< what has to be there
    std::string remedy = {};   ///< what the user can do
  };
  explicit InputError(const Parts& parts);  ///< Makes the message of its parts.

  const Parts& parts() const { return *parts_; }

 private:
  std::shared_ptr<const Parts> parts_;  // shared: copying an exception must not throw
};

}  // namespace roadbed::map::files
