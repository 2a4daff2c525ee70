"""Runs scenarios for many plugins in parallel in a pool of cells."""

import threading
import time
from concurrent.futures import ThreadPoolExecutor

from cell import Cell
from documentation import Setup

LOG_LINES = 15  # of the driver, shown with a failure


class CellPool:
    """A pool of cells. Cells are created on demand and reused."""

    def __init__(self, count):
        self._free = [*reversed(range(count))]  # slots: the number of a cell, or the cell if it has been created
        self._busy = []  # setups of the running scenarios
        self._changed = threading.Condition()
        self._pool = ThreadPoolExecutor(count)

    def submit(self, scenario, *arguments, on_begin=lambda: None):
        """Returns the future of `scenario(cell, *arguments)`. `on_begin` is called when a cell is free for it."""
        return self._pool.submit(self._run, scenario, arguments, on_begin)

    def _run(self, scenario, arguments, on_begin):
        setup = getattr(arguments[0], "setup", Setup())
        slot = self._take(setup)
        try:
            on_begin()
            slot = self._cell_for(setup, slot)
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
            self._give_back(setup, slot)

    def _take(self, setup):
        """Returns a free slot, preferably a cell with this setup. A setup other than the default gets only one cell."""
        with self._changed:
            self._changed.wait_for(lambda: self._free and (setup == Setup() or setup not in self._busy))
            matching = [slot for slot in self._free if isinstance(slot, Cell) and slot.setup == setup]
            empty = [slot for slot in self._free if not isinstance(slot, Cell)]
            slot = [*self._free, *empty, *matching][-1]
            self._free.remove(slot)
            self._busy.append(setup)
            return slot

    def _give_back(self, setup, slot):
        with self._changed:
            self._busy.remove(setup)
            self._free.append(slot)
            self._changed.notify_all()

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
        for slot in self._free:
            if isinstance(slot, Cell):
                slot.close()


class Outcomes:
    """The results of `scenario(cell, example)` for each example, by action name."""

    def __init__(self, pool, scenario, examples):
        self._pool, self._scenario = pool, scenario
        self._examples = {example.action: example for example in examples}
        self.began = {}  # time.monotonic() at which the scenario began, by action name
        # Examples with the same setup follow each other, because another setup needs a new cell.
        ordered = sorted(examples, key=lambda example: (example.setup.controller, example.setup.parameters))
        self._futures = {example.action: self._submit(example) for example in ordered}

    def _submit(self, example):
        return self._pool.submit(self._scenario, example, on_begin=lambda: self.began.update({example.action: time.monotonic()}))

    def repeat(self, name):
        self._futures[name] = self._submit(self._examples[name])

    def get(self, name, limit=600.0):
        """Returns the result of the scenario for this action, or raises its exception."""
        return self._futures[name].result(limit)
