#include "roadbed/tools/batch/counted.h"

namespace roadbed::tools::inline batch {

std::string with_commas(std::size_t number) {
  std::string text = std::to_string(number);
  constexpr std::size_t group = 3;
  for (std::size_t place = text.size(); place > group;) {
    place -= group;
    text.insert(place, 1, ',');
  }
  return text;
}

}  // namespace roadbed::tools
