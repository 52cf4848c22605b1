"""Clusters of rows of eigenvectors by the tools that people use today.

    clusters.py [--repeats 3] [--seconds 60] [--memory 4] [--only NAME ...] ROWS ...

The rows are those that `EIGENSYNC_FIXTURES=FOLDER cargo bench -p clustering` writes, with eigensync's
own clusters. Two rules, each as `FIXTURE_RULE`:

- threshold: single linkage of delta e_ij = (1/m) sum_k |v_ki - v_kj|, cut at the threshold. Where an
  eigenspace has several modes eigensync measures it by its mean over bases, which is no L1 distance
  and which no peer offers: such fixtures are left out and named.
- exact: equal rows, which peers find by rounding to ten times the tolerance. Rows that differ by less
  may be torn apart by a boundary of rounding; none is in these fixtures.

Prints `fixture,implementation,seconds,clusters`, best of `--repeats`. A peer whose clusters are not
those of eigensync has no row, nor has one that takes more memory or longer than is allowed; standard
error says which. Each measurement is a process of its own, and all of them use
one thread.
"""

import argparse
import copy
import multiprocessing
import resource
import sys
import time
from pathlib import Path

import numpy as np

GIGABYTE = 2**30


class Rows:
    """Rows of components (N, m), threshold and tolerance, and eigensync's clusters by either rule."""

    def __init__(self, path):
        self.name = path.stem
        n, m, n_spaces = (int(count) for count in np.fromfile(path, dtype="<u8", count=3))
        numbers = np.fromfile(path, dtype="<f8", count=2 + n * m, offset=24)
        self.threshold, self.tolerance = numbers[:2]
        self.values = numbers[2:].reshape(n, m)
        clusters = np.fromfile(path, dtype="<u4", offset=24 + 8 * (2 + n * m)).reshape(2, n)
        self.clusters = dict(zip(("exact", "threshold"), clusters))
        self.is_plain = n_spaces == m
        # sum_k |v_ki - v_kj| at the threshold.
        self.reach = self.threshold * m

    def first(self, n):
        """The first n rows."""
        few = copy.copy(self)
        few.values = self.values[:n]
        return few


def scikit_learn_dbscan(rows):
    """DBSCAN in which every point is a core point: single linkage, by the tree it chooses."""
    from sklearn.cluster import DBSCAN

    return DBSCAN(eps=rows.reach, min_samples=1, metric="manhattan").fit_predict(rows.values)


def scikit_learn_agglomerative(rows):
    """Single linkage of all pairs, by a minimum spanning tree."""
    from sklearn.cluster import AgglomerativeClustering

    return AgglomerativeClustering(
        n_clusters=None, distance_threshold=just_above(rows), metric="manhattan", linkage="single"
    ).fit_predict(rows.values)


def scipy_ckdtree(rows):
    """All near pairs by a k-d tree, then connected components."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    pairs = cKDTree(rows.values).query_pairs(rows.reach, p=1, output_type="ndarray")
    n, ones = len(rows.values), np.ones(len(pairs), dtype=bool)
    links = coo_array((ones, (pairs[:, 0], pairs[:, 1])), shape=(n, n))
    return connected_components(links, directed=False)[1]


def scipy_linkage(rows):
    """The whole dendrogram from all pairs, cut."""
    from scipy.cluster.hierarchy import fcluster, linkage

    tree = linkage(rows.values, "single", metric="cityblock")
    return fcluster(tree, rows.reach, criterion="distance")


def fastcluster_linkage(rows):
    """The same by fastcluster, which keeps no distances."""
    import fastcluster
    from scipy.cluster.hierarchy import fcluster

    tree = fastcluster.linkage_vector(rows.values, method="single", metric="cityblock")
    return fcluster(tree, rows.reach, criterion="distance")


def numpy_unique(rows):
    """Equal rows after rounding, by sorting."""
    rounded = np.round(rows.values / (10.0 * rows.tolerance))
    return np.unique(rounded, axis=0, return_inverse=True)[1]


def just_above(rows):
    """Agglomerative clustering merges below its threshold, not at it."""
    return np.nextafter(rows.reach, np.inf)


# Each with its rule.
PEERS = [
    (scikit_learn_dbscan, "threshold"),
    (scipy_ckdtree, "threshold"),
    (fastcluster_linkage, "threshold"),
    (scikit_learn_agglomerative, "threshold"),
    (scipy_linkage, "threshold"),
    (numpy_unique, "exact"),
]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("rows", nargs="+", type=Path)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=60.0, help="longest time of a measurement")
    parser.add_argument("--memory", type=float, default=4.0, help="most gigabytes of a measurement")
    parser.add_argument("--only", nargs="*", help="names of implementations")
    arguments = parser.parse_args()
    print("fixture,implementation,seconds,clusters", flush=True)
    for path in arguments.rows:
        rows = Rows(path)
        if not rows.is_plain:
            note(rows, "threshold", "an eigenspace of several modes is no L1 distance: not compared")
        for peer, rule in PEERS:
            is_asked_for = arguments.only is None or peer.__name__ in arguments.only
            if is_asked_for and (rows.is_plain or rule == "exact"):
                measure(peer, rule, rows, arguments)


def measure(peer, rule, rows, arguments):
    """Prints a row, or says on standard error why there is none."""
    fork = multiprocessing.get_context("fork")
    queue = fork.SimpleQueue()
    process = fork.Process(target=timed, args=(peer, rule, rows, arguments, queue))
    process.start()
    process.join(arguments.seconds + 10.0)
    if process.is_alive():
        process.kill()
        process.join()
        return note(rows, peer.__name__, f"takes longer than {arguments.seconds:g} s")
    if queue.empty():
        return note(rows, peer.__name__, f"ended with status {process.exitcode}")
    best, n_clusters, problem = queue.get()
    if problem is not None:
        return note(rows, peer.__name__, problem)
    print(f"{fixture(rows.name, rule)},{peer.__name__},{best:.4g},{n_clusters}", flush=True)


def timed(peer, rule, rows, arguments, queue):
    """Puts the best time, the number of clusters and what is wrong, if anything, into the queue."""
    memory = int(arguments.memory * GIGABYTE)
    resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
    try:
        peer(rows.first(10))  # imports the library
        best, started = np.inf, time.perf_counter()
        for _ in range(arguments.repeats):
            begun = time.perf_counter()
            labels = peer(rows)
            best = min(best, time.perf_counter() - begun)
            if time.perf_counter() - started > arguments.seconds / 2.0:
                break
    except MemoryError:
        return queue.put((0.0, 0, f"takes more than {arguments.memory:g} GB"))
    except Exception as error:
        return queue.put((0.0, 0, str(error).strip() or type(error).__name__))
    n_clusters, expected = len(np.unique(labels)), rows.clusters[rule]
    # Partitions are equal when pairs of labels are as many as the clusters of either.
    joint = np.unique(np.column_stack([np.ravel(labels), expected]), axis=0)
    is_equal = len(joint) == n_clusters == len(np.unique(expected))
    problem = f"finds {n_clusters} clusters, which are not those of eigensync"
    queue.put((best, n_clusters, None if is_equal else problem))


def fixture(name, rule):
    """FIXTURE_RULE_N of FIXTURE_N, as eigensync's benchmarks are called."""
    fixture, n = name.rsplit("_", 1)
    return f"{fixture}_{rule}_{n}"


def note(rows, name, text):
    print(f"{rows.name}: {name}: {text}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
