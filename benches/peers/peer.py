"""What all Python peers share: the work to do, how it is timed, and what is handed back.

The work is one network of Hindmarsh-Rose neurons,

    x' = y + x^2 (3 - x) - z + I + epsilon sum_j w_ij x_j
    y' = 1 - 5 x^2 - y
    z' = r (s (x + 1.6) - z)

whose matrix, couplings and initial states stand in a fixture file (`benches/fixtures` says how).
A peer is called as `peer.py FIXTURE REPLICAS SECONDS REPEATS CHECK [CONTROL]`: it advances the first
REPLICAS replicas, writes their x at time 1 to CHECK, and prints its name and speed as JSON.
"""

import json
import sys
import time

import numpy as np

STEP = 0.01
R, S, CURRENT = 0.006, 4.0, 3.2
# Adaptive methods are timed over this much model time at least, so that each neuron bursts several
# times: in the pauses between bursts their steps are far longer.
SEVERAL_BURSTS = 200.0


class Fixture:
    """Matrix W in compressed rows, couplings (L) and initial states (L, 3, N) of L replicas."""

    def __init__(self, path, n_replicas):
        with open(path, encoding="ascii") as file:
            lines = iter(file.readlines())
        floats = lambda: np.array(next(lines).split(), dtype=np.float64)
        integers = lambda: np.array(next(lines).split(), dtype=np.uint32)
        self.n_nodes, _, n_all = (int(number) for number in next(lines).split())
        self.starts, self.columns, self.weights = integers(), integers(), floats()
        self.epsilon = floats()[:n_replicas]
        self.states = floats().reshape(n_all, 3, self.n_nodes)[:n_replicas]
        # eigensync's own <|x_i - x_0|>, (L, N), over the first 100 steps.
        self.errors = floats().reshape(n_all, self.n_nodes)[:n_replicas]
        if len(self.epsilon) != n_replicas:
            raise ValueError(f"{path} holds {n_all} replicas, not {n_replicas}")

    def sparse_matrix(self):
        """W as a matrix of scipy.sparse."""
        from scipy.sparse import csr_array

        rows = (self.weights, self.columns, self.starts)
        return csr_array(rows, shape=(self.n_nodes, self.n_nodes))


def run(name, make, *, single=False):
    """Checks and times a peer with a fixed step, called `name`.

    `make(fixture)` gives `(advance, x)`: `advance(duration)` goes on by that model time from where
    it stands, `x()` is the x of all nodes there, shape (L, N). A `single` peer advances one replica.
    """
    measure(name, make, 1.0, single)


def run_adaptive(name, make, *, single=False):
    """The same with a method that chooses its own step, called `name(control)`.

    `make(fixture, control)` is given the `Control` of the step. Counted are the fixed steps that
    its model time would have taken.
    """
    control = Control(sys.argv[6])
    shortest = 1.0 if control.tolerance is None else SEVERAL_BURSTS
    with_control = lambda fixture: make(fixture, control)
    measure(f"{name(control)} {control}", with_control, shortest, single)


class Control:
    """How a step is chosen: by a relative and absolute tolerance, or held at STEP."""

    def __init__(self, text):
        self.tolerance = None if text == "fixed" else float(text)

    def __str__(self):
        if self.tolerance is None:
            return f"at step {STEP}"
        return f"at tolerance {self.tolerance:.0e}".replace("e-0", "e-")

    def is_strict(self):
        """Whether methods of higher order are the better choice, by their manuals and in fact."""
        return self.tolerance is not None and self.tolerance < 1e-7

    def options(self):
        """For SciPy and what is built on it. A step at STEP is one that no error makes shorter."""
        if self.tolerance is None:
            return {"first_step": STEP, "max_step": STEP, "rtol": 1e3, "atol": 1e3}
        return {"rtol": self.tolerance, "atol": self.tolerance}


def measure(name, make, shortest, single):
    """Advances to time 1, hands back x, and times stretches of the `shortest` model time or more."""
    path, n_replicas, seconds, repeats, check = sys.argv[1:6]
    n_replicas, seconds, repeats = int(n_replicas), float(seconds), int(repeats)
    if single and n_replicas != 1:
        sys.exit("this peer advances one replica at a time")
    fixture = Fixture(path, n_replicas)
    started = time.perf_counter()
    advance, x = make(fixture)
    advance(1.0)
    ready = time.perf_counter() - started
    np.savetxt(check, x().reshape(n_replicas, fixture.n_nodes), fmt="%.17g")
    speed = n_replicas * fixture.n_nodes * best_speed(advance, shortest, seconds, repeats)
    if not np.isfinite(x()).all():
        sys.exit("the states are no longer numbers")
    print(json.dumps({"name": name, "node_steps_per_s": speed, "seconds_to_start": ready}))


def best_speed(advance, shortest, seconds, repeats):
    """Steps a second of processor time in the best of `repeats` stretches of at least `seconds`."""
    duration = shortest
    while (spent := timed(advance, duration)) < seconds:
        duration *= min(8.0, max(2.0, 1.2 * seconds / max(spent, 1e-6)))
    best = min([spent, *(timed(advance, duration) for _ in range(repeats - 1))])
    return duration / STEP / best


def timed(advance, duration):
    """Processor time of one stretch: what other programs take does not count against a peer."""
    started = time.process_time()
    advance(duration)
    return time.process_time() - started


def steps(duration):
    """Fixed steps in a stretch of model time."""
    return round(duration / STEP)
