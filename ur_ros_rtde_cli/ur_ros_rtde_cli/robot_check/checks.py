"""All checks of a robot, in the order in which problems have to be solved."""

from dataclasses import dataclass
from typing import Dict, Iterator, Optional, Tuple

from . import calibration, host, identity, inputs, link, ports, readiness, stream
from .connection import ConnectionFailure
from .dashboard import Dashboard
from .finding import Finding, fault
from .primary import read_arm_data
from .rtde import Rtde

SETTINGS = ("timestamp", "payload", "tcp_offset", "target_speed_fraction")


@dataclass(frozen=True)
class Options:
    address: str
    model: str = ""  # expected model, empty for any
    serial_number: str = ""  # expected serial number, empty for any
    kinematics_params_file: str = ""  # calibration in use, empty for the nominal kinematics
    limit: float = 2.0  # s, for each answer
    duration: float = 2.0  # s, of the measurement of packages


class RobotCheck:
    """Checks one robot. Each check uses connections of its own."""

    def __init__(self, options: Options):
        self._options = options
        self._version: Optional[Tuple[int, int, int, int]] = None

    def findings(self) -> Iterator[Finding]:
        """Yields the findings as they are found."""
        outcomes = ports.probe_all(self._options.address, self._options.limit)
        yield from ports.judge(self._options.address, outcomes)
        for port, subject, check in ((30004, "version", self._check_version), (30001, "arm", self._check_arm),
                                     (29999, "dashboard", self._check_dashboard), (30004, "RTDE", self._check_settings),
                                     (30004, "input registers", self._check_inputs), (30004, "packages", self._check_connection)):
            if outcomes[port] is not ports.Outcome.OPEN or self._is_unsupported():
                continue
            try:
                yield from check()
            except ConnectionFailure as failure:
                yield fault(subject, str(failure), "check that the address is that of a robot; restart a controller that does not answer")

    @property
    def _cb3(self) -> bool:
        return self._version is not None and self._version[0] == 3

    def _is_unsupported(self) -> bool:
        return self._version is not None and self._version[0] not in identity.TESTED

    def _check_version(self) -> Iterator[Finding]:
        with Rtde(self._options.address, self._options.limit) as rtde:
            self._version = rtde.version()
        yield identity.judge_version(self._version)

    def _check_arm(self) -> Iterator[Finding]:
        data = read_arm_data(self._options.address, self._options.limit)
        yield identity.judge_model(data.type_number, self._cb3, self._options.model)
        model = identity.model_of_type(data.type_number, self._cb3) or self._options.model
        if model:
            yield calibration.judge(data.kinematics, model, self._options.kinematics_params_file)

    def _check_dashboard(self) -> Iterator[Finding]:
        answers = self._ask_dashboard()
        changed = identity.changed_identity(answers, self._ask_dashboard(), ("get serial number", "PolyscopeVersion"))
        if changed:
            yield changed
        yield identity.judge_serial(answers["get serial number"], self._options.serial_number)
        yield readiness.judge_robot_mode(answers["robotmode"])
        yield readiness.judge_safety(answers["safetystatus"] or answers["safetymode"])
        yield readiness.judge_remote_control(answers["is in remote control"], self._cb3, answers["PolyscopeVersion"])
        yield from readiness.judge_operational_mode(answers["get operational mode"])
        yield readiness.judge_program(answers["programState"], answers["get loaded program"])

    def _ask_dashboard(self) -> Dict[str, str]:
        with Dashboard(self._options.address, self._options.limit) as dashboard:
            return {query: dashboard.query(query) for query in Dashboard.QUERIES}

    def _check_settings(self) -> Iterator[Finding]:
        with Rtde(self._options.address, self._options.limit) as rtde:
            rtde.set_outputs(SETTINGS, 10.0)
            rtde.start()
            values = rtde.values()
        yield from readiness.judge_installation(values)

    def _check_inputs(self) -> Iterator[Finding]:
        yield from inputs.judge(inputs.read_input_types(self._options.address, self._options.limit))

    def _check_connection(self) -> Iterator[Finding]:
        with Rtde(self._options.address, self._options.limit) as rtde:
            yield link.judge_round_trips(link.measure_round_trips(rtde))
            measured = stream.measure(rtde, 0.008 if self._cb3 else 0.002, self._options.duration)
            yield from stream.judge(measured)
            yield link.judge_packets(link.packets(rtde.connection.socket))
            yield link.judge_interface(link.interface_of(rtde.connection.socket.getsockname()[0]))
        yield from host.judge()
