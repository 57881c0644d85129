"""What is said of others' texts."""

from roadbed_cluster.visible import visible


def test_nothing_that_a_terminal_acts_on_is_said_as_it_is() -> None:
    hostile = "a\x1b[31m\x07\r\nFORGED\x85\x9b1m\u202e\u2066\u200f\u2028\x7f"
    said = visible(hostile)
    assert said.isprintable()
    assert said == (
        "a\\u001b[31m\\u0007 FORGED \\u009b1m\\u202e\\u2066\\u200f \\u007f".removesuffix(" ")
    )


def test_words_of_every_language_are_said_as_they_are() -> None:
    assert visible("Straße 道路 طريق 12 km/h") == "Straße 道路 طريق 12 km/h"
