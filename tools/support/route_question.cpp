#include "roadbed/tools/support/route_question.h"

namespace roadbed::tools {

void RouteQuestion::declare(Arguments& arguments) {
  const std::string syntax = kPlaceSyntax;
  arguments.add("--from", from_, "Start: " + syntax).required().checked(place_syntax_fault);
  arguments.add("--to", to_, "Goal, in the same way").required().checked(place_syntax_fault);
  arguments.add("--avoid", avoid_, "A closed lane, lane:NAME; may be given again")
      .checked([](const std::string& text) {
        return text.starts_with("lane:") ? place_syntax_fault(text) : "is not lane:NAME";
      });
  arguments.choice(
      "--cost", cost_,
      {{"time", planning::RouteCost::time}, {"distance", planning::RouteCost::distance}},
      "What is to be least");
}

RouteQuestion::Asked RouteQuestion::on(const map::RoadMap& road_map) const {
  Asked asked{find_place(road_map, from_), find_place(road_map, to_), {}};
  asked.options.cost = cost_;
  for (const std::string& text : avoid_) {
    asked.options.avoid.push_back(find_place(road_map, text).on_lane.lane);
  }
  return asked;
}

}  // namespace roadbed::tools
