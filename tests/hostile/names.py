"""Names of files as disks take them: blanks, marks, controls, formulas, no text."""

import os
from dataclasses import dataclass
from typing import Final

NOT_TEXT: Final = "file name is not UTF-8"
OUTSIDE: Final = "path outside the photo folder"


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


def cases() -> list[HostileName]:
    """List all hostile names; each is the name of one sound photograph."""
    one = HostileName
    return [
        one("blank at the start", " x.jpg"),
        one("blank before the suffix", "x .jpg"),
        one("blanks around a folder", " folder /x.jpg"),
        one("only a blank", " .jpg"),
        one("tab at the start", "\tx.jpg"),
        one("tab within", "x\ty.jpg"),
        one("line break at the start", "\nx.jpg"),
        one("line break within", "x\ny.jpg"),
        one("carriage return", "x\ry.jpg"),
        one("both line breaks", "x\r\ny.jpg"),
        one("form feed at the start", "\fx.jpg"),
        one("no-break space at the start", "\u00a0x.jpg"),
        one("ideographic space at the start", "\u3000x.jpg"),
        one("zero-width space", "\u200bx.jpg"),
        one("byte order mark", "\ufeffx.jpg"),
        one("line separator", "x\u2028y.jpg"),
        one("right-to-left override", "\u202egpj.x.jpg"),
        one("Hebrew", "\u05e8\u05d7\u05d5\u05d1.jpg"),
        one("emoji", "\U0001f3db\ufe0f.jpg"),
        one("composed accent", "caf\u00e9.jpg"),
        one("parted accent", "cafe\u0301.jpg"),
        one("small letters", "case.jpg"),
        one("capital letters", "CASE.JPG"),
        one("two suffixes", "case.png.jpg"),
        one("255 bytes", "n" * 251 + ".jpg"),
        one("255 bytes of accents", "\u00e9" * 125 + "x.jpg"),
        one("double quote", 'x"y.jpg'),
        one("double quote at the start", '"x.jpg'),
        one("apostrophe", "'x'.jpg"),
        one("comma", "x,y.jpg"),
        one("semicolon", "x;y.jpg"),
        one("percent and zeros", "%00x.jpg"),
        one("percent and dots", "%2e%2e%2fx.jpg"),
        one("question mark", "x.jpg?y.jpg"),
        one("number sign", "x#y.jpg"),
        one("option", "-o.jpg"),
        one("long option", "--models=x.jpg"),
        one("tilde", "~root.jpg"),
        one("variable", "$HOME.jpg"),
        one("command", "$(touch x).jpg"),
        one("pipe", "|touch x.jpg"),
        one("formula", "=cmd|x.jpg"),
        one("formula with plus", "+1+1.jpg"),
        one("formula with at", "@SUM(1).jpg"),
        one("script", "<script>alert(1)<.jpg"),
        one("markup of the console", "[red]x[/].jpg"),
        one("escape of the terminal", "\x1b[2Jx.jpg"),
        one("bell", "\ax.jpg"),
        one("delete", "x\x7f.jpg"),
        one("wildcards", "*?[a-z].jpg"),
        one("three dots", "...jpg"),
        one("braces", "{0}{name}%s.jpg"),
        one("device of another system", "CON.jpg"),
        one("null", "null.jpg"),
        one("not a number", "nan.jpg"),
        one("block and lot of many digits", "99999999999_99999999999.jpg"),
        one("digits of another script", "\u0665_\u0661.jpg"),
        one("powers for digits", "\u00b2_\u00b2.jpg"),
        one("drive", "c:x.jpg", OUTSIDE),
        one("backslash and dots", "..\\x.jpg", OUTSIDE),
        one("backslash at the start", "\\x.jpg", OUTSIDE),
        one("backslash within", "x\\y.jpg"),
        one("Latin-1", b"caf\xe9.jpg", NOT_TEXT),
        one("half a letter", b"x\xc3.jpg", NOT_TEXT),
        one("surrogate", b"\xed\xa0\x80.jpg", NOT_TEXT),
        one("overlong", b"\xc0\xaf.jpg", NOT_TEXT),
        one("all bytes", bytes(range(0x80, 0x100)) + b".jpg", NOT_TEXT),
    ]
