"""The largest file that is uploaded on a page with STOP.

viser hands all parts of a file at once to the only connection of the page. STOP and the release of a button would wait behind them.
"""

from .scripts import script

MAX_BYTES = 1_000_000  # 0.3 s at 30 Mbit/s
NOTICE_TIME = 20.0  # s

LIMIT = script("limitUploads", f"""
window.addEventListener('change', event => {{
  const file = event.target.type === 'file' && event.target.files[0];
  if (!file) return;
  const isLarge = file.size > {MAX_BYTES};
  window.showNotice('upload', isLarge ? `${{file.name}} has ${{(1e-6 * file.size).toFixed(1)}} MB. Where there is STOP, at most ` +
      '{MAX_BYTES / 1e6:g} MB are uploaded, because STOP would wait behind the file. Replay it on the page of another viewer, without ' +
      '--control: ur view --port 0' : '');
  if (!isLarge) return;
  event.stopImmediatePropagation();
  event.target.value = '';
  setTimeout(() => window.showNotice('upload', ''), {1e3 * NOTICE_TIME:g});
}}, true);
""")
