"""For how long the host did not let the threads of programs run, although they were ready to: the scheduler's own measurement."""

import os
from typing import Dict, Sequence

HAND_OVERS = 2  # threads of a program, one after the other, between a request and what it does


class Stalls:
    """Measures from its construction on. The delays of the most delayed threads of each process are summed up, as if one had waited for
    the other."""

    def __init__(self, processes: Sequence[int]):
        self._begin = {process: self._delays(process) for process in processes}

    @staticmethod
    def _delays(process: int) -> Dict[str, int]:
        """ns, by thread."""
        delays: Dict[str, int] = {}
        try:
            threads = os.listdir(f"/proc/{process}/task")
        except OSError:
            return delays  # the process has ended
        for thread in threads:
            try:
                with open(f"/proc/{process}/task/{thread}/schedstat") as file:
                    delays[thread] = int(file.read().split()[1])
            except OSError:
                continue
        return delays

    def seconds(self) -> float:
        total = 0
        for process, begin in self._begin.items():
            delays = sorted(delay - begin.get(thread, 0) for thread, delay in self._delays(process).items())
            total += sum(delays[-HAND_OVERS:])
        return 1e-9 * total
