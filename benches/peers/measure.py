"""Runs every peer as a process of its own on one core, checks it, and writes OUT/peers.csv.

Started by `run.py` in the environment it has made. A row is written only when x at time 1 agrees
with `reference.py` in all replicas; a peer that fails, disagrees or takes too long is named in
OUT/notes.txt. eigensync is held to the same reference, by the errors in the fixture file.
"""

import argparse
import csv
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

import reference
import scipy_solve_ivp
from peer import STEP, Control, Fixture

HERE = Path(__file__).resolve().parent
FIXTURES = ["communities90", "cortex989"]
ENSEMBLE = 16
# Script, replicas at once, controls of the step.
PYTHON_PEERS = [
    ("numpy_rk4.py", [1, ENSEMBLE], [None]),
    ("numba_rk4.py", [1, ENSEMBLE], [None]),
    ("scipy_solve_ivp.py", [1, ENSEMBLE], ["fixed", "1e-6", "1e-8"]),
    ("jitcode_adaptive.py", [1], ["fixed", "1e-6", "1e-8"]),
    ("heyoka_taylor.py", [1, ENSEMBLE], ["1e-6", "1e-8"]),
]
# How far x at time 1 may be from the reference: steps of the same length, or of their own.
AGREES, AGREES_ADAPTIVE = 1e-6, 1e-4
# eigensync and the reference do the same operations in another order.
AGREES_TO_ROUNDING = 1e-11
LONGEST = 900  # seconds that a peer may take in all
ONE_THREAD = ["OMP", "OPENBLAS", "MKL", "NUMBA", "BLIS", "VECLIB_MAXIMUM"]
COLUMNS = "fixture,implementation,lanes,node_steps_per_s,largest_error_at_1,seconds_to_start"


class Refused(Exception):
    """Why a peer has no row."""


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for folder in ["fixtures", "work", "out"]:
        arguments.add_argument(folder, type=Path)
    for option in ["--core", "--seconds", "--repeats", "--only"]:
        arguments.add_argument(option)
    arguments.add_argument("programs", nargs="*", type=Path, help="the C++ peers")
    options = arguments.parse_args()
    peers = [
        ([sys.executable, HERE / script], lanes, controls)
        for script, lanes, controls in PYTHON_PEERS
    ]
    peers += [([program], [1], [None]) for program in options.programs]
    wanted = options.only.split(",")
    peers = [peer for peer in peers if any(text in peer[0][-1].name for text in wanted)]
    rows, notes, errors = [], [], []
    for name in FIXTURES:
        fixture = Fixture(options.fixtures / f"{name}.txt", ENSEMBLE)
        expected = Expected(fixture)
        notes += [f"{name}: {note}" for note in expected.notes(fixture)]
        errors += [[name, *line] for line in expected.errors_of_methods(fixture)]
        for command, lanes, controls in peers:
            for n_replicas in lanes:
                for control in controls:
                    what = f"{command[-1].name} on {name}, {n_replicas} at once, {control or 'RK4'}"
                    progress(what)
                    try:
                        row = measure(command, name, n_replicas, control, expected, options)
                    except Refused as reason:
                        notes.append(f"{what}: {reason}")
                        progress(f"no row: {reason}")
                    else:
                        progress(f"    {row[1]}: {row[3] / 1e6:.2f} million node-steps/s")
                        rows.append(row)
    with open(options.out / "peers.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS.split(","))
        writer.writerows(rows)
    with open(options.out / "errors.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow("fixture,method,order,step,largest_error_at_1".split(","))
        writer.writerows(errors)
    with open(options.out / "notes.txt", "a", encoding="utf-8") as file:
        file.writelines(f"{note}\n" for note in notes)


def measure(command, name, n_replicas, control, expected, options):
    """A row of the table: see COLUMNS."""
    check = options.work / "check.txt"
    check.unlink(missing_ok=True)
    fixture = (options.fixtures / f"{name}.txt").resolve()
    line = [*pinned(options.core), *command, fixture, n_replicas, options.seconds, options.repeats]
    line += [check.resolve(), *([control] if control else [])]
    one_thread = {f"{library}_NUM_THREADS": "1" for library in ONE_THREAD}
    try:
        done = subprocess.run(
            [str(word) for word in line],
            capture_output=True,
            text=True,
            check=False,
            timeout=LONGEST,
            env=os.environ | one_thread,
        )
    except subprocess.TimeoutExpired:
        raise Refused(f"not done after {LONGEST} s") from None
    if done.returncode != 0:
        said = done.stderr.strip().splitlines() or [f"exit status {done.returncode}"]
        raise Refused(said[-1])
    result = json.loads(done.stdout.splitlines()[-1])
    x = np.loadtxt(check, ndmin=2)
    adaptive = control is not None and Control(control).tolerance is not None
    allowed = AGREES_ADAPTIVE if adaptive else AGREES
    away = np.abs(x - expected.x[:n_replicas]).max()
    if not away <= allowed:
        raise Refused(
            f"x at time 1 is {away:.1e} away from the reference; allowed is {allowed:.0e}"
        )
    error = np.abs(x - expected.exact[:n_replicas]).max()
    speed, start = result["node_steps_per_s"], result["seconds_to_start"]
    return name, result["name"], n_replicas, round(speed), f"{error:.1e}", f"{start:.1f}"


class Expected:
    """What all must obtain at time 1 from a fixture, (L, N): x of the reference and the exact x."""

    def __init__(self, fixture):
        advance, x = scipy_solve_ivp.make(fixture, Control("1e-13"))
        advance(1.0)
        self.exact = x()
        orbits = [reference.orbit(fixture, m, 100) for m in range(ENSEMBLE)]
        self.x = np.array([orbit[-1] for orbit in orbits])
        self.errors = np.array([np.abs(x - x[:, :1]).mean(axis=0) for x in orbits])

    def errors_of_methods(self, fixture):
        """Of eigensync's methods at some steps: name, order, step, largest error of x at time 1."""
        methods = [
            ("rk4", 4, reference.rk4, [100, 50, 20]),
            ("dop853", 8, reference.dop853, [12, 10, 8, 7, 6]),
        ]
        for method, order, step, numbers in methods:
            for n_steps in numbers:
                ends = [
                    reference.orbit(fixture, m, n_steps, 1 / n_steps, step)[-1]
                    for m in range(ENSEMBLE)
                ]
                error = np.abs(np.array(ends) - self.exact).max()
                yield method, order, f"{1 / n_steps:.6g}", f"{error:.2e}"

    def notes(self, fixture):
        """Whether eigensync agrees."""
        away = np.abs(fixture.errors - self.errors).max()
        if not away <= AGREES_TO_ROUNDING:
            sys.exit(f"eigensync disagrees with the reference: its errors are {away:.1e} away")
        yield f"eigensync agrees with the reference: its errors over 100 steps are {away:.0e} away"


def pinned(core):
    """What keeps a program on one core, where the system has it."""
    return ["taskset", "-c", core] if shutil.which("taskset") else []


def progress(text):
    print(f"peers: {text}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
