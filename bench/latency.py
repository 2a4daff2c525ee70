"""Latency from a package of the controller to a subscriber, from received messages and the simulator's trace.

The stamp of a message is the time at which the driver received the package: the package is the last one sent before it.
"""

import bisect

# The stamp is derived from a monotonic clock; the two clocks are read one after the other.
CLOCK_TOLERANCE = 20_000  # ns


def percentile(values, fraction):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(fraction * len(ordered)))]


def _package(sent, stamp):
    """Returns the index of the package to which a message with this stamp belongs, in the times of all packages; or -1."""
    return bisect.bisect_right(sent, stamp + CLOCK_TOLERANCE) - 1


def _sent(trace):
    return [published for _, published, *_ in trace["cycles"]]


def latencies(received, trace):
    """Returns the latencies in ms of messages [(stamp, time of reception)] in ns, without those that are older than the trace."""
    sent = _sent(trace)
    packages = ((_package(sent, stamp), when) for stamp, when in received)
    return [(when - sent[index]) * 1e-6 for index, when in packages if index >= 0]


def missing_percent(received, trace):
    """Returns the percentage of the packages from the first to the last message that no message belongs to."""
    sent = _sent(trace)
    packages = {index for index in (_package(sent, stamp) for stamp, _ in received) if index >= 0}
    return 100.0 * (1.0 - len(packages) / (max(packages) - min(packages) + 1)) if packages else 0.0
