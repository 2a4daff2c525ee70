"""Which controller, software and arm answer at the address."""

from typing import Dict, Optional, Sequence, Tuple

from .finding import Finding, fault, ok, warning

# Versions of PolyScope with which the driver is tested: the first and the last one of each major version.
TESTED = {3: ((3, 5), (3, 15)), 5: ((5, 0), (5, 25))}
POLYSCOPE_X = 10

# Robot types in the primary interface, for CB3 and for later controllers.
_CB3_TYPES = {1: "ur5", 2: "ur10", 3: "ur3"}
_TYPES = {1: "ur5e", 2: "ur10e", 3: "ur3e", 4: "ur16e", 5: "ur18", 6: "ur8long", 7: "ur20", 8: "ur30", 9: "ur15"}
_SAME_ARM = {"ur7e": "ur5e", "ur12e": "ur10e"}  # models that report the type of another one, with identical arms



def model_of_type(number: Optional[int], cb3: bool) -> Optional[str]:
    return None if number is None else (_CB3_TYPES if cb3 else _TYPES).get(number)


def judge_version(version: Tuple[int, int, int, int]) -> Finding:
    text = "PolyScope " + ".".join(map(str, version[:3]))
    major = version[0]
    if major >= POLYSCOPE_X:
        return fault("version", f"{text}: PolyScope X has no dashboard server, which this driver needs",
                     "use a robot with PolyScope 5; docs/use/polyscope_x.md lists what is missing")
    if major not in TESTED:
        return fault("version", f"{text} is unknown", "use PolyScope 5, or 3 on a CB3")
    first, last = TESTED[major]
    if version[:2] < first:
        return fault("version", f"{text} is older than {first[0]}.{first[1]}, the first version with which the driver is tested",
                     "update PolyScope")
    if version[:2] > last:
        return warning("version", f"{text} is newer than {last[0]}.{last[1]}, the last version with which the driver is tested",
                       "try each command slowly, with a hand on the emergency stop, before relying on it")
    return ok("version", text)


def judge_model(type_number: Optional[int], cb3: bool, wanted: str) -> Finding:
    """`wanted`: the model that the user expects, empty for any."""
    model = model_of_type(type_number, cb3)
    if model is None:
        what = "no robot type" if type_number is None else f"the robot type {type_number}, which is unknown"
        return warning("model", f"the controller reports {what}", "start the driver with ur_type:=<the model on the base of the arm>")
    if wanted and _SAME_ARM.get(wanted, wanted) != model:
        return fault("model", f"the arm is a {model}, not a {wanted}",
                     f"use ur_type:={model}, and a description of that model, or the address of the right robot")
    twins = [name for name, same in _SAME_ARM.items() if same == model]
    return ok("model", model + (f" (or {twins[0]}, which has the same arm)" if twins else ""))


def judge_serial(serial: str, wanted: str) -> Finding:
    """`wanted`: the serial number that the user expects, empty for any."""
    if wanted and serial != wanted:
        return fault("serial number", f"{serial or 'not reported'}, not {wanted}",
                     "use the address of the right robot; two devices with one address also show alternating numbers")
    return ok("serial number", serial or "not reported by this version of PolyScope")


def changed_identity(first: Dict[str, str], later: Dict[str, str], questions: Sequence[str]) -> Optional[Finding]:
    """Compares the answers of two connections: two devices with one address answer in turns."""
    for question in questions:
        if first[question] != later[question]:
            return fault("address", f"two robots answer at this address: `{question}` gave {first[question]!r}, then {later[question]!r}",
                         "give each robot an address of its own (PolyScope: Settings > System > Network)")
    return None
