"""Rate, jitter, losses and clock of the RTDE packages."""

import socket
import statistics
import struct
import time
from dataclasses import dataclass
from typing import List, Tuple

from .connection import ConnectionFailure
from .finding import Finding, fault, ok, warning
from .rtde import Rtde

# About the load of the driver: the outputs that ur_rtde receives in all versions of PolyScope.
OUTPUTS = ("timestamp", "target_q", "target_qd", "target_qdd", "target_current", "target_moment", "actual_q", "actual_qd", "actual_current",
           "joint_control_output", "actual_TCP_pose", "actual_TCP_speed", "actual_TCP_force", "target_TCP_pose", "target_TCP_speed",
           "actual_digital_input_bits", "joint_temperatures", "actual_execution_time", "robot_mode", "joint_mode", "safety_mode",
           "actual_tool_accelerometer", "speed_scaling", "target_speed_fraction", "actual_momentum", "actual_main_voltage",
           "actual_robot_voltage", "actual_robot_current", "actual_joint_voltage", "actual_digital_output_bits", "runtime_state",
           "payload", "tcp_offset")
SILENCE_LIMIT = 0.1  # s, parameter silence_limit of the driver
CLOCK_TOLERANCE = 1e-3
_TIMESTAMP = struct.Struct("@qq")
_SO_TIMESTAMPNS = 35  # Linux; missing in the module socket


@dataclass(frozen=True)
class Stream:
    """Packages of one connection."""

    cycle: float  # s, requested period
    sent: List[float]  # s, time stamps of the controller
    arrived: List[float]  # s, by the clock of this host, when the kernel received them
    read: List[float]  # s, by the same clock, when this program read them
    answer_time: float = 0.0  # s, of a request at the end, whose answer waits behind the packages on their way

    @property
    def lost(self) -> int:
        """Packages that the controller has not sent, because the connection was too slow."""
        return sum(max(0, round((later - earlier) / self.cycle) - 1) for earlier, later in zip(self.sent, self.sent[1:]))

    def clock_rate(self) -> float:
        """Returns seconds of the controller per second of this host."""
        slope, _ = _line(self.sent, self.arrived)
        return 1.0 / slope

    def delays(self) -> List[float]:
        """Returns the delay of each package relative to the fastest one, s."""
        slope, offset = _line(self.sent, self.arrived)
        late = [arrived - (offset + slope * sent) for sent, arrived in zip(self.sent, self.arrived)]
        earliest = min(late)
        return [value - earliest for value in late]

    def longest_silence(self) -> float:
        return max(later - earlier for earlier, later in zip(self.arrived, self.arrived[1:]))

    def wake_up_delays(self) -> List[float]:
        """Returns the times between the arrival of the packages and this program reading them, s."""
        return [read - arrived for arrived, read in zip(self.arrived, self.read)]


def _line(x: List[float], y: List[float]) -> Tuple[float, float]:
    """Returns slope and offset of the line through the points with the smallest squared error."""
    mean_x, mean_y = statistics.fmean(x), statistics.fmean(y)
    spread = sum((value - mean_x) ** 2 for value in x)
    slope = sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / spread
    return slope, mean_y - slope * mean_x


def measure(rtde: Rtde, cycle: float, duration: float) -> Stream:
    """Receives packages for this time. The first tenth of a second, in which connections settle, is left out."""
    rtde.set_outputs(OUTPUTS, 1.0 / cycle)
    stamped = _request_arrival_times(rtde.connection.socket)
    rtde.start()
    sent: List[float] = []
    arrivals: List[float] = []
    reads: List[float] = []
    begin = time.time()
    end = begin + 0.1 + duration
    buffer = rtde.connection.take_received()
    while time.time() < end:
        data, arrived, read = _receive(rtde.connection.socket, stamped)
        buffer += data
        while len(buffer) >= 3 and len(buffer) >= (size := int.from_bytes(buffer[:2], "big")) >= 3:
            package, buffer = buffer[:size], buffer[size:]
            if package[2] == ord("U") and arrived >= begin + 0.1:
                sent.append(rtde.decode(package[3:])["timestamp"])
                arrivals.append(arrived)
                reads.append(read)
    if len(sent) < 3:
        raise ConnectionFailure(f"port 30004: {len(sent)} packages within {duration:g} s")
    rtde.connection.put_back(buffer)
    asked = time.time()
    rtde.version()
    return Stream(cycle, sent, arrivals, reads, time.time() - asked)


def _request_arrival_times(connection: socket.socket) -> bool:
    try:
        connection.setsockopt(socket.SOL_SOCKET, _SO_TIMESTAMPNS, 1)
        return True
    except OSError:
        return False


def _receive(connection: socket.socket, stamped: bool) -> Tuple[bytes, float, float]:
    """Returns the data, and when they arrived and were read."""
    try:
        connection.settimeout(2.0)
        data, messages, _, _ = connection.recvmsg(65536, 64)
    except (TimeoutError, socket.timeout):
        raise ConnectionFailure("port 30004: no package within 2 s") from None
    except OSError as error:
        raise ConnectionFailure(f"port 30004: {error.strerror}") from None
    if not data:
        raise ConnectionFailure("port 30004: the controller has closed the connection")
    now = time.time()
    for _level, kind, content in messages:
        if stamped and kind == _SO_TIMESTAMPNS and len(content) >= _TIMESTAMP.size:
            seconds, nanoseconds = _TIMESTAMP.unpack(content[:_TIMESTAMP.size])
            return data, seconds + 1e-9 * nanoseconds, now
    return data, now, now


def _p99(values: List[float]) -> float:
    return sorted(values)[int(0.99 * (len(values) - 1))]


def judge(stream: Stream) -> List[Finding]:
    if stream.answer_time > SILENCE_LIMIT:
        return [fault("bandwidth",
                      f"the packages of {1.0 / stream.cycle:.0f} Hz pile up: after {stream.arrived[-1] - stream.arrived[0]:.1f} s, "
                      f"an answer takes {1e3 * stream.answer_time:.0f} ms",
                      "use a wired connection with at least 100 Mbit/s, or a lower rtde_frequency")]
    return [_rate(stream), _clock(stream), _jitter(stream), _host(stream)]


def _rate(stream: Stream) -> Finding:
    received = len(stream.sent)
    text = f"{received} packages in {stream.sent[-1] - stream.sent[0]:.1f} s of the controller's time"
    if stream.lost:
        return warning("packages",
                       f"{stream.lost} of {received + stream.lost} were not sent by the controller, because the connection or this host is "
                       "too slow",
                       "use a wired connection with at least 100 Mbit/s, and close programs that load this host")
    return ok("packages", f"{text}, none lost")


def _clock(stream: Stream) -> Finding:
    rate = stream.clock_rate()
    if abs(rate - 1.0) > CLOCK_TOLERANCE:
        return warning("clock", f"the controller's clock runs {rate:.4f} times as fast as the one of this host",
                       "if it is a simulator, its host is too slow (--real-time-factor); otherwise check the time synchronization of this "
                       "host")
    return ok("clock", f"runs like the one of this host; the controller has run for {stream.sent[-1] / 3600:.1f} h")


def _jitter(stream: Stream) -> Finding:
    delays, silence = stream.delays(), stream.longest_silence()
    text = f"packages are delayed by {1e3 * _p99(delays):.2f} ms (p99), {1e3 * max(delays):.2f} ms (max)"
    if silence > SILENCE_LIMIT:
        return fault("jitter",
                     f"no package arrived for {1e3 * silence:.0f} ms, so the driver regards the connection as lost (silence_limit)",
                     "use a direct cable without Wi-Fi or loaded switches, and check the findings about the link")
    if _p99(delays) > stream.cycle:
        return warning("jitter", text, "servo motions may be uneven: use a direct cable, or a switch without other load")
    return ok("jitter", text)


def _host(stream: Stream) -> Finding:
    delays = stream.wake_up_delays()
    text = f"this host reads packages {1e3 * _p99(delays):.2f} ms (p99), {1e3 * max(delays):.2f} ms (max) after they arrive"
    if _p99(delays) > stream.cycle:
        return warning("host", text, "close other programs, and set up this host as docs/use/real_time.md describes")
    return ok("host", text)
