// Boards that carry several signs (ASAM OpenDRIVE 1.8, section 14.8).

#include <fmt/format.h>

#include <array>

#include "roadbed/map/opendrive/rules/furniture.h"

namespace roadbed::map::opendrive::rules {
namespace {

using validation::Severity;

/// A signal, with the boards that it is made of.
struct Board {
  const RoadSource& road;
  pugi::xml_node signal;
  bool has_static, has_variable;

  std::string_view type() const { return signal.attribute("type").value(); }
  bool is_multi() const { return type() == "multiBoard" || (has_static && has_variable); }
};

template <typename Check>
void for_each_board(const Source& source, const Check& check) {
  for_each_thing(source, "signals", "signal", [&](const RoadSource& road, pugi::xml_node signal) {
    check(Board{road, signal, static_cast<bool>(signal.child("staticBoard")),
                static_cast<bool>(signal.child("vmsBoard"))});
  });
}

void incomplete_boards(const Source& source, const validation::ValidateOptions&,
                       validation::Report& report) {
  for_each_board(source, [&](const Board& board) {
    if (!board.is_multi() || (board.has_static && board.has_variable)) return;
    add_thing(
        report, source, board.road, board.signal,
        fmt::format("is a multi board without a <{}>, needs a <staticBoard> and a <vmsBoard>; "
                    "add it or correct the type",
                    board.has_static ? "vmsBoard" : "staticBoard"));
  });
}

void still_boards(const Source& source, const validation::ValidateOptions&,
                  validation::Report& report) {
  for_each_board(source, [&](const Board& board) {
    const std::string_view dynamic = board.signal.attribute("dynamic").value();
    if (!board.is_multi() || dynamic == "yes" || dynamic == "true") return;
    add_thing(report, source, board.road, board.signal,
              fmt::format("is a multi board with dynamic=\"{}\"; a part of it changes, so make it "
                          "\"yes\"",
                          dynamic));
  });
}

void add_type(const Source& source, const Board& board, const char* needed,
              validation::Report& report) {
  add_thing(report, source, board.road, board.signal,
            fmt::format("has type \"{}\" but the boards of a {}; make it type=\"{}\"", board.type(),
                        needed, needed));
}

void mistyped_multi_boards(const Source& source, const validation::ValidateOptions&,
                           validation::Report& report) {
  for_each_board(source, [&](const Board& board) {
    if (!board.has_static || !board.has_variable || board.type() == "multiBoard") return;
    add_type(source, board, "multiBoard", report);
  });
}

void mistyped_static_boards(const Source& source, const validation::ValidateOptions&,
                            validation::Report& report) {
  for_each_board(source, [&](const Board& board) {
    if (!board.has_static || board.is_multi() || board.type() == "staticBoard") return;
    add_type(source, board, "staticBoard", report);
  });
}

constexpr std::array<SourceRule, 4> kSignalBoardRules = {{
    {{"signal.board-parts", "asam.net:xodr:1.8.0:road.signal.boards.multi_board_have_sub_boards",
      Severity::warning, "a multi board has no static board, or no variable message board"},
     incomplete_boards},
    {{"signal.board-dynamic", "asam.net:xodr:1.8.0:road.signal.boards.multi_board_use_dynamic_true",
      Severity::warning, "a multi board is not dynamic"},
     still_boards},
    {{"signal.multi-board-type",
      "asam.net:xodr:1.8.0:road.signal.boards.multi_board_use_correct_type", Severity::warning,
      "a signal with static and variable boards is not of type multiBoard"},
     mistyped_multi_boards},
    {{"signal.static-board-type",
      "asam.net:xodr:1.8.0:road.signal.boards.static_board_use_correct_type", Severity::warning,
      "a signal with a static board is not of type staticBoard"},
     mistyped_static_boards},
}};

}  // namespace

std::span<const SourceRule> signal_board_rules() { return kSignalBoardRules; }

}  // namespace roadbed::map::opendrive::rules
