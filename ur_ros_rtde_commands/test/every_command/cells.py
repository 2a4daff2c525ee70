"""Several cells at once, and the outcomes of one scenario for many plugins, worked out side by side in them."""

import queue
from concurrent.futures import ThreadPoolExecutor

from cell import Cell
from documentation import Setup

LOG_LINES = 15  # of the driver's, with a failure


class Cells:
    """Cells are built when they are needed, and kept."""

    def __init__(self, count):
        self._places = queue.LifoQueue()  # a number, or the cell that was built there
        for number in reversed(range(count)):
            self._places.put(number)
        self._pool = ThreadPoolExecutor(count)

    def submit(self, scenario, *arguments):
        return self._pool.submit(self._run, scenario, arguments)

    def _run(self, scenario, arguments):
        place = self._places.get()
        try:
            place = self._cell_for(getattr(arguments[0], "setup", Setup()), place)
            outcome = self._carry_out(scenario, place, arguments)
            if hasattr(arguments[0], "action"):
                place.client.destroy_action_client(arguments[0].action)
            return outcome
        except Exception:
            # A cell in which something went wrong is not used again: it must not spoil the next plugin's outcome.
            if isinstance(place, Cell):
                place.close()
                place = place.number
            raise
        finally:
            self._places.put(place)

    @staticmethod
    def _cell_for(setup, place):
        if isinstance(place, Cell):
            if place.setup == setup:
                return place
            place.close()
            place = place.number
        return Cell(place, setup)

    @staticmethod
    def _carry_out(scenario, cell, arguments):
        driver, begin = cell.driver, len(cell.driver.lines)
        try:
            return scenario(cell, *arguments)
        except Exception as error:
            log = "\n    ".join(cell.driver.lines[begin if cell.driver is driver else 0:][-LOG_LINES:])
            raise AssertionError(f"{type(error).__name__}: {error}\nthe driver's last lines:\n    {log}") from error

    def close(self):
        self._pool.shutdown(wait=True, cancel_futures=True)
        while not self._places.empty():
            place = self._places.get()
            if isinstance(place, Cell):
                place.close()


class Outcomes:
    """Of `scenario(cell, example)` for each of the examples, by the action's name."""

    def __init__(self, cells, scenario, examples):
        self._futures = {example.action: cells.submit(scenario, example) for example in examples}

    def of(self, name, limit=600.0):
        """What the scenario returned for that action; raises what it raised."""
        return self._futures[name].result(limit)
