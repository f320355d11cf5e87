"""The command line: a file a command. Open `program` first.

Exit codes: 0 done, 1 failed, 2 wrong usage, 3 done with more rejections than allowed,
with most photos of no known place, or without one photograph. Beam and the networks
are imported by the commands that need them, so that `--help` answers at once.
"""

from pipelines.cli.program import app, main

__all__ = ["app", "main"]
