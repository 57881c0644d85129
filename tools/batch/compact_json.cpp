#include "roadbed/tools/batch/compact_json.h"

namespace roadbed::tools::inline batch {

std::string compact_json(std::string_view json) {
  std::string compact;
  compact.reserve(json.size());
  bool in_text = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char sign = json[i];
    const bool is_blank = sign == ' ' || sign == '\n' || sign == '\t' || sign == '\r';
    if (in_text || !is_blank) compact += sign;
    if (in_text && sign == '\\' && i + 1 < json.size()) {
      compact += json[++i];
    } else if (sign == '"') {
      in_text = !in_text;
    }
  }
  return compact;
}

}  // namespace roadbed::tools
