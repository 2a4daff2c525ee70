"""Tables at the end of a run."""

from collections import Counter

from ur_tools.percentile import percentile


def faults(recoveries):
    """Formats the recoveries by fault: s from the end of the fault until a motion was accepted; None if a motion continued."""
    if not recoveries:
        return []
    rows = [f"    {'fault':24} {'count':>5} {'recovery p50':>13} {'max':>9}"]
    for name, recovery_times in sorted(recoveries.items()):
        seconds = [value for value in recovery_times if value is not None]
        figures = f"{percentile(seconds, 0.5):11.3f} s {max(seconds):7.3f} s" if seconds else f"{'-':>13} {'-':>9}"
        rows.append(f"    {name:24} {len(recovery_times):5} {figures}")
    return rows


def goals(outcomes):
    total: Counter[str] = Counter()
    for outcome in outcomes:
        total += outcome
    return [f"    {'goals':32} {sum(total.values()):6}"] + [f"      {name:30} {count:6}" for name, count in total.most_common()]
