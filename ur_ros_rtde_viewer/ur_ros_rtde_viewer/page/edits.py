"""Lets an edit arrive before the click on a button that follows it.

viser sends at most one message of a panel in 50 ms: the newest one, of any element. If a busy browser dispatches an edit and a click
together, the edit is lost, and a goal has other values than the page shows.
"""

from . import style
from .scripts import script

PAUSE = 0.1  # s, between an edit and a click

# Sliders, lists and numbers are also edited by keys and pointers. Clicks that wait are dropped by STOP, which is also in the palette of
# commands (Spotlight).
CLICKS_AFTER_EDITS = script("clicksAfterEdits", f"""
const PAUSE = {1e3 * PAUSE:g}, editors = '[class*=Slider], [aria-haspopup=listbox], [role=option], [class*=NumberInput]';
const atOnce = '{style.STOP_BUTTON}, {style.JOG_BUTTONS}, [class*=NumberInput], [class*=Spotlight]', waiting = new Set();
let edited = -Infinity, passing = null;
const note = event => {{
  if (event.type === 'input' || event.target.closest?.(editors)) edited = performance.now();
  if (window.isStopPress(event)) waiting.clear();
}};
for (const type of ['input', 'keydown', 'pointerdown', 'pointerup', 'click']) window.addEventListener(type, note, true);
const pass = button => {{
  const rest = edited + PAUSE - performance.now();
  if (rest > 0) {{
    setTimeout(pass, rest, button);
  }} else if (waiting.delete(button)) {{
    passing = button;
    button.click();
    passing = null;
  }}
}};
window.addEventListener('click', event => {{
  const button = event.target.closest?.('button');
  if (!button || button === passing || button.matches(atOnce) || performance.now() - edited >= PAUSE) return;
  event.stopImmediatePropagation();
  event.preventDefault();
  if (!waiting.has(button)) setTimeout(pass, 0, button);
  waiting.add(button);
}}, true);
""")
