"""Names of files as disks take them: blanks, marks, controls, formulas, no text."""

import os
from dataclasses import dataclass
from typing import Final

NOT_TEXT: Final = "file name is not UTF-8"


@dataclass(frozen=True)
class HostileName:
    """A photograph's name, and why it is rejected; no reason if it is shown."""

    called: str  # in messages of the tests
    name: str | bytes
    reason: str = ""

    @property
    def file(self) -> bytes:
        """Write the name as the disk has it."""
        return os.fsencode(self.name)


CASES: Final = (
    HostileName("blank at the start", " x.jpg"),
    HostileName("blank before the suffix", "x .jpg"),
    HostileName("blanks around a folder", " folder /x.jpg"),
    HostileName("only a blank", " .jpg"),
    HostileName("tab at the start", "\tx.jpg"),
    HostileName("tab within", "x\ty.jpg"),
    HostileName("line break at the start", "\nx.jpg"),
    HostileName("line break within", "x\ny.jpg"),
    HostileName("carriage return", "x\ry.jpg"),
    HostileName("both line breaks", "x\r\ny.jpg"),
    HostileName("form feed at the start", "\fx.jpg"),
    HostileName("no-break space at the start", "\u00a0x.jpg"),
    HostileName("ideographic space at the start", "\u3000x.jpg"),
    HostileName("zero-width space", "\u200bx.jpg"),
    HostileName("byte order mark", "\ufeffx.jpg"),
    HostileName("line separator", "x\u2028y.jpg"),
    HostileName("right-to-left override", "\u202egpj.x.jpg"),
    HostileName("Hebrew", "\u05e8\u05d7\u05d5\u05d1.jpg"),
    HostileName("emoji", "\U0001f3db\ufe0f.jpg"),
    HostileName("composed accent", "caf\u00e9.jpg"),
    HostileName("parted accent", "cafe\u0301.jpg"),
    HostileName("small letters", "case.jpg"),
    HostileName("capital letters", "CASE.JPG"),
    HostileName("two suffixes", "case.png.jpg"),
    HostileName("255 bytes", "n" * 251 + ".jpg"),
    HostileName("255 bytes of accents", "\u00e9" * 125 + "x.jpg"),
    HostileName("double quote", 'x"y.jpg'),
    HostileName("double quote at the start", '"x.jpg'),
    HostileName("apostrophe", "'x'.jpg"),
    HostileName("comma", "x,y.jpg"),
    HostileName("semicolon", "x;y.jpg"),
    HostileName("percent and zeros", "%00x.jpg"),
    HostileName("percent and dots", "%2e%2e%2fx.jpg"),
    HostileName("question mark", "x.jpg?y.jpg"),
    HostileName("number sign", "x#y.jpg"),
    HostileName("option", "-o.jpg"),
    HostileName("long option", "--models=x.jpg"),
    HostileName("tilde", "~root.jpg"),
    HostileName("variable", "$HOME.jpg"),
    HostileName("command", "$(touch x).jpg"),
    HostileName("pipe", "|touch x.jpg"),
    HostileName("formula", "=cmd|x.jpg"),
    HostileName("formula with plus", "+1+1.jpg"),
    HostileName("formula with at", "@SUM(1).jpg"),
    HostileName("apostrophe before a formula", "'=1.jpg"),
    HostileName("script", "<script>alert(1)<.jpg"),
    HostileName("markup of the console", "[red]x[/].jpg"),
    HostileName("escape of the terminal", "\x1b[2Jx.jpg"),
    HostileName("bell", "\ax.jpg"),
    HostileName("delete", "x\x7f.jpg"),
    HostileName("wildcards", "*?[a-z].jpg"),
    HostileName("three dots", "...jpg"),
    HostileName("braces", "{0}{name}%s.jpg"),
    HostileName("device of another system", "CON.jpg"),
    HostileName("null", "null.jpg"),
    HostileName("not a number", "nan.jpg"),
    HostileName("block and lot of many digits", "99999999999_99999999999.jpg"),
    HostileName("digits of another script", "\u0665_\u0661.jpg"),
    HostileName("powers for digits", "\u00b2_\u00b2.jpg"),
    HostileName("drive", "c:x.jpg"),
    HostileName("backslash and dots", "..\\x.jpg"),
    HostileName("backslash at the start", "\\x.jpg"),
    HostileName("backslash within", "x\\y.jpg"),
    HostileName("Latin-1", b"caf\xe9.jpg", NOT_TEXT),
    HostileName("half a letter", b"x\xc3.jpg", NOT_TEXT),
    HostileName("surrogate", b"\xed\xa0\x80.jpg", NOT_TEXT),
    HostileName("overlong", b"\xc0\xaf.jpg", NOT_TEXT),
    HostileName("all bytes", bytes(range(0x80, 0x100)) + b".jpg", NOT_TEXT),
)


def cases() -> list[HostileName]:
    """List all hostile names; each is the name of one sound photograph."""
    return [*CASES]
