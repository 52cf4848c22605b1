"""Leading modes of a normalized network by the eigensolvers that people use today.

    leading_modes.py [--modes 8] [--tolerance 1e-10] [--only NAME ...] NETWORK ...

The problem is S u = lambda u with S = D^-1/2 A D^-1/2: the largest eigenvalues, one at a time to the
same tolerance that eigensync is given. Networks are Matrix Market files, or `.csr` files as
`EIGENSYNC_FIXTURES=FOLDER cargo bench -p spectra` writes them. Prints
`fixture,implementation,seconds,products,residual`, best of `--repeats`; the residual is the largest
||S u - lambda u||. A library that cannot be imported is named on standard error and left out: SLEPc
may need the system's own Python (Debian: python3-slepc4py), the others `pip install scipy primme`.

Shift-invert finds the eigenvalues next to 1 + 1e-10 and counts solutions as products. No peer says
whether it lost a copy of a multiple eigenvalue: what does not agree with the others' count is a
note on standard error.
"""

import argparse
import sys
import time
from pathlib import Path

import numpy as np

SHIFT = 1.0 + 1e-10


class Problem:
    """S in compressed rows, the number of modes, and the tolerance."""

    def __init__(self, path, modes, tolerance):
        self.name, self.modes, self.tolerance = path.stem, modes, tolerance
        starts, columns, weights = read(path)
        n = self.n = len(starts) - 1
        rows = np.repeat(np.arange(n), np.diff(starts))
        scale = 1.0 / np.sqrt(np.bincount(rows, weights, n))
        self.starts, self.columns = starts.astype(np.int32), columns.astype(np.int32)
        self.values = scale[rows] * weights * scale[columns]

    def matrix(self):
        """S as a matrix of scipy.sparse."""
        from scipy.sparse import csr_array

        return csr_array((self.values, self.columns, self.starts), shape=(self.n, self.n))

    def residual(self, values, vectors):
        """The largest ||S u - lambda u|| with ||u|| = 1; vectors are columns."""
        largest = 0.0
        for value, u in zip(values, vectors.T):
            u = u / np.linalg.norm(u)
            image = np.add.reduceat(self.values * u[self.columns], self.starts[:-1])
            largest = max(largest, np.linalg.norm(image - value * u))
        return largest


def read(path):
    """Row starts, columns and weights of an adjacency matrix."""
    if path.suffix == ".csr":
        n, n_entries = np.fromfile(path, dtype="<u8", count=2)
        starts = np.fromfile(path, dtype="<u4", count=int(n) + 1, offset=16)
        columns = np.fromfile(path, dtype="<u4", count=int(n_entries), offset=16 + 4 * (int(n) + 1))
        return starts, columns, np.ones(int(n_entries))
    from scipy.io import mmread

    matrix = mmread(path).tocsr()
    return matrix.indptr, matrix.indices, matrix.data.astype(np.float64)


def scipy_eigsh(problem):
    """ARPACK through SciPy, with its own choice of basis."""
    from scipy.sparse.linalg import LinearOperator, eigsh

    matrix, spent = problem.matrix(), [0]

    def product(x):
        spent[0] += 1
        return matrix @ x

    operator = LinearOperator(matrix.shape, product, dtype=np.float64)
    return lambda: (
        *eigsh(operator, problem.modes, which="LA", tol=problem.tolerance),
        counted(spent),
    )


def scipy_shift_invert(problem):
    """ARPACK on (S - shift)^-1 through SuperLU."""
    from scipy.sparse import identity
    from scipy.sparse.linalg import LinearOperator, eigsh, splu

    def solve():
        spent = [0]
        shifted = (problem.matrix() - SHIFT * identity(problem.n)).tocsc()
        factor = splu(shifted, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})

        def solution(x):
            spent[0] += 1
            return factor.solve(x)

        inverse = LinearOperator(shifted.shape, solution, dtype=np.float64)
        arguments = {"sigma": SHIFT, "OPinv": inverse, "tol": problem.tolerance}
        return *eigsh(problem.matrix(), problem.modes, **arguments), spent[0]

    return solve


def primme_eigsh(problem):
    """PRIMME, its default method for the problem."""
    import primme

    matrix = problem.matrix()
    # PRIMME's tolerance is relative to an estimate of the norm, here 1.
    arguments = {"which": "LA", "tol": problem.tolerance, "return_stats": True}

    def solve():
        values, vectors, stats = primme.eigsh(matrix, problem.modes, **arguments)
        return values, vectors, stats["numMatvecs"]

    return solve


def slepc_krylov_schur(problem):
    """SLEPc's default, a thick-restarted Krylov-Schur method."""
    return slepc(problem, invert=False)


def slepc_shift_invert(problem):
    """The same on (S - shift)^-1 through PETSc's Cholesky factorisation."""
    return slepc(problem, invert=True)


def slepc(problem, invert):
    import slepc4py

    slepc4py.init(["leading_modes", "-log_view", ":/dev/null"])
    from petsc4py import PETSc
    from slepc4py import SLEPc

    rows = (problem.starts, problem.columns, problem.values)
    if invert:
        rows = with_diagonal(*rows)
    matrix = PETSc.Mat().createAIJ((problem.n, problem.n), csr=rows)
    matrix.setOption(PETSc.Mat.Option.SYMMETRIC, True)
    event = PETSc.Log.Event("MatSolve" if invert else "MatMult")

    def solve():
        before = event.getPerfInfo()["count"]
        solver = SLEPc.EPS().create()
        solver.setOperators(matrix)
        solver.setProblemType(SLEPc.EPS.ProblemType.HEP)
        solver.setDimensions(problem.modes)
        solver.setTolerances(problem.tolerance, 100_000)
        if invert:
            solver.setWhichEigenpairs(SLEPc.EPS.Which.TARGET_MAGNITUDE)
            solver.setTarget(SHIFT)
            transformation = solver.getST()
            transformation.setType(SLEPc.ST.Type.SINVERT)
            transformation.getKSP().setType("preonly")
            transformation.getKSP().getPC().setType("cholesky")
            transformation.getKSP().getPC().setFactorOrdering("nd")
        else:
            solver.setWhichEigenpairs(SLEPc.EPS.Which.LARGEST_REAL)
        solver.solve()
        n_converged = min(solver.getConverged(), problem.modes)
        if n_converged < problem.modes:
            raise RuntimeError(f"{n_converged} of {problem.modes} modes converged")
        u = matrix.createVecRight()
        values, vectors = [], []
        for k in range(n_converged):
            values.append(solver.getEigenpair(k, u).real)
            vectors.append(u.getArray().copy())
        products = event.getPerfInfo()["count"] - before
        return np.array(values), np.array(vectors).T, int(products)

    return solve


def with_diagonal(starts, columns, values):
    """The same matrix with its zero diagonal stored: PETSc's factorisations need the places."""
    n = len(starts) - 1
    rows = np.repeat(np.arange(n, dtype=np.int32), np.diff(starts))
    every = np.arange(n, dtype=np.int32)
    rows, columns = np.concatenate([rows, every]), np.concatenate([columns, every])
    order = np.lexsort((columns, rows))
    starts = (starts + np.arange(n + 1)).astype(np.int32)
    return starts, columns[order], np.concatenate([values, np.zeros(n)])[order]


def counted(spent):
    """Products since the last call."""
    products, spent[0] = spent[0], 0
    return products


PEERS = [scipy_eigsh, scipy_shift_invert, primme_eigsh, slepc_krylov_schur, slepc_shift_invert]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("networks", nargs="+", type=Path)
    parser.add_argument("--modes", type=int, default=8)
    parser.add_argument("--tolerance", type=float, default=1e-10)
    parser.add_argument("--repeats", type=int, default=1)
    parser.add_argument("--only", nargs="*", help="names of implementations")
    arguments = parser.parse_args()
    print("fixture,implementation,seconds,products,residual")
    for path in arguments.networks:
        problem = Problem(path, arguments.modes, arguments.tolerance)
        for peer in PEERS:
            if arguments.only is None or peer.__name__ in arguments.only:
                measure(peer, problem, arguments.repeats)


def measure(peer, problem, repeats):
    """Prints a row, or says on standard error why there is none."""
    try:
        solve, best = peer(problem), np.inf
        for _ in range(repeats):
            started = time.perf_counter()
            values, vectors, products = solve()
            best = min(best, time.perf_counter() - started)
    except Exception as error:
        print(f"{problem.name}: {peer.__name__}: {error}", file=sys.stderr)
        return
    residual = problem.residual(values, vectors)
    print(f"{problem.name},{peer.__name__},{best:.4g},{products},{residual:.1e}", flush=True)
    listed = " ".join(f"{value - 1.0:.9e}" for value in sorted(values, reverse=True))
    print(f"{problem.name}: {peer.__name__}: lambda = {listed}", file=sys.stderr)


if __name__ == "__main__":
    main()
