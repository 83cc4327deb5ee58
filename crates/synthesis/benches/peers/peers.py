"""Other programs on problems of `synthesis.rs`: `cargo xtask peers` runs this where they are installed.

    python peers.py PROBLEMS RESULTS

PROBLEMS are those that the benchmark left, RESULTS is written: a line for each run, as the benchmark leaves its own. What is not installed is told
and left out.
"""

import sys

from beside import fastest, installed, results

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


def main(problems_path, results_path):
    problems = read(problems_path)
    with results(results_path) as write:
        for peer in installed(PEERS):
            print(f"\n{peer.NAME:<18} {'method':<44} {'error':>9} {'time':>14}", flush=True)
            for case, method, run, error_of, parts in peer.runs(problems):
                took, found = fastest(run, REPEATS, ENOUGH)
                took, error = took / parts, error_of(found)
                print(f"{case:<18} {method:<44} {error:>9.1e} {1e3 * took:>11.3f} ms", flush=True)
                write([case, peer.NAME, method, f"{error:.3e}", f"{took:.6e}"])


if __name__ == "__main__":
    main(*sys.argv[1:])
