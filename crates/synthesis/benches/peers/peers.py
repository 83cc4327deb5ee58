"""Other programs on problems of `synthesis.rs`: `cargo xtask peers` runs this where they are installed.

    python peers.py PROBLEMS RESULTS

PROBLEMS are those that the benchmark left, RESULTS is written: a line for each run, as the benchmark leaves its own. What is not installed is told
and left out.
"""

import csv
import importlib
import sys
import time

PEERS = ["numpy"]
REPEATS = 5
# Seconds: no more repeats once so many are spent.
ENOUGH = 2.0


def read(path):
    """Lines of numbers behind what they are."""
    problems = {}
    with open(path, encoding="utf-8") as file:
        for line in file:
            what, *numbers = line.split()
            problems.setdefault(what, []).append([float(number) for number in numbers])
    return problems


def fastest(run):
    """The fastest time in seconds, and what was found."""
    best, spent, found = float("inf"), 0.0, None
    for _ in range(REPEATS):
        clock = time.perf_counter()
        found = run()
        took = time.perf_counter() - clock
        best, spent = min(best, took), spent + took
        if spent > ENOUGH:
            break
    return best, found


def main(problems_path, results_path):
    problems = read(problems_path)
    with open(results_path, "w", newline="", encoding="utf-8") as file:
        write = csv.writer(file, lineterminator="\n").writerow
        write(["case", "peer", "method", "error", "seconds"])
        for name in PEERS:
            try:
                peer = importlib.import_module(f"with_{name}")
            except ImportError as error:
                print(f"\n{name} is left out: {error}")
                continue
            print(f"\n{peer.NAME:<18} {'method':<44} {'error':>9} {'time':>14}", flush=True)
            for case, method, run, error_of, parts in peer.runs(problems):
                took, found = fastest(run)
                took, error = took / parts, error_of(found)
                print(f"{case:<18} {method:<44} {error:>9.1e} {1e3 * took:>11.3f} ms", flush=True)
                write([case, peer.NAME, method, f"{error:.3e}", f"{took:.6e}"])


if __name__ == "__main__":
    main(*sys.argv[1:])
