"""The cores and the memory that ./ur uses: those of the machine, or of the container."""

import pytest
from ur_tools import build, machine

BACKGROUND = True


@pytest.fixture
def container(tmp_path, monkeypatch):
    """Returns a function that sets the limits of a container on a machine with 8 cores and 16 GB."""
    monkeypatch.setattr(machine, "CGROUP", tmp_path)
    monkeypatch.setattr(machine.os, "sched_getaffinity", lambda _: set(range(8)))
    monkeypatch.setattr(machine.os, "sysconf", lambda name: 4096 if name == "SC_PAGE_SIZE" else 4 * 10**6)

    def limits(processor, memory):
        (tmp_path / "cpu.max").write_text(f"{processor}\n")
        (tmp_path / "memory.max").write_text(f"{memory}\n")

    return limits


def found():
    return machine.cores(), machine.memory(), build.default_jobs()


def test_without_a_container_those_of_the_machine_are_used(container):
    assert found() == (8, 16.384e9, 8)


@pytest.mark.parametrize("processor, memory, expected", [
    ("max 100000", "max", (8, 16.384e9, 8)), ("350000 100000", "max", (3, 16.384e9, 3)), ("50000 100000", "max", (1, 16.384e9, 1)),
    ("1600000 100000", "2000000000", (8, 2e9, 2)), ("max 100000", "500000000", (8, 5e8, 1))])
def test_the_limits_of_a_container_are_used(container, processor, memory, expected):
    container(processor, memory)
    assert found() == expected
