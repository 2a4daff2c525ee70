"""Calls each function of a public MODBUS client, pymodbus, on the simulator. Ends with status 1 at the first unexpected result."""

import sys

from pymodbus.client import ModbusTcpClient


def check(what: str, response: object, attribute: str, expected: object) -> None:
    value = getattr(response, attribute)
    if value != expected:
        sys.exit(f"{what}: {attribute} is {value}, not {expected}: {response}")
    print(f"{what}: {value}")


def main(address: str, port: int) -> None:
    with ModbusTcpClient(address, port=port) as client:
        check("robot mode", client.read_holding_registers(258), "registers", [7])
        check("status bits", client.read_discrete_inputs(260, count=6), "bits", [True, False, False, False, False, False, False, False])
        check("write register", client.write_register(128, 65535), "registers", [65535])
        check("write registers", client.write_registers(129, [1, 2, 3]), "count", 3)
        check("general purpose registers", client.read_input_registers(128, count=4), "registers", [65535, 1, 2, 3])
        check("write coil", client.write_coil(16, True), "bits", [True])
        check("write coils", client.write_coils(17, [False, True]), "count", 2)
        check("outputs", client.read_coils(16, count=3), "bits", [True, False, True, False, False, False, False, False])
        check("outputs as a register", client.read_holding_registers(1), "registers", [5])
        check("all bits", client.read_coils(0, count=628), "exception_code", 0)
        check("largest number of registers", client.read_holding_registers(256, count=125), "exception_code", 0)
        check("missing address", client.read_holding_registers(2054), "exception_code", 2)
        check("read-only address", client.write_register(400, 1), "exception_code", 2)
        check("impossible value", client.write_register(20, 13), "exception_code", 3)
        check("unsupported function", client.read_device_information(), "exception_code", 1)


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
