"""Texts of others, made visible before they are said."""


def visible(text: str) -> str:
    r"""Return `text` on one line, with what a terminal would act on written as `\u001b`."""
    line = " ".join(text.split())
    return "".join(sign if sign.isprintable() else f"\\u{ord(sign):04x}" for sign in line)
