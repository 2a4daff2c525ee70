"""The form of an action in the page of one browser tab, and the goals that were sent with it."""

import asyncio
import threading
from typing import Any, Callable, Dict, List, Optional

from ur_ros_rtde_cli import actions
from ur_ros_rtde_cli.errors import CliError
from ur_ros_rtde_cli.fields import FieldError, Path

from . import action_forms
from .action_forms import FRAME, Form, FormField, Kind, Source
from .goal_view import GoalView, escaped
from .goals import Phase, SentGoal
from .robot_control import RobotControl

NO_ACTION = "(no action server found)"
FIRST_ACTION = "move_j"


class FormPanel:
    """`container` is the tab of the page in which the form is shown. Methods can be called in any thread."""

    def __init__(self, gui: Any, container: Any, robot: RobotControl):
        self._gui, self._container, self._robot = gui, container, robot
        self._lock = threading.RLock()  # a new value of the dropdown calls _show() in the thread that sets it
        self._form: Optional[Form] = None
        self._folder: Any = None
        self._inputs: Dict[Path, Any] = {}
        self._filled: Dict[Path, str] = {}  # with the current position
        self._goals: List[GoalView] = []
        self._closed = False
        with container:
            self._action = gui.add_dropdown("Action", (NO_ACTION,), hint="Type a part of the name to search")
            self._send_button = gui.add_button("Send", disabled=True)
            self._position_button = gui.add_button("Use the current position", color="gray", visible=False)
            self._error = gui.add_markdown("")
            self._goals_folder = gui.add_folder("Goals", visible=False)
        self._action.on_update(self._locked(self._show))
        self._send_button.on_click(self._clicked)
        self._position_button.on_click(self._locked(self._refresh))
        self.update_actions()

    def _locked(self, function: Callable[[], None]) -> Callable[[Any], None]:
        """Returns a callback of the page."""

        def call(_event: Any) -> None:
            with self._lock:
                function()

        return call

    async def _clicked(self, event: Any) -> None:
        """Runs in the event loop of viser, in the order of the messages: STOP after a click ends its goal, even if it is sent later."""
        stop_count = self._robot.goals.stop_count
        await asyncio.to_thread(self._locked(lambda: self._send(stop_count)), event)

    def update_actions(self) -> None:
        """Offers the actions that the driver serves. A form that is open stays open as long as its action is served."""
        with self._lock:
            names = tuple(sorted(self._robot.action_types)) or (NO_ACTION,)
            if names == self._action.options:
                return
            selected = self._action.value
            self._action.options = names
            if selected not in names:
                selected = FIRST_ACTION if FIRST_ACTION in names else names[0]
            self._action.value = selected
            self._show()

    def close(self) -> None:
        """Ends the goals and the modes of the tab, which is gone."""
        with self._lock:
            self._closed = True
            for goal in self._goals:
                goal.close()
        self._robot.modes.end(self)

    def _show(self) -> None:
        """Builds the form of the selected action."""
        name = self._action.value
        if self._form is not None and self._form.name == name:
            return
        self._remove()
        if name not in self._robot.action_types:
            return
        try:
            action = actions.load(name, self._robot.action_types[name])
        except CliError as error:
            self._show_error(str(error))
            return
        self._form = action_forms.describe(name, action)
        with self._container:
            self._folder = self._gui.add_folder(name)
        with self._folder:
            self._gui.add_markdown(escaped(self._form.description))
            self._inputs = {field.path: self._add_input(field) for field in self._form.fields}
        self._send_button.disabled = False
        self._position_button.visible = any(field.source != Source.NONE for field in self._form.fields)
        self._use_current_position()

    def _remove(self) -> None:
        if self._folder is not None:
            self._folder.remove()
        self._form, self._folder, self._inputs, self._filled = None, None, {}, {}
        self._send_button.disabled, self._position_button.visible = True, False
        self._show_error("")

    def _add_input(self, field: FormField) -> Any:
        hint = field.comment or None
        if field.kind == Kind.FLAG:
            return self._gui.add_checkbox(field.label, bool(field.default), hint=hint)
        if field.kind == Kind.CHOICE:
            return self._gui.add_dropdown(field.label, field.choices, initial_value=str(field.default), hint=hint)
        handle = self._gui.add_text(field.label, str(field.default), multiline=field.multiline, hint=hint)
        if field.path == FRAME:
            handle.on_update(self._locked(self._clear_pose_in_base))
        return handle

    def _is_in_base(self) -> bool:
        return FRAME not in self._inputs or not self._inputs[FRAME].value

    def _clear_pose_in_base(self) -> None:
        """The pose of the TCP would be another place in another frame; the user has to enter one."""
        for field in self._form.fields if self._form and not self._is_in_base() else ():
            if field.source.is_in_base and self._inputs[field.path].value == self._filled.get(field.path):
                self._inputs[field.path].value = "" if field.source == Source.TCP_POSITION else str(field.default)

    def _use_current_position(self) -> None:
        for field in self._form.fields if self._form else ():
            text = self._robot.current(field.source)
            if text is not None and (self._is_in_base() or not field.source.is_in_base):
                self._inputs[field.path].value = self._filled[field.path] = text

    def _refresh(self) -> None:
        """Uses the current position, or says why there is none."""
        silence = self._robot.silence
        problem = f"The current position is not known: {silence}." if silence else ""
        self._show_error(problem or ("" if self._is_in_base() else "The current position is in base: leave frame_id empty to use it."))
        self._use_current_position()

    def _show_error(self, text: str) -> None:
        self._error.content = escaped(text)

    def _send(self, stop_count: int) -> None:
        form, inputs = self._form, self._inputs
        if form is None or self._closed:
            return
        self._clear_pose_in_base()
        try:
            goal = form.read({path: handle.value for path, handle in inputs.items()})
        except FieldError as error:
            self._show_error(str(error))
            return
        self._show_error("")
        for ended in [view for view in self._goals if view.has_ended]:
            self._goals.remove(ended)
            ended.remove()
        self._goals_folder.visible = True
        self._goals.append(GoalView(self._gui, self._goals_folder, self._robot.goals, form.name, form.action, goal,
                                    stop_count, lambda sent: self._on_end(form.name, goal, sent)))

    def _on_end(self, name: str, goal: Any, sent: SentGoal) -> None:
        """Called in the thread of the node."""
        if sent.phase == Phase.SUCCEEDED:
            self._robot.modes.note(name, None if getattr(goal, "outlives_client", False) else self)
            if self._closed:
                self._robot.modes.end(self)
