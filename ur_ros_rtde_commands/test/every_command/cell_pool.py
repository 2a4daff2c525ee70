"""Runs scenarios for many plugins in parallel in a pool of cells."""

import queue
from concurrent.futures import ThreadPoolExecutor

from cell import Cell
from documentation import Setup

LOG_LINES = 15  # of the driver, shown with a failure


class CellPool:
    """A pool of cells. Cells are created on demand and reused."""

    def __init__(self, count):
        self._slots = queue.LifoQueue()  # the number of a cell, or the cell if it has been created
        for number in reversed(range(count)):
            self._slots.put(number)
        self._pool = ThreadPoolExecutor(count)

    def submit(self, scenario, *arguments):
        return self._pool.submit(self._run, scenario, arguments)

    def _run(self, scenario, arguments):
        slot = self._slots.get()
        try:
            slot = self._cell_for(getattr(arguments[0], "setup", Setup()), slot)
            outcome = self._run_scenario(scenario, slot, arguments)
            if hasattr(arguments[0], "action"):
                slot.client.destroy_action_client(arguments[0].action)
            return outcome
        except Exception:
            # A cell in which a scenario failed is not reused, because it could affect the next plugin.
            if isinstance(slot, Cell):
                slot.close()
                slot = slot.number
            raise
        finally:
            self._slots.put(slot)

    @staticmethod
    def _cell_for(setup, slot):
        if isinstance(slot, Cell):
            if slot.setup == setup:
                return slot
            slot.close()
            slot = slot.number
        return Cell(slot, setup)

    @staticmethod
    def _run_scenario(scenario, cell, arguments):
        driver, begin = cell.driver, len(cell.driver.lines)
        try:
            return scenario(cell, *arguments)
        except Exception as error:
            log = "\n    ".join(cell.driver.lines[begin if cell.driver is driver else 0:][-LOG_LINES:])
            raise AssertionError(f"{type(error).__name__}: {error}\nlast lines of the driver:\n    {log}") from error

    def close(self):
        self._pool.shutdown(wait=True, cancel_futures=True)
        while not self._slots.empty():
            slot = self._slots.get()
            if isinstance(slot, Cell):
                slot.close()


class Outcomes:
    """The results of `scenario(cell, example)` for each example, by action name."""

    def __init__(self, pool, scenario, examples):
        self._futures = {example.action: pool.submit(scenario, example) for example in examples}

    def get(self, name, limit=600.0):
        """Returns the result of the scenario for this action, or raises its exception."""
        return self._futures[name].result(limit)
