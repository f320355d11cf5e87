import pytest

from deploy import audit

KNOWN = {"name": "numpy", "version": "2.1", "vulns": []}
HOLE = {"id": "PYSEC-1", "fix_versions": ["2.2"]}
UNKNOWN = {"name": "numpy", "skip_reason": "not found on PyPI"}
OWN = {"name": "nostalgin", "skip_reason": "editable"}


@pytest.mark.parametrize(
    ("packages", "code", "words"),
    [
        ([KNOWN, OWN], 0, "1 packages, 0 known holes"),
        ([KNOWN | {"vulns": [HOLE]}], 1, "numpy 2.1: PYSEC-1: mended in 2.2"),
        ([KNOWN, UNKNOWN], 0, "not asked: numpy: not found on PyPI"),
        ([UNKNOWN, OWN], 2, "NOTHING was audited"),
        ([], 2, "NOTHING was audited"),
    ],
)
def test_what_was_not_asked_is_no_good_news(
    packages: list[dict],
    code: int,
    words: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(audit, "report", lambda _: {"dependencies": packages})
    assert audit.main() == code
    assert words in capsys.readouterr().out
