"""Other programs on the benchmarks of `simulate.rs`: `cargo xtask peers` runs this where they are installed.

    python peers.py KNOWN RESULTS

KNOWN says what the benchmarks come to, RESULTS is written: a line for each run, as the benchmarks of Kempe leave them. Models are built
before the clock starts; the fastest of several runs counts. What is not installed is told and left out.
"""

import csv
import math
import sys
import time

from beside import installed, results

PEERS = ["exudyn", "scipy"]
REPEATS = 5
# Seconds: no more repeats once so many are spent, and no finer run where it would take longer than this.
ENOUGH = 2.0
LONGEST = 10.0
# How much longer the next finer run takes, about.
FINER = 2.0


def read_known(path):
    """What each case comes to: the time, and value and rate of its first drive then."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        return {row["case"]: tuple(float(row[key]) for key in ("until", "value", "rate")) for row in rows}


def error_of(found, value, rate):
    """The larger of the relative errors of an angle, to whole turns, and of its rate."""
    off = found[0] - value
    off -= round(off / math.tau) * math.tau
    return max(abs(off / value), abs((found[1] - rate) / rate))


def best(run):
    """The fastest time in seconds, and what was found or, of what gave no motion, the reason why."""
    fastest, spent, found = math.inf, 0.0, "no motion"
    for _ in range(REPEATS):
        clock = time.perf_counter()
        try:
            found = run() or found
        except Exception as error:  # whatever a peer does, the others are heard
            found = type(error).__name__
        took = time.perf_counter() - clock
        fastest, spent = min(fastest, took), spent + took
        if isinstance(found, str) or spent > ENOUGH:
            break
    if not isinstance(found, str) and not all(math.isfinite(x) for x in found):
        found = "not finite"
    return fastest, found


def tell(peer, known, write):
    """Runs all cases that a peer has a model of."""
    for case, (until, value, rate) in known.items():
        if case not in peer.CASES:
            continue
        for way in peer.runs(case, until):
            for method, run in way:
                took, found = best(run)
                told = f"{case:<18} {method:<38}"
                if isinstance(found, str):
                    print(f"{told} {'failed':>9} {1e3 * took:>11.3f} ms  {found}", flush=True)
                else:
                    error = error_of(found, value, rate)
                    print(f"{told} {error:>9.1e} {1e3 * took:>11.3f} ms", flush=True)
                    write([case, peer.NAME, method, f"{error:.3e}", f"{took:.6e}"])
                if FINER * took > LONGEST:
                    break


def main(known_path, results_path):
    known = read_known(known_path)
    with results(results_path) as write:
        for peer in installed(PEERS):
            print(f"\n{peer.NAME:<18} {'method':<38} {'error':>9} {'time':>14}")
            tell(peer, known, write)


if __name__ == "__main__":
    main(*sys.argv[1:])
