"""Lets each edit arrive before the click that follows it.

viser sends at most one message of a panel in 50 ms: the newest one, of any element. If a busy browser dispatches two edits, or an edit
and a click, together, the first one is lost, and a goal has other values than the page shows.
"""

from . import style
from .scripts import script

PAUSE = 0.1  # s, between messages

# React ignores an event of an input whose value is the one that it knows.
EDITS = """
let edited = -Infinity, typedAt = -Infinity, typed = null, repeated = null;
const repeat = input => {
  repeated = input;
  input._valueTracker?.setValue(input.value + ' ');
  input.dispatchEvent(new Event('input', {bubbles: true}));
  repeated = null;
};
const noteText = (input, now) => {
  if (input === repeated) return;
  if (typed !== input && now - typedAt < PAUSE && (typed.type === 'text' && !typed.ariaHasPopup || typed.type === 'textarea')) {
    edited = Math.max(edited, now) + PAUSE;
    setTimeout(repeat, edited - now, typed);
  }
  [typed, typedAt] = [input, now];
};
"""

# The palette of commands (Spotlight) has STOP.
# Sliders, lists and numbers are also edited by keys and pointers. Clicks that wait are dropped by STOP.
CLICKS = f"""
const waiting = new Set(), editors = '[class*=Slider], [aria-haspopup=listbox], [role=option], [class*=NumberInput]';
let passing = null;
const note = event => {{
  const now = performance.now();
  if (event.type === 'input') noteText(event.target, now);
  if (event.type === 'input' || event.target.closest?.(editors)) edited = Math.max(edited, now);
  if (event.key === 'Escape' || event.target.closest?.('{style.STOP_BUTTON}')) waiting.clear();
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
    edited = performance.now();
  }}
}};
const atOnce = '{style.STOP_BUTTON}, {style.JOG_BUTTONS}, [class*=NumberInput], [class*=Spotlight]';
window.addEventListener('click', event => {{
  const button = event.target.closest?.('button, input[type=checkbox]');
  if (!button || button === passing || button.matches(atOnce)) return;
  if (performance.now() - edited >= PAUSE) return;
  event.stopImmediatePropagation();
  event.preventDefault();
  if (!waiting.has(button)) setTimeout(pass, 0, button);
  waiting.add(button);
}}, true);
"""

CLICKS_AFTER_EDITS = script("clicksAfterEdits", f"const PAUSE = {1e3 * PAUSE:g};" + EDITS + CLICKS)
