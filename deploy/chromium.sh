#!/bin/sh
# Finds Chromium for the browser tests, or fetches it: Debian's package where that can
# be installed, Playwright's own build elsewhere.
set -eu
if [ -n "${NOSTALGIN_CHROMIUM:-}" ] || command -v chromium >/dev/null 2>&1; then
    exit 0
fi
if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null 2>&1; then
    apt-get update -q >/dev/null
    DEBIAN_FRONTEND=noninteractive apt-get install -y -q chromium >/dev/null
else
    .venv/bin/playwright install chromium
fi
