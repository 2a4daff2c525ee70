"""The control side of the page: STOP for all robots, and for each browser tab forms, jog buttons, a target pose and the digital twin."""

import functools
import threading
import time
from typing import Any, Callable, Dict, List

from ..page import edits, heartbeat, style, uploads
from ..page.heartbeat import Heartbeat
from ..page.scripts import STOP_PRESSES, script
from ..panels.state_panel import StatePanel
from .control_node import ControlNode, create_steady_timer
from .form_panel import FormPanel
from .goals import end_all
from .jog_panel import JogPanel
from .robot_control import RobotControl
from .speed_control import SpeedControl
from .stop import Outcome
from .target_panel import TargetPanel
from .twin_panel import TwinPanel

STOP_REPEAT = 2.0  # Hz, while the button is held
STOP_WIDTH = 220  # pixels; viser makes no panel narrower
STOP_KEY: Any = "escape"
EXPAND_PERIOD = 1.0  # s
# viser ignores hotkeys while an input has the focus. Esc in an input leaves it and is pressed again outside.
ESCAPE_IN_INPUTS = script("escapeInInputs", """
document.addEventListener('keydown', event => {
  if (event.key === 'Escape' && event.target.matches('input, textarea, select, [contenteditable]')) {
    event.target.blur();
    document.body.dispatchEvent(new KeyboardEvent('keydown', {key: 'Escape', code: 'Escape', bubbles: true}));
  }
}, true);
""")


class Control:
    """Each browser tab has elements of its own: two tabs do not edit the same form, and a button that was held when the
    connection broke does not exist anymore when it is back."""

    def __init__(self, viewer: Any):
        self._server, self._post = viewer.server, viewer.post
        self._node = ControlNode(viewer.nodes.context)
        self._robots = [RobotControl(self._node, view, viewer.nodes.node, self._show_actions) for view in viewer.robots]
        self._containers = [[view.tabs.add_tab(name) for name in ("Commands", "Jog", "Target", "Twin")] for view in viewer.robots]
        self._tabs: Dict[int, List[Any]] = {}
        self._lock = threading.Lock()
        self._expanded = -float("inf")
        self._outcomes: Dict[str, str] = {}
        for robot in self._robots:
            slider = next(panel.speed_slider for panel in robot.view.panels if isinstance(panel, StatePanel))
            robot.view.panels += [robot, SpeedControl(slider, robot.goals)]
        self._heartbeat = self._add_stop(viewer.server.gui)
        create_steady_timer(self._node.node, heartbeat.PERIOD, self._heartbeat.beat)
        self._node.start()
        viewer.server.on_client_connect(self._connect)
        viewer.server.on_client_disconnect(self._disconnect)

    def _add_stop(self, gui: Any) -> Heartbeat:
        """Adds STOP in a window of its own, which stays in view when tabs change or scroll. Notifications of viser are at the top."""
        self._stop_panel = gui.add_panel()
        with self._stop_panel.add_tab("STOP"):
            gui.add_html(style.STOP + STOP_PRESSES + ESCAPE_IN_INPUTS + uploads.LIMIT + edits.SPACING)
            button = gui.add_button("STOP", color="red", hint="Decelerates all robots of this page. No substitute for an emergency stop")
            self._stop_text = gui.add_markdown("The key Esc does the same.")
            shown = Heartbeat(gui)
        self._stop_panel.float(x=-15, y=-15, width=STOP_WIDTH)

        async def stop(_event: Any) -> None:
            self.stop()

        button.on_hold(stop, callback_hz=STOP_REPEAT)  # the first call comes when the button is pressed, not when it is released
        button.on_click(stop)  # with the keyboard
        gui.add_command("STOP", description="Decelerates all robots of this page", hotkey=STOP_KEY).on_trigger(stop)
        return shown

    def update(self) -> None:
        """Opens the window with STOP again if it was minimized. Called in the thread of the viewer's loop."""
        now = time.monotonic()
        if now - self._expanded >= EXPAND_PERIOD:
            self._expanded = now
            self._stop_panel.expand()

    def stop(self) -> None:
        """Stops all robots."""
        for robot in self._robots:
            name = f"{robot.view.options.name}: " if len(self._robots) > 1 else ""
            robot.stop(functools.partial(self._show_outcome, name))
        self._node.post(self._heartbeat.answer_stop)

    def _show_outcome(self, name: str, outcome: Outcome, text: str) -> None:
        """Shows the last outcome of each robot: the success of one does not hide the failure of another."""
        self._outcomes[name] = f"{name}{outcome.value} {text}"
        self._stop_text.content = "\n\n".join(self._outcomes.values())

    def _connect(self, client: Any) -> None:
        panels: List[Any] = []
        for robot, (commands, jog, target, twin) in zip(self._robots, self._containers):
            panels += [FormPanel(client.gui, commands, robot), JogPanel(client.gui, jog, robot, client.client_id),
                       TargetPanel(client, target, robot, self._post),
                       TwinPanel(client.gui, twin, robot, client.client_id, self._post)]
        with self._lock:
            self._tabs[client.client_id] = panels
        if client.client_id not in self._server.get_clients():  # closed in the meantime
            self._disconnect(client)
        self._show_actions()

    def _disconnect(self, client: Any) -> None:
        with self._lock:
            panels = self._tabs.pop(client.client_id, [])
        for panel in panels:
            panel.close()

    def _show_actions(self) -> None:
        with self._lock:
            forms = [panel for panels in self._tabs.values() for panel in panels if isinstance(panel, FormPanel)]
        for form in forms:
            form.update_actions()

    def end_goals(self, is_interrupted: Callable[[], bool]) -> None:
        """Cancels the goals of all robots: none of them waits for the others to come to rest."""
        end_all([robot.goals for robot in self._robots], is_interrupted)

    def close(self) -> None:
        """Called after the robots were closed."""
        self._node.close()
