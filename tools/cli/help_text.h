#pragma once

#include <memory>

namespace CLI {
class FormatterBase;
}  // namespace CLI

namespace roadbed::tools::inline cli {

/// How helps look: lines of at most 100 columns, values named by what they are, limits and default
/// in words behind the explanation.
std::shared_ptr<CLI::FormatterBase> make_help_formatter();

}  // namespace roadbed::tools::cli
