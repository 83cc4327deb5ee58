"""Other programs on problems of `optimize.rs`: `cargo xtask peers` runs this where they are installed.

    python peers.py RUNS RESULTS

RUNS are Kempe's, which tell the cases; RESULTS is written: a line for each run, as the benchmark leaves its own. What is not installed is told and left
out. Fronts stand in no table of errors: the part of the analytic volume under them is printed, as the benchmark prints its own.
"""

import csv
import sys

from beside import fastest, installed, results

PEERS = ["scipy", "pymoo"]
REPEATS = 10
# Seconds: no more repeats once so many are spent.
ENOUGH = 1.0


def main(runs_path, results_path):
    with open(runs_path, newline="", encoding="utf-8") as file:
        cases = [row["case"] for row in csv.DictReader(file)]
    with results(results_path) as write:
        for peer in installed(PEERS):
            print(f"\n{peer.NAME}", flush=True)
            for case, method, run, told in peer.runs(cases):
                took, found = fastest(run, REPEATS, ENOUGH)
                words, error = told(found)
                shown = f"error {error:8.1e}" if error is not None else " " * 15
                print(f"{case:<8} {method:<12} {words:<44} {shown} {1e3 * took:>10.3f} ms", flush=True)
                if error is not None:
                    write([case, peer.NAME, f"{method}, {words}", f"{error:.3e}", f"{took:.6e}"])


if __name__ == "__main__":
    main(*sys.argv[1:])
