#pragma once

#include <string_view>

namespace roadbed::tools::inline report {

/// A script for pages with long tables: a `<table class="sortable">` is sorted by a click on a
/// head, and its rows are chosen by the texts of the columns whose head has `data-choose`. A cell
/// is sorted by its `data-value`, if it has one. It stands in a `<script>` at the end of the page.
extern const std::string_view kTableScript;

/// How the boxes and heads that the script makes look.
extern const std::string_view kTableCss;

}  // namespace roadbed::tools::report
