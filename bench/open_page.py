"""Shows a page in a headless Chromium until it is stopped. Started by `./ur bench --viewer`.

    open_page.py http://127.0.0.1:8080
"""

import os
import signal
import sys
from pathlib import Path

from playwright.sync_api import sync_playwright

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tools"))
from ur_tools import browser

LIMIT = 120.0  # s
WINDOW = {"width": 1280, "height": 880}
COARSE = "?fixedDpr=0.1"  # scene pixels per screen pixel: without a GPU, the processor draws them


def main():
    with sync_playwright() as playwright:
        page = browser.launch(playwright, LIMIT).new_page(viewport=WINDOW)
        page.set_default_timeout(1e3 * LIMIT)
        page.goto(f"{sys.argv[1]}/{COARSE}")
        page.get_by_role("button", name="STOP", exact=True).wait_for()
        print("The page is open.", flush=True)
        signal.signal(signal.SIGINT, signal.default_int_handler)
        while True:
            page.wait_for_timeout(1000.0)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        os._exit(0)
