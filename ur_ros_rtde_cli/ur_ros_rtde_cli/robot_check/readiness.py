"""Whether the robot is ready for the driver: modes, remote control, programs, payload."""

from typing import Any, Dict, List

from .finding import Finding, fault, ok, warning

ROBOT_MODES = {"RUNNING": "", "POWER_OFF": "the arm is powered off", "POWER_ON": "the brakes are closed", "IDLE": "the brakes are closed",
               "BOOTING": "the controller is booting", "DISCONNECTED": "the controller has no connection to the arm",
               "CONFIRM_SAFETY": "the safety configuration must be confirmed on the pendant",
               "NO_CONTROLLER": "the controller software does not run", "BACKDRIVE": "the arm is in backdrive mode",
               "UPDATING_FIRMWARE": "the firmware is being updated"}
READY_WITH_COMMANDS = ("POWER_OFF", "POWER_ON", "IDLE")  # make_ready changes these
SAFETY_REMEDIES = {
    "PROTECTIVE_STOP": "remove what the arm has run into, then `ur call make_ready`",
    "SAFEGUARD_STOP": "close the guard, or reset the safeguard input",
    "ENABLING_STOP": "press the enabling device, or select the automatic mode",
    "ROBOT_EMERGENCY_STOP": "find out why it was pressed, release the button, then `ur call make_ready`",
    "SYSTEM_EMERGENCY_STOP": "find out which device of the cell stops the robot, release it, then `ur call make_ready`",
    "RECOVERY": "move the arm back inside its safety limits on the pendant",
    "VIOLATION": "find the cause in the log of the pendant, then `ur call make_ready \"{restart_safety: true}\"`",
    "FAULT": "find the cause in the log of the pendant, then `ur call make_ready \"{restart_safety: true}\"`"}


def judge_robot_mode(mode: str) -> Finding:
    if mode not in ROBOT_MODES:
        return warning("robot mode", f"{mode} is unknown", "look at the pendant")
    if not ROBOT_MODES[mode]:
        return ok("robot mode", mode)
    remedy = "`ur call make_ready` powers the arm on and releases the brakes" if mode in READY_WITH_COMMANDS else "look at the pendant"
    report = warning if mode in READY_WITH_COMMANDS else fault
    return report("robot mode", f"{mode}, {ROBOT_MODES[mode]}", remedy)


def judge_safety(status: str) -> Finding:
    if status == "NORMAL":
        return ok("safety", status)
    if status == "REDUCED":
        return warning("safety", "REDUCED: the reduced limits of the safety configuration apply",
                       "motions beyond them end in a protective stop; leave the reduced mode, or move more slowly")
    kind = next((kind for kind in ("SAFEGUARD_STOP", "ENABLING_STOP") if status.endswith(kind)), "")
    return fault("safety", status, SAFETY_REMEDIES.get(status, SAFETY_REMEDIES.get(kind, "look at the pendant")))


def judge_remote_control(answer: str, cb3: bool, version: str) -> Finding:
    if cb3:
        return ok("remote control", "a CB3 controller takes programs at any time")
    if answer == "true":
        return ok("remote control", "on")
    if answer == "false":
        return fault("remote control", "off: the robot is in local control and takes no program from this host",
                     "enable it under Settings > System > Remote Control, then select Remote Control in the upper right corner; or use "
                     "control_mode:=control_urcap")
    return warning("remote control", f"PolyScope {version} does not report it", "check the upper right corner of the pendant")


def judge_program(state: str, loaded: str) -> Finding:
    """`state`: the answer of programState, "PLAYING <name>"."""
    activity, _, name = state.partition(" ")
    if activity in ("PLAYING", "PAUSED"):
        verb = "runs" if activity == "PLAYING" else "is paused"
        return warning("program", f"the program {name or '<unnamed>'} {verb}",
                       "the driver stops it when it starts, unless it is the program of another driver")
    file = loaded.rpartition("/")[2] if loaded.startswith("/") else ""
    return ok("program", f"none runs, {file or 'none'} is loaded")


def judge_operational_mode(mode: str) -> List[Finding]:
    if mode == "MANUAL":
        return [warning("operational mode", "MANUAL: speed is limited, and a program needs the enabling device if there is one",
                        "select the automatic mode on the pendant")]
    return [] if mode in ("", "NONE") else [ok("operational mode", mode)]


def judge_installation(values: Dict[str, Any]) -> List[Finding]:
    """Payload, TCP and speed slider, from RTDE outputs."""
    findings = []
    if "payload" in values:
        mass, tcp = values["payload"], values.get("tcp_offset", (0.0,) * 6)
        text = f"payload {mass:.2f} kg, TCP at ({', '.join(f'{1e3 * x:.1f}' for x in tcp[:3])}) mm in the flange"
        if mass == 0.0 and any(tcp):
            findings.append(warning("installation", text + ": a tool without mass",
                                    "set the payload in the installation or with set_payload; a wrong one falsifies forces and causes "
                                    "protective stops"))
        else:
            findings.append(ok("installation", text))
    fraction = values.get("target_speed_fraction", 1.0)
    if fraction < 1.0:
        findings.append(warning("speed slider", f"at {100 * fraction:.0f} %, so motions take longer than requested",
                                "move it to 100 % on the pendant, or use set_speed_slider"))
    return findings
