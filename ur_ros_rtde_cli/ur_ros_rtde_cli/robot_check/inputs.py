"""Who holds the RTDE inputs that the driver needs: another client, or a fieldbus."""

from typing import Dict, List

from .finding import Finding, fault, ok, warning
from .rtde import Rtde

REGISTERS = 24  # of each type in each range
OUTPUT_GROUPS = ("speed_slider_mask", "standard_digital_output_mask", "configurable_digital_output_mask", "tool_digital_output_mask",
                 "standard_analog_output_mask")
FIELDBUSES = "EtherNet/IP, PROFINET or MODBUS"


def registers(first: int) -> List[str]:
    return [f"input_{kind}_register_{number}" for kind in ("int", "double") for number in range(first, first + REGISTERS)]


def read_input_types(address: str, limit: float) -> Dict[str, str]:
    """Returns the type of each input, IN_USE for those that other clients have. Holds the free ones for one request."""
    types: Dict[str, str] = {}
    for names in (registers(0), registers(REGISTERS), list(OUTPUT_GROUPS)):
        with Rtde(address, limit) as rtde:
            types.update(rtde.input_types(names))
    return types


def _used(types: Dict[str, str], names: List[str]) -> List[str]:
    return [name for name in names if types.get(name) == "IN_USE"]


def judge(types: Dict[str, str]) -> List[Finding]:
    lower, upper = (_used(types, registers(first)) for first in (0, REGISTERS))
    groups = _used(types, list(OUTPUT_GROUPS))
    fieldbus = len(lower) == 2 * REGISTERS
    findings = []
    if fieldbus:
        free = "free" if not upper else f"{len(upper)} of them are in use, too"
        findings.append(fault("input registers",
                              f"all lower input registers (0 to 23) are in use, as a fieldbus adapter ({FIELDBUSES}) holds them; "
                              f"registers 24 to 47: {free}",
                              "disable the adapter in the installation (Installation > Fieldbus), or start the driver with "
                              "register_range:=upper"))
    if groups or upper or (lower and not fieldbus):
        held = [*groups, *upper, *([] if fieldbus else lower)]
        findings.append(warning("clients", "a driver or another RTDE client controls the robot: "
                                f"it holds {len(held)} inputs, among them {held[0]}",
                                "nothing, if it is yours; otherwise stop it first: a second driver reports ROBOT_IN_USE"))
    return findings or [ok("input registers", "free: no fieldbus and no other client holds them")]
