"""What must be set before anything is loaded."""

import os

os.environ["ORT_DISABLE_TELEMETRY"] = "1"  # as `nostalgin_core.session` does
