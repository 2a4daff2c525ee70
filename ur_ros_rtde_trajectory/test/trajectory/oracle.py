"""Compares the durations of this project's trajectories with independent time-optimal solvers on the same paths.

    trajectory_export paths.bin 0 100 1 0.02 && python3 oracle.py paths.bin        # with jerk limits, against copp-py
    trajectory_export paths.bin 0 100 0 0.005 && python3 oracle.py paths.bin       # without, against toppra

Requires numpy and copp-py or toppra. Prints one line per path, and the median and the maximum of the ratios.
"""

import logging
import sys

import numpy as np


def paths(name):
    data = np.fromfile(name)
    at = 0

    def take(count):
        nonlocal at
        at += count
        return data[at - count:at]

    while at < len(data):
        seed, count = take(2).astype(int)
        limits = take(18).reshape(3, 6)
        blocks = []
        for _ in range(count):
            stations = int(take(1)[0])
            duration = take(1)[0]
            blocks.append((duration, take(20 * stations).reshape(stations, 20)))
        yield seed, limits, blocks


def with_jerk(limits, rows):
    """Solves successive convex programs around the exported speeds until the duration converges."""
    import copp_py as copp

    # The path parameter is scaled to about 0.01 between stations, so that the solver's variables have similar magnitudes.
    unit = 0.01 * len(rows) / (rows[-1, 0] - rows[0, 0])
    s = (rows[:, 0] - rows[0, 0]) * unit
    d1, d2, d3 = (np.ascontiguousarray(rows[:, k:k + 6]) / unit ** n for n, k in enumerate((2, 8, 14), 1))
    robot = copp.Robot(6, capacity=len(s))
    robot.append_s(s)
    robot.set_q(d1, d1, d2, 0, dddq=d3)
    robot.add_velocity_limits(limits[0], -limits[0], start_idx_s=0)
    robot.add_acceleration_limits(limits[1], -limits[1], start_idx_s=0)
    robot.add_jerk_limits(limits[2], -limits[2], start_idx_s=0)
    a = np.maximum(rows[:, 1] * unit ** 2, 1e-9)
    best = np.inf
    for _ in range(5):
        profile = None
        for solver in (copp.solver.topp3_socp, copp.solver.topp3_lp):
            problem = solver.Problem(robot.constraints, a, idx_s_start=0, a_boundary=(0.0, 0.0),
                                     b_boundary=(0.0, 0.0), num_stationary_max=1)
            try:
                profile = solver.solve(problem, copp.clarabel.Options(allow_almost_solved=True))
                break
            except Exception:  # a numerical failure of the solver; the other formulation may succeed
                continue
        if profile is None:
            break
        result = copp.interpolation.s_to_t_topp3(s, profile, 0.0)
        duration = result[0] if isinstance(result, tuple) else np.asarray(result).ravel()[-1]
        if duration > best * 0.9999:
            best = min(best, duration)
            break
        best = duration
        a = np.maximum(profile.a, 1e-9)
    return best


def without_jerk(limits, rows):
    import toppra
    from toppra.interpolator import AbstractGeometricPath

    logging.getLogger("toppra").setLevel(logging.ERROR)

    class Stations(AbstractGeometricPath):
        def __call__(self, position, order=0):
            columns = {0: slice(2, 8), 1: slice(2, 8), 2: slice(8, 14)}[order]
            index = np.searchsorted(rows[:, 0], np.asarray(position) - 1e-12)
            return rows[np.clip(index, 0, len(rows) - 1)][..., columns]

        @property
        def dof(self):
            return 6

        @property
        def path_interval(self):
            return rows[[0, -1], 0]

        @property
        def waypoints(self):
            return None

    path = Stations()
    constraints = [
        toppra.constraint.JointVelocityConstraint(np.stack([-limits[0], limits[0]], 1)),
        toppra.constraint.JointAccelerationConstraint(np.stack([-limits[1], limits[1]], 1)),
    ]
    solver = toppra.algorithm.TOPPRA(constraints, path, gridpoints=rows[:, 0], solver_wrapper="seidel")
    _, speeds, _ = solver.compute_parameterization(0, 0)
    if speeds is None:
        return np.inf
    return float(np.sum(2 * np.diff(rows[:, 0]) / (speeds[1:] + speeds[:-1])))


def main():
    ratios = []
    for seed, limits, blocks in paths(sys.argv[1]):
        solve = with_jerk if np.isfinite(limits[2]).any() else without_jerk
        ours = sum(duration for duration, _ in blocks)
        best = sum(solve(limits, rows) for _, rows in blocks)
        if np.isfinite(best):
            ratios.append(ours / best)
            print(f"seed {seed}  blocks {len(blocks)}  stations {sum(len(r) for _, r in blocks)}  "
                  f"ours {ours:.4f} s  oracle {best:.4f} s  ratio {ours / best:.4f}", flush=True)
        else:
            print(f"seed {seed}  blocks {len(blocks)}  oracle found no solution")
    ratios = np.array(ratios)
    if not len(ratios):
        return
    print(f"{len(ratios)} paths: median {np.median(ratios):.4f}, 95 % {np.quantile(ratios, .95):.4f}, "
          f"worst {ratios.max():.4f}")


if __name__ == "__main__":
    main()
