"""Where a real browser lies, and how it is started without a screen."""

import os
from pathlib import Path

CHROMIUM = Path(os.environ.get("NOSTALGIN_CHROMIUM", "/usr/bin/chromium"))
SOFTWARE_GL = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
