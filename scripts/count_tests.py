#!/usr/bin/env python3
"""Adds up what CTest and pytest reported and prints one line, "N passed, N failed"; fails if anything did.

    scripts/count_tests.py BUILD...

Each build folder holds ctest.xml, or CTest itself failed. Tests have the same name in several folders. A CTest test
named pytest_<name> stands for the cases in pytest_<name>.xml; if it failed without a report of a failing case (it
crashed, say), it counts as a failure itself. A skipped test counts as a failure if CI=true, for nothing may be missing
there; elsewhere it counts as neither, and is listed.
"""

import os
import pathlib
import sys
import xml.etree.ElementTree as ET


def outcome(case):
    """passed, failed or skipped: of a test case in a JUnit report."""
    if case.find("failure") is not None or case.find("error") is not None or case.get("status") == "fail":
        return "failed"
    if case.find("skipped") is not None or case.get("status") in ("notrun", "disabled"):
        return "failed" if os.environ.get("CI") == "true" else "skipped"
    return "passed"


def cases(build):
    """(name, outcome) of every test of one build folder."""
    if not (build / "ctest.xml").exists():
        yield "ctest", "failed"
        return
    for test in ET.parse(build / "ctest.xml").iter("testcase"):
        name, result = test.get("name"), outcome(test)
        report = build / f"{name}.xml"
        if name.startswith("pytest_"):
            inner = [(c.get("name"), outcome(c)) for c in ET.parse(report).iter("testcase")] if report.exists() else []
            yield from inner
            if result != "failed" or any(r == "failed" for _, r in inner):
                continue
        yield name, result


def main():
    builds = [pathlib.Path(build) for build in sys.argv[1:]]
    found = [(f"{build.name}: {name}", result) for build in builds for name, result in cases(build)]
    for wanted in ("skipped", "failed"):
        for name, result in found:
            if result == wanted:
                print(f"{wanted}: {name}")
    count = {wanted: sum(r == wanted for _, r in found) for wanted in ("passed", "failed")}
    print(f"{count['passed']} passed, {count['failed']} failed")
    return 1 if count["failed"] or not count["passed"] else 0


sys.exit(main())
