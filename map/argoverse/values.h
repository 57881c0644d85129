#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace roadbed::map::argoverse {

using Line3 = std::vector<Eigen::Vector3d>;

/// An entry of one of the file's lists, for what it says and for messages.
struct Entry {
  const std::string& file;
  std::string element;  ///< "lane segment 38109167"
  const nlohmann::json& json;

  /// @throws InputError always.
  [[noreturn]] void refuse(const std::string& found, const std::string& needed) const;

  const nlohmann::json* find(const char* key) const;  ///< null if it is not there, or null

  /// A whole number. @throws InputError if there is none.
  std::int64_t id(const char* key) const;
  std::optional<std::int64_t> optional_id(const char* key) const;  ///< the same; none if null
  std::vector<std::int64_t> ids(const char* key) const;            ///< of a list; empty if null

  std::string word(const char* key) const;  ///< a text, on one line; empty if there is none
  bool truth(const char* key) const;        ///< false if there is none

  /// Points with x, y and z; z is NaN where there is none.
  /// @throws InputError if there is no list of them, or a number is none or beyond any road.
  Line3 line(const char* key) const;
};

}  // namespace roadbed::map::argoverse
