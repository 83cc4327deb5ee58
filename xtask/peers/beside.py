"""What the scripts that run peers beside a benchmark have in common: `cargo xtask peers` puts it where they find it."""

import contextlib
import csv
import importlib
import time


@contextlib.contextmanager
def results(path):
    """What writes a line for each run, as the benchmarks of Kempe leave them."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        write = csv.writer(file, lineterminator="\n").writerow
        write(["case", "peer", "method", "error", "seconds"])
        yield write


def installed(names):
    """The modules of those peers that are there; what is not is told and left out."""
    for name in names:
        try:
            yield importlib.import_module(f"with_{name}")
        except ImportError as error:
            print(f"\n{name} is left out: {error}")


def fastest(run, repeats, enough):
    """The fastest time in seconds, and what was found; no more repeats once so many seconds are spent."""
    best, spent, found = float("inf"), 0.0, None
    for _ in range(repeats):
        clock = time.perf_counter()
        found = run()
        took = time.perf_counter() - clock
        best, spent = min(best, took), spent + took
        if spent > enough:
            break
    return best, found
