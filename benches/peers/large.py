"""Runs the peers of leading modes and of clusters on large networks, for `run.py`.

Each peer has a process of its own for every fixture, with the whole processor for leading modes, on
one core and with one thread for clusters, as eigensync has; one that takes longer than allowed is stopped and named in the notes. OUT/leading_modes.csv and OUT/clusters.csv get
their rows.
"""

import os
import re
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
THREADS = ["OMP", "OPENBLAS", "MKL", "NUMBA", "BLIS", "VECLIB_MAXIMUM"]
ONE_THREAD = {f"{library}_NUM_THREADS": "1" for library in THREADS}
MODES_PEERS = ["scipy_eigsh", "scipy_shift_invert", "primme_eigsh"]
SLEPC_PEERS = ["slepc_krylov_schur", "slepc_shift_invert"]
CLUSTERS_PEERS = [
    "scikit_learn_dbscan",
    "scipy_ckdtree",
    "fastcluster_linkage",
    "scikit_learn_agglomerative",
    "scipy_linkage",
    "numpy_unique",
]


def leading_modes(networks, python, options, notes):
    """Eight modes, or as many as the name of a network says, by each peer."""
    peers = [(peer, python, {}) for peer in MODES_PEERS]
    if (found := slepc()) is None:
        notes.append("SLEPc is not measured: no Python here has slepc4py (Debian: python3-slepc4py)")
    else:
        peers += [(peer, *found) for peer in SLEPC_PEERS]
    rows = []
    for network in networks:
        modes = re.search(r"_(\d+)_modes_", network.name)
        arguments = ["--modes", modes[1] if modes else "8", network]
        for peer, interpreter, environment in peers:
            command = [interpreter, HERE / "leading_modes.py", *arguments, "--only", peer]
            rows += measure(command, environment, network, peer, options, notes)
    write(options.out / "leading_modes.csv", "fixture,implementation,seconds,products,residual", rows)


def clusters(files, python, options, notes):
    """Clusters of these rows by each peer."""
    rows = []
    for file in files:
        for peer in CLUSTERS_PEERS:
            command = [python, HERE / "clusters.py", file, "--only", peer]
            command += ["--seconds", options.longest]
            core = int(options.core)
            rows += measure(command, ONE_THREAD, file, peer, options, notes, core)
    write(options.out / "clusters.csv", "fixture,implementation,seconds,clusters", rows)


def measure(command, environment, file, peer, options, notes, core=None):
    """The rows that a peer prints, without their head; what it has to say goes to the notes."""
    print(f"peers: {peer} on {file.stem}", file=sys.stderr, flush=True)
    longest = float(options.longest) + 30.0
    may_pin = core is not None and hasattr(os, "sched_setaffinity")
    on_core = lambda: may_pin and os.sched_setaffinity(0, {core})
    try:
        done = subprocess.run(
            command,
            capture_output=True,
            text=True,
            check=False,
            timeout=longest,
            preexec_fn=on_core,
            env=os.environ | {"PYTHONDONTWRITEBYTECODE": "1"} | environment,
        )
    except subprocess.TimeoutExpired:
        notes.append(f"{file.stem}: {peer}: takes longer than {longest:g} s")
        return []
    said = [line for line in done.stderr.splitlines() if line.startswith(f"{file.stem}: ")]
    notes += [line for line in dict.fromkeys(said) if "lambda = " not in line and line not in notes]
    rows = done.stdout.splitlines()[1:]
    if not rows and not said:
        notes.append(f"{file.stem}: {peer}: {(done.stderr.strip() or 'no answer').splitlines()[-1]}")
    return rows


def slepc():
    """A Python that has slepc4py, with the variables it needs; None where there is none."""
    folders = {}
    for library in ["slepc", "petsc"]:
        places = sorted(Path(f"/usr/lib/{library}dir").glob("*/*-real"))
        if places:
            folders[f"{library.upper()}_DIR"] = str(places[-1])
    for python in ["python3", "/usr/bin/python3"]:
        for environment in [{}, folders]:
            probe = [python, "-c", "import numpy, slepc4py; from slepc4py import SLEPc"]
            try:
                done = subprocess.run(
                    probe, capture_output=True, check=False, env=os.environ | environment
                )
            except OSError:
                continue
            if done.returncode == 0:
                return python, environment
    return None


def write(path, head, rows):
    if rows:
        path.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
