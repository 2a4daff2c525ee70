"""Tells the page that STOP reaches the viewer.

A browser does not notice that a connection is lost without a FIN, as when the host of the viewer loses its power. The viewer changes a
hidden element every PERIOD, and the page shows a notice if it does not change, or if a press of STOP is not answered.
"""

from typing import Any

from .scripts import script

PERIOD = 0.5  # s
LOSS_TIMEOUT = 2.0  # s
ANSWER_TIMEOUT = 1.0  # s
CHECK_PERIOD = 0.25  # s
COUNTS = 1000  # the size of the element does not grow
NO_CONNECTION = "No connection to the viewer: STOP does nothing here. Use the emergency stop button."
NO_ANSWER = f"STOP was not answered within {ANSWER_TIMEOUT:g} s. Use the emergency stop button."

# Timers are late in a busy browser, and messages wait with them: a check counts at most twice its period as silence.
WATCH = script("watchHeartbeat", f"""
const text = name => document.querySelector(name)?.textContent ?? '';
let beat = '', silence = 0, answer = '', waiting = null, before = performance.now();
const note = event => {{
  if (waiting === null && window.isStopPress(event)) [answer, waiting] = [text('.stop-answers'), 0];
}};
for (const type of ['pointerdown', 'click', 'keydown']) document.addEventListener(type, note, true);
setInterval(() => {{
  const now = performance.now(), passed = Math.min(now - before, {2e3 * CHECK_PERIOD:g});
  const newBeat = text('.heartbeat'), newAnswer = text('.stop-answers');
  before = now;
  const isAlive = newBeat !== '' && newBeat !== beat, isBack = isAlive && silence >= {1e3 * LOSS_TIMEOUT:g};
  if (isAlive) beat = newBeat;
  silence = isAlive || newBeat === '' || document.hidden ? 0 : silence + passed;
  if (waiting !== null) waiting = newAnswer === '' || newAnswer !== answer || isBack ? null : waiting + passed;
  window.showNotice('heartbeat', silence >= {1e3 * LOSS_TIMEOUT:g} ? '{NO_CONNECTION}' :
      waiting >= {1e3 * ANSWER_TIMEOUT:g} ? '{NO_ANSWER}' : '');
}}, {1e3 * CHECK_PERIOD:g});
""")


class Heartbeat:
    """Called in one thread: that which executes STOP. Its element is in the window of STOP: viser removes those of collapsed panels."""

    def __init__(self, gui: Any):
        self._element = gui.add_html("")
        gui.add_html(WATCH)
        self._beats = self._answers = 0

    def beat(self) -> None:
        self._beats = (self._beats + 1) % COUNTS
        self._show()

    def answer_stop(self) -> None:
        self._answers = (self._answers + 1) % COUNTS
        self._show()

    def _show(self) -> None:
        self._element.content = (f'<div hidden><span class="heartbeat">{self._beats}</span>'
                                 f'<span class="stop-answers">{self._answers}</span></div>')
