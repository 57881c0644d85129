#pragma once

#include <span>
#include <string_view>

namespace roadbed::map::opendrive::rules {

/// A type of elements in revisions 1.4 to 1.8: what its attributes and child elements have to be,
/// in words with blanks between them:
///
///     id:text!! length>=0!!@-5 length>0!!@7- rule:trafficRule*
///
/// After the name may stand, in this order:
///
///     :type       a type of values; of a child, its type of elements; else a number, or the
///                 child's own name
///     >=0 >0      a number with that bound, which holds from 1.5 on
///     *           read by the program: one of the values, in files of every revision
///     !!          needed by the program: required in files of every revision
///     !           required from 1.5 on
///     !5-7        required in these revisions
///     @5 @-5 @7-  the word is for these revisions only
///
/// Types of values are `text`, `filled` (not empty), `number`, `share` (0 to 1), `whole`, `natural`
/// (≥ 0), `positive`, `negative`, `zero`, and the choices. An attribute that may be any text is
/// listed only if it is required.
struct ElementText {
  std::string_view type, attributes, children;
};

/// A choice of values, with `|` between them: each with the revisions that have it (`curb@6-`; `@0`
/// for none, where files have it all the same). `(>=0)` is any such number; `^` stands for a
/// capital letter, `#` for a digit.
struct ChoiceText {
  std::string_view type, values;
};

/// The first is the type of the root.
std::span<const ElementText> element_texts();
std::span<const ChoiceText> choice_texts();

}  // namespace roadbed::map::opendrive::rules
