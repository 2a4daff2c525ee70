"""Lets each edit arrive, and before the click on a button that follows it.

viser sends at most one message of a panel in 50 ms: the newest one, of any element. If a busy browser dispatches two edits, or an edit and
a click, together, the first one is lost, and a goal has other values than the page shows.
"""

from . import style
from .scripts import script

PAUSE = 0.15  # s, after an edit or a click, in which viser has sent it

# While an edit may not be sent yet, edits of other texts, of checkboxes and lists, and clicks on buttons wait. Sliders, lists and numbers
# are also edited by keys and pointers, which do not wait. STOP, which is also in the palette of commands (Spotlight), waits for nothing and
# drops what waits, except for texts: the page shows them.
SPACING = script("spaceEdits", f"""
const texts = 'textarea, input:not([type=file], [type=checkbox])', clickable = 'button, [type=checkbox], [role=option]';
const editors = '[class*=Slider], [aria-haspopup=listbox], [role=option], [type=checkbox], [class*=NumberInput]';
const atOnce = '{style.STOP_BUTTON}, {style.JOG_BUTTONS}, button[class*=NumberInput], [class*=Spotlight], input[aria-haspopup=listbox]';
let edited = null, timer = null, waiting = [], isPassing = false;
const edit = element => {{
  edited = edited && edited !== element ? window : element;  // window: several
  clearTimeout(timer);
  timer = setTimeout(passOn, {1e3 * PAUSE:g});
}};
const passOn = () => {{
  edited = null;
  const element = waiting.shift();
  if (!element) return;
  isPassing = true;
  if (element.matches(clickable)) element.click();
  else element.dispatchEvent(new Event('input', {{bubbles: true}}));
  isPassing = false;
  edit(element);
}};
const waits = (event, element) => {{
  if (isPassing || element.matches(atOnce) || !waiting.length && (!edited || edited === element)) return false;
  event.stopImmediatePropagation();
  event.preventDefault();
  if (!waiting.includes(element)) waiting.push(element);
  return true;
}};
const handle = event => {{
  const find = names => event.target.closest?.(names);
  const isText = ['input', 'change'].includes(event.type), editor = find(isText ? texts : editors);
  const target = isText ? editor : event.type === 'click' && find(clickable);
  if (window.isStopPress(event)) waiting = waiting.filter(element => !element.matches(clickable));
  if (!(target && waits(event, target)) && editor) edit(editor);
}};
for (const type of ['input', 'change', 'keydown', 'pointerdown', 'pointerup', 'click']) window.addEventListener(type, handle, true);
""")
