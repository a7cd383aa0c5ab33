#!/usr/bin/env python3
"""Holds two outputs of multires_result_hashes side by side.

    scripts/compare_hashes.py REFERENCE OTHER SYSTEM

Prints what differs, by filter, and ends with 1 if more does than tests/portable/differences.txt knows of the system.
"""

import collections
import csv
import pathlib
import sys

KNOWN = pathlib.Path(__file__).resolve().parent.parent / "tests/portable/differences.txt"


def read(path):
    """(mesh, filter, options) -> hashes, or why it was refused."""
    with open(path, newline="") as file:
        return {tuple(row[:3]): ",".join(row[3:]) for row in csv.reader(file)}


def known(system):
    """How many results of each filter are known to differ there."""
    lines = [line.split() for line in KNOWN.read_text().splitlines() if line and not line.startswith("#")]
    return {name: int(count) for where, name, count in lines if where == system}


def main():
    reference, other = (read(path) for path in sys.argv[1:3])
    if not reference or reference.keys() != other.keys():
        print(f"{len(reference)} and {len(other)} results, which are not of the same calls")
        return 1
    expected, new = known(sys.argv[3]), 0
    calls = collections.Counter(key[1] for key in reference)
    differ = collections.Counter(key[1] for key in reference if reference[key] != other[key])
    for name, count in differ.items():
        more = count > expected.get(name, 0)
        new += more
        print(f"{name}: {count} of {calls[name]} differ ({'NEW' if more else 'known'})")
    print(f"{sum(calls.values()) - sum(differ.values())} of {sum(calls.values())} results are the same to the last bit")
    return 1 if new else 0


sys.exit(main())
