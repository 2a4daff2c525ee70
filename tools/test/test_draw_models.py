"""tools/draw_models.py draws the URDFs."""

import subprocess
import sys

from ur_tools.layout import ROOT

BACKGROUND = True


def test_draws_an_arm(tmp_path):
    file = tmp_path / "models.png"
    result = subprocess.run([sys.executable, str(ROOT / "tools" / "draw_models.py"), str(file), "--model", "ur3e"], capture_output=True,
                            text=True, timeout=120)
    assert result.returncode == 0, result.stderr
    assert file.read_bytes().startswith(b"\x89PNG\r\n\x1a\n")
