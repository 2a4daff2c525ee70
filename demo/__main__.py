"""Runs the force experiment. Ctrl-C ends it without a traceback, even while its libraries are being imported."""

import signal
import sys


def main() -> int:
    try:
        import force_experiment
        return int(force_experiment.main())
    except KeyboardInterrupt:
        return 128 + signal.SIGINT


if __name__ == "__main__":
    sys.exit(main())
