#include "roadbed/tools/support/route_question.h"

#include <map>

namespace roadbed::tools {

void RouteQuestion::declare(CLI::App& app) {
  const std::map<std::string, planning::RouteCost> costs{
      {"time", planning::RouteCost::time}, {"distance", planning::RouteCost::distance}};
  const std::string syntax = kPlaceSyntax;
  app.add_option("--from", from_, "Start: " + syntax)->required()->check(place_syntax_fault);
  app.add_option("--to", to_, "Goal, in the same way")->required()->check(place_syntax_fault);
  app.add_option("--avoid", avoid_, "A closed lane, lane:NAME; may be given again")
      ->check([](const std::string& text) {
        return text.starts_with("lane:") ? place_syntax_fault(text) : "is not lane:NAME";
      });
  app.add_option("--cost", cost_, "What is to be least: time or distance")
      ->transform(CLI::CheckedTransformer(costs, CLI::ignore_case))
      ->default_str("time");
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
