#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/map/query/lane_fields.h"

namespace roadbed::map::inline query {

/// A question that cannot be asked; what() says where it goes wrong, in one line.
class QuestionFault : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A question about lanes: `type = driving and speed > 50`.
///
///     question   = all { "or" all }
///     all        = part { "and" part }
///     part       = "not" part | "(" question ")" | comparison
///     comparison = field ( "=" | "!=" | "<" | "<=" | ">" | ">=" | "~" ) value
///                | field "in" "(" value { "," value } ")"
///     field      = a name of lane_fields() | "tag." key
///     value      = word | number | text in quotes, ' or "
///
/// `~` asks whether a text is a part. Of a list any text may fit. What a lane does not say fits
/// nothing but `= none`, and `!=` fits whatever is said and differs. Words of the grammar and
/// fields are in small letters.
class LaneQuestion {
 public:
  /// @throws QuestionFault if it is none.
  explicit LaneQuestion(std::string_view question);
  ~LaneQuestion();
  LaneQuestion(LaneQuestion&&) noexcept;
  LaneQuestion& operator=(LaneQuestion&&) noexcept;

  bool fits(const AskedLane& lane) const;

  struct Part;  ///< of the parsed question

 private:
  std::unique_ptr<const Part> part_;
};

/// What is wrong with a question, in one line; empty if nothing is.
std::string question_fault(const std::string& question);

/// The lanes that fit, in order.
std::vector<LaneId> lanes_that_fit(const RoadMap& road_map, const LaneQuestion& question);

}  // namespace roadbed::map::query
